# How every own target is built.

# Compiles the sources of a target some at a time: the headers of gRPC, CLI11 and Abseil take most of
# the time of most of them. Vector kernels include themselves once per instruction set and stay alone.
function(bccskel_unity target)
  if(NOT BCCSKEL_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 24)
  # It takes the classes of a source for those of a header here, since the source is included.
  target_compile_options(${target} PRIVATE
    $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE path)
    if(EXISTS ${path})
      file(STRINGS ${path} kernel REGEX "foreach_target\\.h" LIMIT_COUNT 1)
      if(kernel)
        set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
      endif()
    endif()
  endforeach()
endfunction()

# Compiles kernels of a target together: reading Highway once per instruction set takes most of the
# time of small ones. The file that includes them all takes the place of each in foreach_target.h.
function(bccskel_kernels_together target)
  if(NOT BCCSKEL_UNITY)
    return()
  endif()
  set(all ${CMAKE_CURRENT_BINARY_DIR}/${target}_kernels.cc)
  set(include_all "#undef HWY_TARGET_INCLUDE\n#define HWY_TARGET_INCLUDE \"${all}\"\n")
  set(text "${include_all}#include \"hwy/foreach_target.h\"\n")
  foreach(kernel IN LISTS ARGN)
    string(APPEND text "#include \"${CMAKE_CURRENT_SOURCE_DIR}/${kernel}\"\n${include_all}")
  endforeach()
  file(CONFIGURE OUTPUT ${all} CONTENT "${text}")
  target_sources(${target} PRIVATE ${all})
  set_source_files_properties(${ARGN} PROPERTIES HEADER_FILE_ONLY ON)
  set_source_files_properties(${all} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# Language level, include root, warnings and sanitizers of one target.
function(bccskel_target_defaults target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  # Results must have the same bits on every machine: no contraction to fused multiply-add.
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -ffp-contract=off)
  # In KiB: GCC's own garbage collection takes up to a fifth of its time; no unit needs above 1 GiB.
  target_compile_options(${target} PRIVATE
    $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=262144>)
  # OpenEXR's initializer macros leave fields out; only clang minds that in a header of others.
  target_compile_options(${target} PRIVATE
    $<$<CXX_COMPILER_ID:Clang>:-Wno-missing-field-initializers>)
  if(BCCSKEL_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  bccskel_unity(${target})
  if(BCCSKEL_SANITIZE)
    # Left out is what the address sanitizer stops at, too, and what takes a third of the time to
    # compile. The check of virtual tables opens a pipe to look at memory, so it reports sound objects
    # when the server has reached its limit of open files, which a test does.
    target_compile_options(${target} PRIVATE -fsanitize=${BCCSKEL_SANITIZE} -fno-omit-frame-pointer
                                             -fno-sanitize-recover=all
                                             -fno-sanitize=null,object-size,pointer-overflow
                                             -fno-sanitize=vptr,alignment)
    target_link_options(${target} PUBLIC -fsanitize=${BCCSKEL_SANITIZE})
  endif()
endfunction()

# For code that takes bytes for numbers and so can meet addresses that are not aligned. Elsewhere the
# check finds nothing and takes a quarter of the time to compile.
function(bccskel_check_alignment target)
  if(BCCSKEL_SANITIZE MATCHES undefined)
    target_compile_options(${target} PRIVATE -fsanitize=alignment)
  endif()
endfunction()

# For commands and calls: what must be fast is in other libraries. Compiles in two thirds of the time.
function(bccskel_optimize_less target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
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

# What every test program is: its sources, our defaults, GoogleTest.
function(bccskel_test_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  bccskel_target_defaults(${name})
  bccskel_optimize_less(${name})
  target_link_libraries(${name} PRIVATE ${ARG_LIBS} GTest::gmock GTest::gtest)
endfunction()

# Labels of a test: its folder under tests (core, proto, server, client, integration) and `ARGN`.
function(bccskel_label_test name)
  get_property(labeled GLOBAL PROPERTY BCCSKEL_TESTS)
  if(name IN_LIST labeled)
    message(FATAL_ERROR "two tests have the name ${name}")
  endif()
  set_property(GLOBAL APPEND PROPERTY BCCSKEL_TESTS ${name})
  cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY ${PROJECT_SOURCE_DIR}/tests
             OUTPUT_VARIABLE folder)
  string(REGEX REPLACE "/.*" "" folder ${folder})
  set(labels ${ARGN} ${folder})
  list(REMOVE_DUPLICATES labels)
  set_tests_properties(${name} PROPERTIES TIMEOUT 300 LABELS "${labels}")
endfunction()

# bccskel_test(thinning_test SOURCES a.cc LIBS deps... LABELS slow) makes one test program and its
# ctest entry.
function(bccskel_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS;LABELS" ${ARGN})
  bccskel_test_program(${name} SOURCES ${ARG_SOURCES} LIBS ${ARG_LIBS} GTest::gtest_main)
  add_test(NAME ${name} COMMAND ${name})
  bccskel_label_test(${name} ${ARG_LABELS})
endfunction()

# bccskel_tests(wire_tests PREFIX wire_ TESTS options result SLOW result SOURCES helper.cc LIBS deps...)
# makes one program of options_test.cc and result_test.cc, and of each its own ctest entry,
# wire_options_test and wire_result_test: many small programs take minutes to compile and to link.
# A test of another folder is given with its path, which its entry's name leaves out.
# SLOW: those with the label.
function(bccskel_tests program)
  cmake_parse_arguments(ARG "" "PREFIX" "TESTS;SLOW;SOURCES;LIBS;LABELS" ${ARGN})
  list(TRANSFORM ARG_TESTS APPEND _test.cc OUTPUT_VARIABLE sources)
  bccskel_test_program(${program} SOURCES ${sources} ${ARG_SOURCES}
                                          ${PROJECT_SOURCE_DIR}/tests/support/tests_of_source.cc
                       LIBS ${ARG_LIBS})
  foreach(path IN LISTS ARG_TESTS)
    cmake_path(GET path FILENAME test)
    add_test(NAME ${ARG_PREFIX}${test}_test COMMAND ${program} --source=${test}_test.cc)
    set(slow)
    if(test IN_LIST ARG_SLOW)
      set(slow slow)
    endif()
    bccskel_label_test(${ARG_PREFIX}${test}_test ${ARG_LABELS} ${slow})
  endforeach()
endfunction()
