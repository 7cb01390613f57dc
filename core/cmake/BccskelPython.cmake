# Whether the Python package (client/python) is built: where pybind11, Python's headers and the client
# are there. Debian's interpreter unless Python_EXECUTABLE names another: its packages are what the
# tests use.
if(NOT Python_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python_EXECUTABLE /usr/bin/python3)
endif()
find_package(Python QUIET COMPONENTS Interpreter Development)
if(Python_FOUND)
  set(PYBIND11_FINDPYTHON ON)
  find_package(pybind11 QUIET CONFIG)
endif()
set(bccskel_python_possible OFF)
if(pybind11_FOUND AND BCCSKEL_BUILD_CLIENT)
  set(bccskel_python_possible ON)
endif()
option(BCCSKEL_PYTHON "Build the Python package (needs pybind11 and the client)"
       ${bccskel_python_possible})
if(BCCSKEL_PYTHON AND NOT bccskel_python_possible)
  message(FATAL_ERROR "BCCSKEL_PYTHON needs pybind11 and Python's headers (Debian: pybind11-dev "
                      "python3-dev) and BCCSKEL_BUILD_CLIENT")
endif()
