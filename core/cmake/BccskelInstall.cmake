# Installation and find_package(bccskel). Included last: it sees every target.
include(CMakePackageConfigHelpers)

set(BCCSKEL_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/bccskel)

# Libraries are exported as two components: `core` needs no gRPC, `client` does. A library belongs
# to the component whose folder it is built in; those of the server and of tests stay at home.
get_property(bccskel_libraries GLOBAL PROPERTY BCCSKEL_INSTALLED_TARGETS)
set(bccskel_core_libraries)
set(bccskel_client_libraries)
foreach(library IN LISTS bccskel_libraries)
  get_target_property(folder ${library} SOURCE_DIR)
  cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
  if(folder MATCHES "^core/")
    list(APPEND bccskel_core_libraries ${library})
  elseif(folder MATCHES "^(proto|client)(/|$)" AND NOT folder MATCHES "^client/cli")
    list(APPEND bccskel_client_libraries ${library})
  endif()
endforeach()

foreach(part IN ITEMS core client)
  if(bccskel_${part}_libraries)
    install(TARGETS ${bccskel_${part}_libraries} EXPORT bccskel-${part}
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
    install(EXPORT bccskel-${part} NAMESPACE bccskel:: DESTINATION ${BCCSKEL_CMAKE_DIR}
            FILE bccskel-${part}.cmake COMPONENT development)
  endif()
endforeach()

install(DIRECTORY core/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/bccskel/core
        COMPONENT development FILES_MATCHING PATTERN "*.h" PATTERN cmake EXCLUDE)
if(BCCSKEL_BUILD_CLIENT)
  install(DIRECTORY client/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/bccskel/client
          COMPONENT development
          FILES_MATCHING PATTERN "*.h" PATTERN cli EXCLUDE PATTERN examples EXCLUDE
          PATTERN python EXCLUDE)
  install(DIRECTORY proto/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/bccskel/proto
          COMPONENT development FILES_MATCHING PATTERN "*.h" PATTERN "*.proto")
  install(DIRECTORY ${PROJECT_BINARY_DIR}/proto/generated/
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/bccskel
          COMPONENT development FILES_MATCHING PATTERN "*.pb.h")
endif()

set(BCCSKEL_ALL_CORE_LIBRARIES ${bccskel_core_libraries})
list(TRANSFORM BCCSKEL_ALL_CORE_LIBRARIES REPLACE "^bccskel_" "bccskel::")
set(BCCSKEL_ALL_CLIENT_LIBRARIES ${bccskel_client_libraries})
list(TRANSFORM BCCSKEL_ALL_CLIENT_LIBRARIES REPLACE "^bccskel_" "bccskel::")
configure_package_config_file(
  core/cmake/bccskelConfig.cmake.in ${PROJECT_BINARY_DIR}/bccskelConfig.cmake
  INSTALL_DESTINATION ${BCCSKEL_CMAKE_DIR})
# Before 1.0 a minor version may break callers; from 1.0 on only a major one may.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/bccskelConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/bccskelConfig.cmake
              ${PROJECT_BINARY_DIR}/bccskelConfigVersion.cmake
        DESTINATION ${BCCSKEL_CMAKE_DIR} COMPONENT development)

install(FILES LICENSE NOTICE CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)
# Where Debian's tools look for the license of a package.
install(FILES NOTICE DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/bccskel RENAME copyright
        COMPONENT runtime)
install(FILES NOTICE DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/libbccskel-dev RENAME copyright
        COMPONENT development)
if(BCCSKEL_PYTHON)
  install(FILES NOTICE DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/python3-bccskel RENAME copyright
          COMPONENT python)
endif()
if(BCCSKEL_BUILD_SERVER)
  install(FILES docker/bccskel-server.service DESTINATION lib/systemd/system COMPONENT runtime)
endif()
