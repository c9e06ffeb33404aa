#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "model/sample_chain.hpp"
#include "model/sample_switched.hpp"
#include "run/bank/frame_path.hpp"
#include "run/flame_model.hpp"

namespace wisp::frame_path_choice_test {
namespace {

using testing::HasSubstr;

// Empty: as if it were not there.
void set_width(const char* width) {
#ifdef _WIN32
  _putenv_s("WISP_WIDTH", width);
#else
  setenv("WISP_WIDTH", width, 1);
#endif
}

// Sets WISP_WIDTH for a while.
class Width {
 public:
  explicit Width(const char* width) {
    if (const char* old = std::getenv("WISP_WIDTH")) before_ = old;
    set_width(width);
  }
  ~Width() { set_width(before_.c_str()); }
  Width(const Width&) = delete;
  Width& operator=(const Width&) = delete;

 private:
  std::string before_;
};

// All that is seen of 41 instances (five blocks together, and one that is not full) in 300 frames.
std::vector<float> lives(const Model& model, const char* width) {
  const Width forced(width);
  auto made = Bank::create(model, {.capacity = 41});
  EXPECT_TRUE(made) << made.error().message;
  Bank bank = std::move(made).value();
  for (int k = 0; k < 41; ++k) bank.spawn();
  std::vector<float> all, inputs(static_cast<std::size_t>(41) * bank.input_count());
  std::vector<float> outputs(static_cast<std::size_t>(41) * bank.output_count());
  for (int frame = 0; frame < 300; ++frame) {
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      inputs[k] = 0.1f * static_cast<float>((k * 7 + static_cast<std::size_t>(frame)) % 21) - 1.0f;
    }
    bank.set_inputs(inputs);
    bank.advance(std::chrono::milliseconds(17));
    bank.outputs(outputs);
    all.insert(all.end(), outputs.begin(), outputs.end());
  }
  return all;
}

TEST(FramePathChoice, GivesTheSameBitsAtEveryWidth) {
  const Model models[] = {flame_model({.wind = InputShape::kEvenOdd}), flame_model(), default_flame_model(),
                          windy_chain(), sample_switched()};
  for (const Model& model : models) {
    const auto narrow = lives(model, "baseline");
    for (const FramePath* path : frame_paths()) {
      const auto wide = lives(model, path->width);
      ASSERT_EQ(wide.size(), narrow.size());
      EXPECT_EQ(std::memcmp(wide.data(), narrow.data(), wide.size() * sizeof(float)), 0) << model.name << path->width;
    }
  }
}

TEST(FramePathChoice, IsTheWidestThatTheMachineHas) {
  const Width none("");
  const auto path = choose_frame_path();
  ASSERT_TRUE(path);
  EXPECT_EQ(*path, frame_paths().back());
}

TEST(FramePathChoice, IsTheOneThatTheEnvironmentNames) {
  for (const FramePath* each : frame_paths()) {
    const Width forced(each->width);
    const auto path = choose_frame_path();
    ASSERT_TRUE(path) << path.error().message;
    EXPECT_EQ(*path, each);
  }
}

TEST(FramePathChoice, OfAWidthThatIsNotThereIsAnError) {
  // Where only one was compiled, or the processor has no other, the variable is not read.
  if (frame_paths().size() == 1) GTEST_SKIP() << "there is but one width to choose from";
  const Width forced("mmx");
  const auto bank = Bank::create(flame_model(), {});
  ASSERT_FALSE(bank);
  EXPECT_FALSE(bank_bytes(flame_model(), {}));  // so that the C ABI does not take it for want of memory
  EXPECT_THAT(bank.error().message, HasSubstr("WISP_WIDTH is 'mmx', this machine has baseline"));
}

}  // namespace
}  // namespace wisp::frame_path_choice_test
