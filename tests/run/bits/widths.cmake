# The golden hash again, from the library as it is built, at every width of vectors that this machine has; and of what is
# compiled for wide vectors every symbol is of its width: a machine without it never runs one.
#
#   cmake -DSOURCE=… -DPROGRAM=frames -DOBJECTS="frame_path_avx2.o;…" -DNM=nm [-DEMULATOR=program] -P widths.cmake
file(STRINGS ${SOURCE}/tests/run/bits/bits.cmake golden REGEX "^set\\(golden ")
string(REGEX REPLACE "set\\(golden ([0-9a-f]+)\\)" "\\1" golden "${golden}")

foreach(width baseline avx2)
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
  string(REGEX MATCH "avx[0-9]+" width ${object})
  if(NOT symbols MATCHES "wisp_frame_path_${width} ")
    message(FATAL_ERROR "${object} has no wisp_frame_path_${width}: this check would see nothing")
  endif()
  string(REGEX REPLACE "[^\n]*wisp_(frame_path_)?${width}[^\n]*\n" "" others "${symbols}")
  if(NOT others STREQUAL "")
    message(FATAL_ERROR "${object} defines symbols that are not of its width:\n${others}")
  endif()
endforeach()
