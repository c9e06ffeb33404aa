# A toolchain for WebAssembly: Emscripten's own, with what Debian 12 needs beside it.
find_path(WISP_EMSCRIPTEN_MODULES Platform/Emscripten.cmake NO_CMAKE_FIND_ROOT_PATH
  PATHS $ENV{EMSCRIPTEN}/cmake/Modules $ENV{EMSDK}/upstream/emscripten/cmake/Modules
        /usr/share/emscripten/cmake/Modules /usr/lib/emscripten/cmake/Modules)
if(NOT WISP_EMSCRIPTEN_MODULES)
  message(FATAL_ERROR "There is no Emscripten: install the package emscripten, or set EMSCRIPTEN to its folder.")
endif()
include(${WISP_EMSCRIPTEN_MODULES}/Platform/Emscripten.cmake)
