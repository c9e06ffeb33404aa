# Compiles Wisp.cs with a program and runs it under mono: it must play the numbers of `wisp run`.
#
#   cmake -DSOURCE=… -DLIBRARY=libwisp.so -DPROGRAM=wisp -DWORK=… -P play.cmake
cmake_minimum_required(VERSION 3.25)
find_program(mcs mcs)
find_program(mono mono)
if(NOT mcs OR NOT mono)
  message("skipped: mono and mcs are not there (script/bootstrap --verify installs them)")
  return()
endif()

function(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE error)
  if(result)
    message(FATAL_ERROR "${what} failed (${result}):\n${output}${error}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(MAKE_DIRECTORY ${WORK})
cmake_path(GET LIBRARY PARENT_PATH folder)
set(model ${SOURCE}/tests/c/models/flame.wisp)
set(unity ${SOURCE}/bindings/unity)
run("playing by wisp run" ${PROGRAM} run ${model} --frames 200 --instances 3 --seed 5 --wind 0.5 -o ${WORK}/run.csv --quiet)
run("compiling" ${mcs} -warnaserror -out:${WORK}/play.exe ${unity}/Wisp.cs ${unity}/WispFlame.cs ${unity}/tests/Play.cs)
file(GLOB models ${SOURCE}/apps/web/public/models/*.wisp ${SOURCE}/apps/web/tests/models/*.wisp ${SOURCE}/tests/model/golden/*.wisp ${SOURCE}/tests/c/models/*.wisp)
run("playing in C#" ${CMAKE_COMMAND} -E env LD_LIBRARY_PATH=${folder} ${mono} ${WORK}/play.exe ${model}
  ${SOURCE}/apps/web/public/models/flame-4.wisp ${WORK}/run.csv ${models})
message("${output}")
