# Builds the host in tests/house/host against Wisp and runs it.
#
#   cmake -DHOW=installed|subproject -DSOURCE=… -DBUILD=… -DSCRATCH=… -DGENERATOR=… -DNM=… -P consumer.cmake
#
# installed: BUILD is installed, moved elsewhere, and found there by find_package. subproject: by add_subdirectory.
cmake_minimum_required(VERSION 3.25)

function(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(result)
    message(FATAL_ERROR "${what} failed (${result}):\n${output}")
  endif()
  if(output MATCHES "[Ww]arning")
    message(FATAL_ERROR "${what} warns:\n${output}")
  endif()
  message(STATUS "${what}: done")
endfunction()

# A package that names the folder it was built in works only there.
function(expect_nothing_of_this_machine prefix)
  file(GLOB_RECURSE files ${prefix}/*.cmake ${prefix}/*.hpp ${prefix}/*.h)
  if(NOT files)
    message(FATAL_ERROR "${prefix} holds no package file")
  endif()
  foreach(file IN LISTS files)
    file(READ ${file} text)
    foreach(place IN ITEMS ${SOURCE} ${BUILD} ${SCRATCH})
      string(FIND "${text}" "${place}" at)
      if(NOT at EQUAL -1)
        message(FATAL_ERROR "${file} names ${place}")
      endif()
    endforeach()
  endforeach()
endfunction()

# Two FlatBuffers in one program must not share a symbol.
function(expect_no_symbol_of_flatbuffers library)
  execute_process(COMMAND ${NM} --demangle ${library} OUTPUT_VARIABLE symbols RESULT_VARIABLE result)
  if(result OR NOT symbols MATCHES "wisp_flatbuffers::")
    message(FATAL_ERROR "${NM} shows no symbol of the renamed FlatBuffers in ${library}: this check would see nothing")
  endif()
  if(symbols MATCHES "[^_a-zA-Z0-9](flatbuffers::[^\n]*)")
    message(FATAL_ERROR "${library} has a symbol that a host's own FlatBuffers may have too: ${CMAKE_MATCH_1}")
  endif()
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
if(HOW STREQUAL "installed")
  run("installing" ${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/made)
  file(RENAME ${SCRATCH}/made ${SCRATCH}/moved)
  expect_nothing_of_this_machine(${SCRATCH}/moved)
  set(where -DCMAKE_PREFIX_PATH=${SCRATCH}/moved)
else()
  set(where -DWISP_SOURCE=${SOURCE})
endif()

run("configuring the host" ${CMAKE_COMMAND} -S ${SOURCE}/tests/house/host -B ${SCRATCH}/build -G ${GENERATOR}
  -DCMAKE_BUILD_TYPE=Release ${where} -Werror=dev)
run("building the host" ${CMAKE_COMMAND} --build ${SCRATCH}/build)
run("running the host" ${SCRATCH}/build/host ${SOURCE}/tests/model/golden/v1.wisp)

file(GLOB_RECURSE library ${SCRATCH}/libwisp_model.a)
expect_no_symbol_of_flatbuffers(${library})
file(REMOVE_RECURSE ${SCRATCH})
