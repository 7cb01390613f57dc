# `cpack` in a build folder makes three Debian packages: bccskel (server, command line, man page,
# completions), libbccskel-dev (static libraries and headers) and, with BCCSKEL_PYTHON,
# python3-bccskel.
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
# Which dpkg-shlibdeps does not see, since the command line opens them late.
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS
    "libblosc1, libcairo2, libisal2, liblz4-1, libmeshoptimizer2d, libopenexr-3-1-30, libpng16-16, \
libssl3, libtiff6, libzip4, libzstd1")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libbccskel-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION
    "Server and command line that turn meshes and volumes into curve skeletons.")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
    "Static libraries, headers and CMake files for find_package(bccskel).")

if(BCCSKEL_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-bccskel)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  # The extension module is for one minor version.
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.${Python_VERSION_MINOR}), \
python3 (<< 3.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-networkx, python3-pandas")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION
      "Python package that turns masks, label images and meshes into curve skeletons.")
endif()

# Only those who run MPI jobs need it.
if(TARGET bccskel-mpi)
  list(APPEND CPACK_COMPONENTS_ALL mpi)
  set(CPACK_DEBIAN_MPI_PACKAGE_NAME bccskel-mpi)
  set(CPACK_DEBIAN_MPI_PACKAGE_SECTION science)
  set(CPACK_DEBIAN_MPI_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_MPI_PACKAGE_RECOMMENDS "openmpi-bin")
  set(CPACK_COMPONENT_MPI_DESCRIPTION "Curve skeletons of one object on the ranks of an MPI job.")
endif()

# The development package needs what a program that links the libraries needs: our build list
# without the tools.
file(STRINGS ${PROJECT_SOURCE_DIR}/docker/packages/build.txt bccskel_build_packages
     REGEX "^lib[a-z0-9.+-]+-dev|^zlib1g-dev")
list(TRANSFORM bccskel_build_packages REPLACE "[ \t]*#.*$" "")
list(JOIN bccskel_build_packages ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)
include(CPack)
