# Installation, find_package(bccskel) and packages. Kept last: it sees every target.
include(CMakePackageConfigHelpers)
get_property(bccskel_targets GLOBAL PROPERTY BCCSKEL_INSTALLED_TARGETS)
install(TARGETS ${bccskel_targets} EXPORT bccskelTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
