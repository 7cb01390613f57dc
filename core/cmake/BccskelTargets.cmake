# How every own target is built.

# Language level, include root, warnings and sanitizers of one target.
function(bccskel_target_defaults target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  # Results must have the same bits on every machine: no contraction to fused multiply-add.
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -ffp-contract=off)
  # OpenEXR's initializer macros leave fields out; only clang minds that in a header of others.
  target_compile_options(${target} PRIVATE
    $<$<CXX_COMPILER_ID:Clang>:-Wno-missing-field-initializers>)
  if(BCCSKEL_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(BCCSKEL_SANITIZE)
    # Left out is what the address sanitizer stops at, too, and what takes a third of the time to
    # compile. The check of virtual tables opens a pipe to look at memory, so it reports sound objects
    # when the server has reached its limit of open files, which a test does.
    target_compile_options(${target} PRIVATE -fsanitize=${BCCSKEL_SANITIZE} -fno-omit-frame-pointer
                                             -fno-sanitize-recover=all
                                             -fno-sanitize=null,object-size,pointer-overflow,vptr)
    # A sanitizer judges one vector instruction set and the plain code; each costs half a minute of
    # compile time, most of it in checks of references to what lies on the stack.
    target_compile_definitions(${target} PRIVATE
      "HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SSE4|HWY_AVX3|HWY_AVX3_DL)")
    target_link_options(${target} PUBLIC -fsanitize=${BCCSKEL_SANITIZE})
  endif()
endfunction()

# bccskel_library(thinning SOURCES a.cc PUBLIC deps... PRIVATE deps...) makes the static library
# bccskel_thinning, seen as bccskel::thinning here and after installation.
function(bccskel_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(bccskel_${name} STATIC ${ARG_SOURCES})
  add_library(bccskel::${name} ALIAS bccskel_${name})
  set_target_properties(bccskel_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(bccskel_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/bccskel>)
  bccskel_target_defaults(bccskel_${name})
  target_link_libraries(bccskel_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  set_property(GLOBAL APPEND PROPERTY BCCSKEL_INSTALLED_TARGETS bccskel_${name})
endfunction()

# bccskel_test(thinning_test SOURCES a.cc LIBS deps...) makes one test program and its ctest entry.
# Its labels are its folder under tests (core, proto, server, client, integration) and LABELS.
function(bccskel_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;LIBS;LABELS" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  bccskel_target_defaults(${name})
  # What must be fast is in libraries; tests themselves compile in two thirds of the time so.
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  if(BCCSKEL_SANITIZE)  # a quarter of the time to compile, and not what is to be tested
    target_compile_options(${name} PRIVATE -fno-sanitize=alignment)
  endif()
  target_link_libraries(${name} PRIVATE ${ARG_LIBS} GTest::gmock GTest::gtest GTest::gtest_main)
  cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY ${PROJECT_SOURCE_DIR}/tests
             OUTPUT_VARIABLE folder)
  string(REGEX REPLACE "/.*" "" folder ${folder})
  list(APPEND ARG_LABELS ${folder})
  list(REMOVE_DUPLICATES ARG_LABELS)
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES TIMEOUT ${ARG_TIMEOUT} LABELS "${ARG_LABELS}")
endfunction()
