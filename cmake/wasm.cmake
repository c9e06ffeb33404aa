# A toolchain for WebAssembly: Emscripten's own, with what Debian 12 needs beside it.
find_path(WISP_EMSCRIPTEN_MODULES Platform/Emscripten.cmake NO_CMAKE_FIND_ROOT_PATH
  PATHS $ENV{EMSCRIPTEN}/cmake/Modules $ENV{EMSDK}/upstream/emscripten/cmake/Modules
        /usr/share/emscripten/cmake/Modules /usr/lib/emscripten/cmake/Modules)
if(NOT WISP_EMSCRIPTEN_MODULES)
  message(FATAL_ERROR "There is no Emscripten: install the package emscripten, or set EMSCRIPTEN to its folder.")
endif()
include(${WISP_EMSCRIPTEN_MODULES}/Platform/Emscripten.cmake)

# Libraries of headers alone are this machine's own. Their folder may have the machine's C library beside them: each is
# seen through a link of its own.
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/headers)
file(CREATE_LINK /usr/include/nlohmann ${CMAKE_BINARY_DIR}/headers/nlohmann SYMBOLIC)
set(Eigen3_DIR /usr/share/eigen3/cmake CACHE PATH "")
set(nlohmann_json_DIR ${CMAKE_CURRENT_LIST_DIR}/wasm CACHE PATH "")
