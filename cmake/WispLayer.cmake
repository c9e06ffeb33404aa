# A layer is one library: its sources are the folder src/NAME, its headers include/wisp/NAME, and it may use only the
# layers below it.
#
#   wisp_layer(NAME [FOLDER src-folder] [USES layer…] [LINKS private-library…]
#              [OPTIONS private-compiler-option…] [PRECOMPILED header…])
function(wisp_layer name)
  cmake_parse_arguments(LAYER "" "FOLDER" "USES;LINKS;OPTIONS;PRECOMPILED" ${ARGN})
  if(NOT LAYER_FOLDER)
    set(LAYER_FOLDER ${name})
  endif()
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${LAYER_FOLDER}/*.cpp)
  set(target wisp_${name})
  # Always an archive: a host with BUILD_SHARED_LIBS and hidden symbols could not link its layers to each other. A host's own
  # unity build would put names of several folders into one source.
  add_library(${target} STATIC ${sources})
  add_library(wisp::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON CXX_EXTENSIONS OFF UNITY_BUILD OFF)
  target_compile_features(${target} PUBLIC cxx_std_20)
  # A host's include_directories() would come first and bring its own version of what a layer uses.
  set_target_properties(${target} PROPERTIES INCLUDE_DIRECTORIES "")
  target_include_directories(${target}
    PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${PROJECT_SOURCE_DIR}/src)
  foreach(below IN LISTS LAYER_USES)
    target_link_libraries(${target} PUBLIC wisp::${below})
  endforeach()
  target_link_libraries(${target} PRIVATE ${LAYER_LINKS})
  wisp_exact_arithmetic(${target} ${LAYER_OPTIONS})
  wisp_warnings(${target})
  wisp_unity(${target})
  # What changes the code of inline functions wants headers read with the same options.
  if(name STREQUAL base OR LAYER_OPTIONS OR LAYER_PRECOMPILED)
    wisp_precompiled(${target} ${LAYER_PRECOMPILED})
  else()
    wisp_precompiled(${target} REUSE_FROM wisp_base)
  endif()
  set_property(GLOBAL APPEND PROPERTY WISP_LAYERS ${target})
endfunction()

# The first for ccache. The second is the size of its heap from which GCC collects garbage, in kB: some 200 MB more for 8 %
# less time.
set(wisp_precompiling "$<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess;--param=ggc-min-heapsize=1000000>")

# Reading the standard library is half of what compiling one of our sources takes: it is read once for all of a target.
# Further arguments are more headers of which many sources are made, or another target to take all from. A host's build,
# and one for another machine, is left as it is.
function(wisp_precompiled target)
  if(NOT PROJECT_IS_TOP_LEVEL OR CMAKE_CROSSCOMPILING)
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=400000>)
    return()
  endif()
  # GCC 12 forgets that what it has read beforehand is the system's, and wrongly finds fault with the moves of its own
  # std::string.
  target_compile_options(${target} PRIVATE ${wisp_precompiling}
    "$<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow;-Wno-stringop-overread;-Wno-array-bounds>")
  if(ARGV1 STREQUAL REUSE_FROM)
    target_precompile_headers(${target} ${ARGN})
  else()
    target_precompile_headers(${target} PRIVATE ${ARGN} <algorithm> <array> <cmath> <functional> <limits> <map> <optional>
      <span> <string> <variant> <vector>)
  endif()
endfunction()

# With WISP_UNITY_BUILD the sources of a folder are compiled together, some twelve at a time, in parts of like size: headers and
# template instances that they share are four tenths of the time. After a change the whole part is compiled again. Names in
# anonymous namespaces must be unique within a folder; an overload that another source's replaces is an unused function,
# which is an error.
function(wisp_unity target)
  if(NOT WISP_UNITY_BUILD)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  get_target_property(root ${target} SOURCE_DIR)
  list(FILTER sources INCLUDE REGEX "\\.cpp$")
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${root})
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
    string(MAKE_C_IDENTIFIER "${folder}" folder)
    list(APPEND folders ${folder})
    list(APPEND in_${folder} ${source})
    file(SIZE ${source} bytes)
    math(EXPR bytes_${folder} "0${bytes_${folder}} + ${bytes}")
  endforeach()
  list(REMOVE_DUPLICATES folders)
  set(together 12)
  foreach(folder IN LISTS folders)
    list(LENGTH in_${folder} count)
    math(EXPR parts "(${count} + ${together} - 1) / ${together}")
    set(before 0)
    foreach(source IN LISTS in_${folder})
      file(SIZE ${source} bytes)
      # The part in which the source's middle lies.
      math(EXPR part "(${before} + ${bytes} / 2) * ${parts} / (${bytes_${folder}} + 1) + 1")
      math(EXPR before "${before} + ${bytes}")
      set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${folder}_${part})
    endforeach()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # GCC takes a source that is included for a header, and -Wmaybe-uninitialized has false positives where it inlines more.
  target_compile_options(${target} PRIVATE
    "$<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-subobject-linkage;-Wno-maybe-uninitialized>")
endfunction()

# A host may build with -ffast-math. A missing sample is a NaN here, and the frame path keeps its bits. Further arguments
# are what GCC and Clang need besides; MSVC and clang-cl have one word for all of it.
function(wisp_exact_arithmetic target)
  if(MSVC)
    target_compile_options(${target} PRIVATE /fp:precise /utf-8 $<$<CXX_COMPILER_ID:Clang>:/clang:-ffp-contract=off>)
  else()
    target_compile_options(${target} PRIVATE -fno-fast-math ${ARGN})
  endif()
endfunction()

function(wisp_warnings target)
  if(MSVC)
    target_compile_options(${target} PRIVATE /utf-8 /W3 $<$<BOOL:${WISP_WERROR}>:/WX>)
    return()
  endif()
  if(PROJECT_IS_TOP_LEVEL)
    # Designated initialisers leave the other fields at their defaults on purpose.
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                           -Wno-sign-conversion -Wno-missing-field-initializers)
  else()
    # A host's -Wextra would complain of it.
    target_compile_options(${target} PRIVATE -Wno-missing-field-initializers)
  endif()
  if(WISP_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  # GCC 12 and 13 wrongly see overlapping copies in "text" + std::string (GCC bug 105651).
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
endfunction()
