#include "run/chain/chain_program.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "model/sample_chain.hpp"

namespace wisp::chain_program_test {
namespace {

class Program {
 public:
  explicit Program(const Model& model) {
    const auto& chain = std::get<ChainModel>(model.dynamics);
    Arena measured;
    make_chain_program(chain, model.rate_hz, 1, measured);
    memory_.resize(measured.bytes());
    Arena arena(memory_);
    program_ = make_chain_program(chain, model.rate_hz, 1, arena);
  }

  const ChainProgram* operator->() const { return &program_; }

 private:
  std::vector<std::byte> memory_;
  ChainProgram program_;
};

// What differences are measured in is what is usual where segments join.
TEST(ChainProgram, UnitsAreRootMeanSquares) {
  double speed = 0, spin = 0;
  for (int k = 0; k < 3; ++k) {
    speed += std::pow(0.6, 2) + std::pow(0.06 * (1 + k), 2) + std::pow(0.75, 2);
    spin += std::pow(60 * sample_turn(static_cast<std::size_t>(k)), 2);
  }
  const Program program(sample_chain());
  EXPECT_NEAR(program->speed_unit, std::sqrt(speed / 3), 1e-4);
  EXPECT_NEAR(program->spin_unit, std::sqrt(spin / 3), 1e-3);
  EXPECT_NEAR(Program(sample_chain(ChainMotion::kPosition))->speed_unit, std::sqrt(speed / 3), 1e-4);
}

TEST(ChainProgram, MeanStepsAreThoseOfItsSegments) {
  EXPECT_FLOAT_EQ(Program(steered_chain())->mean_steps, (8 + 5 + 12) / 3.0f);
}

}  // namespace
}  // namespace wisp::chain_program_test
