# The golden hash again, from the library as it is built, at every width of vectors that this machine has; and of what is
# compiled for wide vectors nothing is seen from outside but the one name by which it is chosen.
#
#   cmake -DSOURCE=… -DPROGRAM=frames -DOBJECTS="frame_path_avx2.o;…" -DNM=nm [-DEMULATOR=program] -P widths.cmake
file(STRINGS ${SOURCE}/tests/run/bits/bits.cmake golden REGEX "^set\\(golden ")
string(REGEX REPLACE "set\\(golden ([0-9a-f]+)\\)" "\\1" golden "${golden}")

foreach(width baseline avx2 avx512)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env WISP_WIDTH=${width} ${EMULATOR} ${PROGRAM}
    OUTPUT_VARIABLE hash OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(hash STREQUAL golden)
    message("same      ${width}")
  elseif(hash MATCHES "this machine has" AND NOT width STREQUAL baseline)
    message("skipped   ${width}: ${hash}")
  else()
    message(FATAL_ERROR "different ${width}: ${hash}, expected ${golden}")
  endif()
endforeach()

foreach(object IN LISTS OBJECTS)
  execute_process(COMMAND ${NM} --defined-only --extern-only --format=posix ${object} OUTPUT_VARIABLE symbols)
  get_filename_component(name ${object} NAME_WE)
  if(NOT symbols MATCHES "^wisp_${name} [A-Z] [^\n]*\n$")
    message(FATAL_ERROR "${object} shows others more than wisp_${name}:\n${symbols}")
  endif()
endforeach()
