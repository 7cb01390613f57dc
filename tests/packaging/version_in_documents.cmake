# The version is stated in the root CMakeLists.txt; the documents that repeat it must agree.
# Needs: SOURCE_DIR, VERSION.
file(READ ${SOURCE_DIR}/CITATION.cff citation)
if(NOT citation MATCHES "\nversion: ${VERSION}\n")
  message(FATAL_ERROR "CITATION.cff does not say version: ${VERSION}")
endif()
file(READ ${SOURCE_DIR}/CHANGELOG.md changelog)
if(NOT changelog MATCHES "\n## \\[${VERSION}\\]")
  message(FATAL_ERROR "CHANGELOG.md has no section [${VERSION}]")
endif()
