// Copies of reports where memory ends: each allocation of a copy fails once, and nothing is destroyed that was never
// made.

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "wisp/base/report.hpp"

namespace {
thread_local long allocations_left = -1;  // below 0: as many as one likes
}  // namespace

void* operator new(std::size_t size) {
  if (allocations_left == 0) throw std::bad_alloc();
  if (allocations_left > 0) --allocations_left;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
// Not inlined: GCC would see memory of operator new go to free() and warn, not knowing that both are replaced.
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace wisp {
namespace {

TEST(ReportMemory, ACopyThatFindsNoneLeavesNothingBehind) {
  const std::string longer = "longer than what a string keeps within itself";
  const ReportList inner{1.0, longer, ReportList{longer, 2.0, ReportList{1.0, longer}}};
  const ReportList original{inner, 3.0, inner};
  int failed = 0;
  for (long most = 0;; ++most) {
    try {
      allocations_left = most;
      const ReportList copy = original;
      allocations_left = -1;
      EXPECT_EQ(copy.size(), original.size());
      break;
    } catch (const std::bad_alloc&) {
      allocations_left = -1;
      ++failed;
    }
  }
  EXPECT_GE(failed, 10);
}

}  // namespace
}  // namespace wisp
