# Installs the development files into an empty folder, builds a consumer project against them and
# runs it.
# Needs: BUILD_DIR, CONSUMER (folder of the project), WORK_DIR, EXPECTED (regular expression),
#        GENERATOR, CXX.
get_filename_component(name ${CONSUMER} NAME)
set(prefix ${WORK_DIR}/prefix)
set(build ${WORK_DIR}/build)
file(REMOVE_RECURSE ${WORK_DIR})

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output
                  ERROR_VARIABLE output ECHO_ERROR_VARIABLE)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}: exit status ${result}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix} --component development)
run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${CONSUMER} -B ${build} -DCMAKE_PREFIX_PATH=${prefix}
    -DCMAKE_CXX_COMPILER=${CXX})
run(${CMAKE_COMMAND} --build ${build})
run(${build}/${name})
message(STATUS "${output}")
if(NOT output MATCHES "${EXPECTED}")
  message(FATAL_ERROR "the consumer printed\n${output}\nwhich does not match\n${EXPECTED}")
endif()
file(REMOVE_RECURSE ${WORK_DIR})
