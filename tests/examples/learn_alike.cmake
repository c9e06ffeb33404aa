# Learns with an example and with the program, from the same file, and compares the models byte for byte.
#
#   cmake -DEXAMPLE=… -DPROGRAM=… -DCOMMAND=arx|flame -DFLAGS=list (-DINPUT=file | -DFILM=ON) -DWORK=folder -P …
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK}/example ${WORK}/program)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(status)
    message(FATAL_ERROR "${ARGN}: ${said}")
  endif()
endfunction()

if(FILM)
  set(INPUT ${WORK}/candle.mp4)
  run(${PROGRAM} simulate candle -o ${INPUT} --seconds 3 --seed 5 --quiet)
endif()
run(${EXAMPLE} ${INPUT} ${WORK}/example/model.wisp)
run(${PROGRAM} learn ${COMMAND} ${INPUT} -o ${WORK}/program/model.wisp ${FLAGS} --quiet)
file(SHA256 ${WORK}/example/model.wisp one)
file(SHA256 ${WORK}/program/model.wisp other)
if(NOT one STREQUAL other)
  message(FATAL_ERROR "the example's model is not the program's")
endif()
