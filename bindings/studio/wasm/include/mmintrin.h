// Eigen includes what MMX offers and uses none of it; WebAssembly has nothing of the kind.
#pragma once
// It also takes clang for an old GCC, and goes round a bug of that in x86's own assembler.
#undef EIGEN_COMP_GNUC
#define EIGEN_COMP_GNUC 0
