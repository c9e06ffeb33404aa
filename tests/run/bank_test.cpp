#include "wisp/run/bank.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "model/sample_model.hpp"

namespace wisp {
namespace {

TEST(Bank, AnInstanceMovesWithItsNoise) {
  auto bank = Bank::create(sample_model(), {.capacity = 3});
  ASSERT_TRUE(bank) << bank.error().message;
  const InstanceId id = bank->spawn();
  std::vector<float> before(bank->output_count()), after(bank->output_count());
  ASSERT_TRUE(bank->outputs(id, before));
  bank->step();
  ASSERT_TRUE(bank->outputs(id, after));
  EXPECT_NE(before, after);
}

}  // namespace
}  // namespace wisp
