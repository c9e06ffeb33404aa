# The frame path gives the same bits whatever compiles it: builds frames.cpp with the run layer's own sources and options
# in many ways and compares the hashes.
#
#   cmake -DSOURCE=… -DWORK=… -DOPTIONS="the layer's options" [-DLAUNCHER=ccache]
#         [-DCROSS=compiler -DEMULATOR=program] -P bits.cmake
#
# WISP_EVERY_COMPILER=1 in the environment: all variants, not the three that are farthest from each other (bits/widths.cmake
# runs the library as it is built).
# CROSS: another machine's compiler, whose programs EMULATOR runs.
#
# It last changed when flames that catch came to recorded shapes: what goes out, and is lit again, plays otherwise.
# A change of this hash is a change of what every game sees: CHANGES.md says so on a line of its own.
set(golden d38f3207fc0ee135)

set(variants "g++ -O0" "g++ -Ofast -march=native" "clang++ -O3 -DWISP_PLAIN_LANES")
if("$ENV{WISP_EVERY_COMPILER}")
  list(APPEND variants "g++ -O3" "g++ -O3 -DWISP_PLAIN_LANES" "clang++ -O0" "clang++ -O3"
    "clang++ -O3 -ffast-math -march=native")
endif()
set(ground_compiler c++)
if(CROSS)
  set(ground_compiler ${CROSS})
  set(variants "${CROSS} -O0" "${CROSS} -O3" "${CROSS} -O3 -DWISP_PLAIN_LANES")
endif()

separate_arguments(OPTIONS)

# What is compiled anew each time: all that computes on a frame's path, or for it. The rest, once.
file(GLOB_RECURSE computing RELATIVE ${SOURCE}/src ${SOURCE}/src/run/*.cpp)
list(FILTER computing EXCLUDE REGEX "/(cost)[^/]*$")
list(APPEND computing model/bspline.cpp)
file(GLOB ground RELATIVE ${SOURCE}/src ${SOURCE}/src/model/*.cpp)
list(FILTER ground EXCLUDE REGEX "/(bspline|file|chain_rows|payload)\\.cpp$")  # on the path; not needed
list(APPEND ground base/result.cpp)

# One translation unit a folder, as the library has them: most of a small source's compilation is reading headers.
function(units name sources)
  foreach(source IN LISTS sources)
    cmake_path(GET source PARENT_PATH folder)
    string(MAKE_C_IDENTIFIER ${folder} folder)
    list(APPEND folders ${folder})
    string(APPEND in_${folder} "#include \"${source}\"\n")
  endforeach()
  list(REMOVE_DUPLICATES folders)
  foreach(folder IN LISTS folders)
    file(CONFIGURE OUTPUT ${WORK}/units/${name}_${folder}.cpp CONTENT "${in_${folder}}" @ONLY)
    list(APPEND made ${WORK}/units/${name}_${folder}.cpp)
  endforeach()
  set(${name} ${made} PARENT_SCOPE)
endfunction()

units(computing "${computing}")
units(ground "${ground}")
list(APPEND computing ${SOURCE}/tests/run/bits/frames.cpp)

# Compiles units into `folder` and appends the objects to `objects`.
function(compile folder compiler flags units)
  file(MAKE_DIRECTORY ${folder})
  foreach(unit IN LISTS units)
    cmake_path(GET unit STEM object)
    execute_process(
      COMMAND ${LAUNCHER} ${compiler} -std=c++20 -DNDEBUG ${flags} -I${SOURCE}/include -I${SOURCE}/src
              -I${SOURCE}/tests -c ${unit} -o ${folder}/${object}.o
      RESULT_VARIABLE failed ERROR_VARIABLE errors)
    if(failed)
      message(FATAL_ERROR "${compiler} ${flags}: ${unit} does not compile:\n${errors}")
    endif()
    list(APPEND objects ${folder}/${object}.o)
  endforeach()
  set(objects ${objects} PARENT_SCOPE)
endfunction()

compile(${WORK}/ground ${ground_compiler} -O1 "${ground}")
set(ground_objects ${objects})

# Compiles `what` for one variant, links it with the objects in `with` and runs it; `last` has the last word over the layer's
# options. Sets `hash`, and `made` to the variant's objects.
function(run_variant name compiler flags last what with)
  set(objects "")
  compile(${WORK}/${name} ${compiler} "${flags};${OPTIONS};${last}" "${what}")
  set(made ${objects} PARENT_SCOPE)
  execute_process(COMMAND ${compiler} ${flags} ${link} ${objects} ${with} -o ${WORK}/${name}/frames RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "${compiler} ${flags}: does not link")
  endif()
  execute_process(COMMAND ${EMULATOR} ${WORK}/${name}/frames${suffix} OUTPUT_VARIABLE hash OUTPUT_STRIP_TRAILING_WHITESPACE)
  set(hash "${hash}" PARENT_SCOPE)
endfunction()

set(link "")
set(suffix "")
if(CROSS)
  set(link -static)
  if(CROSS MATCHES mingw)
    set(suffix .exe)
  endif()
endif()
set(wrong 0)
foreach(variant IN LISTS variants)
  separate_arguments(flags UNIX_COMMAND "${variant}")
  list(POP_FRONT flags compiler)
  find_program(found_${compiler} ${compiler})
  if(NOT found_${compiler})
    message("skipped   ${variant}: there is no ${compiler}")
    continue()
  endif()
  string(MAKE_C_IDENTIFIER "${variant}" name)
  run_variant(${name} ${compiler} "${flags}" "" "${computing}" "${ground_objects}")
  if(NOT others)
    set(others ${made})
  endif()
  if(hash STREQUAL golden)
    message("same      ${variant}")
  else()
    message("different ${variant}: ${hash}, expected ${golden}")
    math(EXPR wrong "${wrong} + 1")
  endif()
endforeach()

# That the comparison sees a difference: products and sums fused, as they are without the layer's options. One folder's are
# enough: the others are those of the first variant.
file(STRINGS /proc/cpuinfo fuses REGEX "^flags.* fma " LIMIT_COUNT 1)
if(fuses AND NOT CROSS)
  set(fused ${WORK}/units/computing_run_arx.cpp)
  list(FILTER others EXCLUDE REGEX "/computing_run_arx\\.o$")
  run_variant(fused c++ "-O2;-mfma" -ffp-contract=fast "${fused}" "${others};${ground_objects}")
  if(NOT hash MATCHES "^[0-9a-f]+$")
    message(FATAL_ERROR "fused: the program ends without a hash")
  elseif(hash STREQUAL golden)
    message("same      fused, which must differ: this test sees nothing")
    math(EXPR wrong "${wrong} + 1")
  endif()
endif()

if(wrong)
  message(FATAL_ERROR "${wrong} of the builds give other bits than they must")
endif()
