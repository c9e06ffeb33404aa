# 64-bit ARM from Debian.
#
#   cmake --preset arm64
set(processor aarch64)
set(prefix aarch64-linux-gnu)
include(${CMAKE_CURRENT_LIST_DIR}/debian_cross.cmake)
