# Builds the host in tests/house/host, the program in README.md and the examples against Wisp.
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
  set(output "${output}" PARENT_SCOPE)
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

# README's program, as it stands there.
file(READ ${SOURCE}/README.md page)
if(NOT page MATCHES "```cpp\n(#include[^`]*)```")
  message(FATAL_ERROR "README.md has no C++ program to compile")
endif()
file(WRITE ${SCRATCH}/readme.cpp "${CMAKE_MATCH_1}")

set(model ${SOURCE}/tests/model/golden/v1.wisp)
run("configuring the host" ${CMAKE_COMMAND} -S ${SOURCE}/tests/house/host -B ${SCRATCH}/host -G ${GENERATOR}
  -DCMAKE_BUILD_TYPE=Release ${where} -DREADME_PROGRAM=${SCRATCH}/readme.cpp -Werror=dev)
run("building the host" ${CMAKE_COMMAND} --build ${SCRATCH}/host)
if(HOW STREQUAL "installed")
  run("calling every layer" ${SCRATCH}/host/every_layer)
endif()
run("running the host" ${SCRATCH}/host/host-O0 ${model})
set(plain ${output})
run("running the host, built with fast mathematics" ${SCRATCH}/host/host-Ofast ${model})
if(NOT plain MATCHES "^checksum" OR NOT output STREQUAL plain)
  message(FATAL_ERROR "a host's own flags change what a model does:\n-O0:    ${plain}-Ofast: ${output}")
endif()

# The subproject is built with fast mathematics all over, what is installed without.
set(checksum ${BUILD}/house/checksum_installed.txt)
if(HOW STREQUAL "installed")
  file(WRITE ${checksum} "${plain}")
else()
  file(READ ${checksum} expected)
  if(NOT expected STREQUAL plain)
    message(FATAL_ERROR "a host's flags change what a model does:\ninstalled:  ${expected}subproject: ${plain}")
  endif()
endif()

run("configuring the examples" ${CMAKE_COMMAND} -S ${SOURCE}/examples -B ${SCRATCH}/example -G ${GENERATOR}
  -DCMAKE_BUILD_TYPE=Release ${where})
run("building the examples" ${CMAKE_COMMAND} --build ${SCRATCH}/example)
run("running the first example" ${SCRATCH}/example/01_play ${model})
if(NOT output MATCHES "^0\\.000 [-0-9.]+ [0-9.]+\n")
  message(FATAL_ERROR "the example should print one line a frame, and prints:\n${output}")
endif()

file(GLOB_RECURSE libraries ${SCRATCH}/libwisp_model.a)
list(GET libraries 0 library)
expect_no_symbol_of_flatbuffers(${library})
file(REMOVE_RECURSE ${SCRATCH})
