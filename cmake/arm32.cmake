# 32-bit ARM from Debian.
#
#   cmake --preset arm32
set(processor arm)
set(prefix arm-linux-gnueabihf)
include(${CMAKE_CURRENT_LIST_DIR}/debian_cross.cmake)
# GCC says of functions with structs by value that their call changed in GCC 7.
set(CMAKE_CXX_FLAGS_INIT -Wno-psabi)
