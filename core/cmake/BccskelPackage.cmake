# `cpack` in a build folder makes two Debian packages: bccskel (server, command line, man page,
# completions) and libbccskel-dev (static libraries and headers).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME bccskel)
set(CPACK_PACKAGE_VENDOR "The bccskel authors")
set(CPACK_PACKAGE_CONTACT "The bccskel authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL runtime development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME bccskel)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libbccskel-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION
    "Server and command line that turn meshes and volumes into curve skeletons.")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
    "Static libraries, headers and CMake files for find_package(bccskel).")

# The development package needs what a program that links the libraries needs: our build list
# without the tools.
file(STRINGS ${PROJECT_SOURCE_DIR}/docker/packages/build.txt bccskel_build_packages
     REGEX "^lib[a-z0-9.+-]+-dev|^zlib1g-dev")
list(TRANSFORM bccskel_build_packages REPLACE "[ \t]*#.*$" "")
list(JOIN bccskel_build_packages ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)
include(CPack)
