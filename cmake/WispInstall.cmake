# What `cmake --install` puts in place beside the program: headers, one static library a layer, and the package files of
# find_package(wisp). Every layer is an export set of its own, so that a game that asks for wisp::run never has to find
# FFmpeg.
#
# Components: `program` (the program and the models that come with it), `runtime` (the shared library that programs load),
# `development` (all else). cmake --install BUILD --component runtime
include(CMakePackageConfigHelpers)

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/wisp)
get_property(layers GLOBAL PROPERTY WISP_LAYERS)
set(WISP_INSTALLED_LAYERS)
foreach(layer IN LISTS layers)
  string(REGEX REPLACE "^wisp_" "" name ${layer})
  list(APPEND WISP_INSTALLED_LAYERS ${name})
  install(TARGETS ${layer} EXPORT wisp-${name} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
  install(EXPORT wisp-${name} NAMESPACE wisp:: DESTINATION ${package} COMPONENT development)
endforeach()

if(WISP_BUILD_SHARED)
  install(TARGETS wisp_shared EXPORT wisp-shared
    RUNTIME COMPONENT runtime
    LIBRARY COMPONENT runtime NAMELINK_COMPONENT development
    ARCHIVE COMPONENT development)
  install(EXPORT wisp-shared NAMESPACE wisp:: DESTINATION ${package} COMPONENT development)
  list(APPEND WISP_INSTALLED_LAYERS shared)
  # A pkg-config file that says where it lies, not where it was built.
  file(RELATIVE_PATH WISP_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/wisp.pc.in ${PROJECT_BINARY_DIR}/wisp.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/wisp.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
    COMPONENT development)
endif()

set(WISP_CXX_LIBRARIES ${CMAKE_CXX_IMPLICIT_LINK_LIBRARIES})
list(REMOVE_ITEM WISP_CXX_LIBRARIES ${CMAKE_C_IMPLICIT_LINK_LIBRARIES})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/wisp-config.cmake.in
  ${PROJECT_BINARY_DIR}/wisp-config.cmake INSTALL_DESTINATION ${package} NO_SET_AND_CHECK_MACRO)
# Before 1.0 a minor version may break what a host relies on.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/wisp-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/wisp-config.cmake ${PROJECT_BINARY_DIR}/wisp-config-version.cmake
  DESTINATION ${package} COMPONENT development)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/wisp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  COMPONENT development FILES_MATCHING PATTERN "*.hpp" PATTERN "*.h")
foreach(component program runtime development)
  set(documents ${CMAKE_INSTALL_DATADIR}/doc/wisp-${component})
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/third_party/NOTICES.txt
    DESTINATION ${documents} COMPONENT ${component})
  install(FILES ${PROJECT_SOURCE_DIR}/third_party/flatbuffers/LICENSE DESTINATION ${documents} RENAME LICENSE.Apache-2.0
    COMPONENT ${component})
endforeach()

if(PROJECT_IS_TOP_LEVEL)
  include(WispPackage)
endif()
