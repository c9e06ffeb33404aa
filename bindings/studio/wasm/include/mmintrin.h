// Eigen includes MMX intrinsics without using them; WebAssembly has none.
#pragma once
// Eigen also mistakes clang for an old GCC, and works around that GCC's bug in x86 assembler.
#undef EIGEN_COMP_GNUC
#define EIGEN_COMP_GNUC 0
