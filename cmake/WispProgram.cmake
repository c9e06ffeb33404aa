#   wisp_program(NAME SOURCES file… LINKS library…)
#
# A program of bench/ or studies/. It finds the tests' headers, the layers' private ones, and recordings by
# WISP_SOURCE_DIR.
function(wisp_program name)
  cmake_parse_arguments(PROGRAM "" "" "SOURCES;LINKS" ${ARGN})
  add_executable(${name} ${PROGRAM_SOURCES})
  set_target_properties(${name} PROPERTIES CXX_EXTENSIONS OFF RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  target_link_libraries(${name} PRIVATE ${PROGRAM_LINKS})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/tests ${PROJECT_SOURCE_DIR}/src)
  target_compile_definitions(${name} PRIVATE WISP_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  wisp_warnings(${name})
endfunction()
