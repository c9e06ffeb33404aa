# What script/amalgamate writes compiles in one call without anything else of Wisp, by GCC and by Clang, also where a machine
# has fused multiply-add, gives the golden hash at every width, defines no symbol of C that is not called wisp_, and serves C.
#
#   cmake -DSOURCE=… -DWORK=… -DNM=nm [-DLAUNCHER=ccache] -P amalgamated.cmake
file(STRINGS ${SOURCE}/tests/run/bits/bits.cmake golden REGEX "^set\\(golden ")
string(REGEX REPLACE "set\\(golden ([0-9a-f]+)\\)" "\\1" golden "${golden}")
file(MAKE_DIRECTORY ${WORK})

function(run what)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${WORK} RESULT_VARIABLE failed OUTPUT_VARIABLE said ERROR_VARIABLE errors
    OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(failed OR NOT errors STREQUAL "")
    message(FATAL_ERROR "${what}: ${ARGN}\n${said}\n${errors}")
  endif()
  set(said "${said}" PARENT_SCOPE)
endfunction()

run("amalgamating" ${SOURCE}/script/amalgamate .)
set(exact -std=c++20 -ffp-contract=off -Wall -Wextra -Wno-missing-field-initializers)

# The first example, with the one header in the place of its own.
file(READ ${SOURCE}/examples/01_play.cpp example)
string(REGEX REPLACE "#include \"wisp/[^\n]*" "#include \"wisp_play.h\"" example "${example}")
file(CONFIGURE OUTPUT ${WORK}/example.cpp CONTENT "${example}" @ONLY)
file(WRITE ${WORK}/serves_c.c "#include \"wisp_play.h\"\n#include <stdio.h>\nint main(void) { return printf(\"%d\", wisp_version()) < 1; }\n")

file(STRINGS /proc/cpuinfo fuses REGEX "^flags.* fma " LIMIT_COUNT 1)
foreach(compiler g++ clang++)
  find_program(found_${compiler} ${compiler})
  if(NOT found_${compiler})
    message("skipped   ${compiler} is not here")
    continue()
  endif()
  set(machine "")
  if(fuses AND compiler STREQUAL g++)
    set(machine -mfma)
  endif()
  run("compiling" ${LAUNCHER} ${compiler} ${exact} ${machine} -O2 -DWISP_WIDE_PATHS -c wisp_play.cpp -o play.o)
  run("compiling for AVX2" ${LAUNCHER} ${compiler} ${exact} -O3 -fno-exceptions -DWISP_WIDTH=avx2 -mavx2
    -c wisp_play.cpp -o avx2.o)
  run("compiling the frames" ${LAUNCHER} ${compiler} -std=c++20 -O1 -I${SOURCE}/include -I${SOURCE}/src -I${SOURCE}/tests
    -c ${SOURCE}/tests/run/bits/frames.cpp -o frames.o)
  run("linking the frames" ${compiler} frames.o play.o avx2.o -o frames)
  run("linking the example" ${compiler} -std=c++20 example.cpp play.o avx2.o -o example)
  run("compiling C" cc -std=c99 -Wall -Wextra -Wpedantic -c serves_c.c -o serves_c.o)
  run("linking C" ${compiler} serves_c.o play.o avx2.o -o serves_c)
  run("running C" ./serves_c)
  run("running the example" ./example ${SOURCE}/tests/model/golden/v1.wisp)
  if(NOT said MATCHES "^0\\.000 [-0-9.]+ [0-9.]+\n")
    message(FATAL_ERROR "the example should print one line a frame, and prints:\n${said}")
  endif()
  foreach(width baseline avx2)
    execute_process(COMMAND ${CMAKE_COMMAND} -E env WISP_WIDTH=${width} ${WORK}/frames OUTPUT_VARIABLE hash
      OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(hash MATCHES "this machine has" AND NOT width STREQUAL baseline)
      message("skipped   ${compiler} ${width}: ${hash}")
    elseif(NOT hash STREQUAL golden)
      message(FATAL_ERROR "different ${compiler} ${width}: ${hash}, expected ${golden}")
    endif()
  endforeach()
  run("listing symbols" ${NM} --defined-only --extern-only --format=posix play.o)
  string(REGEX MATCHALL "(^|\n)[A-Za-vx-z][^ \n]*|(^|\n)w[a-hj-z][^ \n]*" names "${said}")
  list(FILTER names EXCLUDE REGEX "^\n?DW\\.ref\\.")
  if(names)
    message(FATAL_ERROR "symbols that a program may have too: ${names}")
  endif()
  message("same      ${compiler}")
endforeach()
