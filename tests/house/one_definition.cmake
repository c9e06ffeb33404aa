# One name, one definition, over everything that may be linked together: all objects of the layers and the program,
# compiled so that the linker sees their types, and a linker that takes two types of one name for an error.
#
#   wisp_one_definition(PROGRAM target…)    links the objects of those targets, and what their libraries stand on
function(wisp_one_definition program)
  add_executable(${program})
  foreach(target IN LISTS ARGN)
    get_target_property(type ${target} TYPE)
    # A group of layers, such as capture, has no objects of its own: its layers are in the list.
    if(type STREQUAL "INTERFACE_LIBRARY")
      continue()
    endif()
    target_sources(${program} PRIVATE $<TARGET_OBJECTS:${target}>)
    if(type STREQUAL "STATIC_LIBRARY")
      target_link_libraries(${program} PRIVATE ${target})
    endif()
  endforeach()
  set_target_properties(${program} PROPERTIES LINKER_LANGUAGE CXX)
endfunction()

# Before the targets are made. Nothing here is ever run, so nothing is optimised.
set(CMAKE_BUILD_TYPE "")
string(APPEND CMAKE_CXX_FLAGS " -O0 -flto=auto -fno-fat-lto-objects -Werror=odr")
string(APPEND CMAKE_C_FLAGS " -O0 -flto=auto -fno-fat-lto-objects")
# The plain ones do not read what the compiler left for the linker.
set(CMAKE_AR ${CMAKE_CXX_COMPILER_AR})
set(CMAKE_RANLIB ${CMAKE_CXX_COMPILER_RANLIB})
