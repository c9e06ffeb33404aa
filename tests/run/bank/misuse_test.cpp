// Broken preconditions, for every shipped model: what is reported, and that nothing else happens.

#include "wisp/base/result.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <vector>

#include "shipped.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace wisp::misuse_test {
namespace {

// What a call reports; "" where it reports nothing.
std::string reported_by(const std::function<void()>& call) {
  const MisuseHandler before = set_misuse_handler([](const char* sentence) { throw std::runtime_error(sentence); });
  std::string sentence;
  try {
    call();
  } catch (const std::runtime_error& error) {
    sentence = error.what();
  }
  set_misuse_handler(before);
  return sentence;
}

// A call with a buffer of that many numbers.
struct Door {
  const char* name;
  std::size_t size;  // that it states
  bool rows;         // one row a slot: more is right too
  std::function<void(Bank&, InstanceId, std::span<float>)> call;
};

std::vector<Door> doors_of(const Bank& bank) {
  const auto rows = static_cast<std::size_t>(bank.slots()), inputs = static_cast<std::size_t>(bank.input_count()),
             outputs = static_cast<std::size_t>(bank.output_count()),
             points = 2 * static_cast<std::size_t>(bank.polyline_points());
  using Values = std::span<float>;
  std::vector<Door> doors = {
      {"set_inputs()", rows * inputs, true, [](Bank& b, InstanceId, Values v) { b.set_inputs(v); }},
      {"set_inputs()", inputs, false, [](Bank& b, InstanceId id, Values v) { b.set_inputs(id, v); }},
      {"set_common_inputs()", inputs, false, [](Bank& b, InstanceId, Values v) { b.set_common_inputs(v); }},
      {"outputs()", rows * outputs, true, [](Bank& b, InstanceId, Values v) { b.outputs(v); }},
      {"outputs()", outputs, false, [](Bank& b, InstanceId id, Values v) { b.outputs(id, v); }},
      {"step()", 2 * rows * outputs, false, [](Bank& b, InstanceId, Values v) { b.step(2, {}, v); }},
  };
  if (points > 0) {
    doors.push_back({"polylines()", rows * points, true, [](Bank& b, InstanceId, Values v) { b.polylines(v); }});
    doors.push_back({"polyline()", points, false, [](Bank& b, InstanceId id, Values v) { b.polyline(id, v); }});
  }
  return doors;
}

TEST(Misuse, EverySizeOfEveryDoorIsCheckedForEveryShippedModel) {
  int checked = 0;
  for (const std::string& path : shipped_models()) {
    const auto model = read_model(path);
    ASSERT_TRUE(model) << path;
    auto bank = Bank::create(*model, {.capacity = 5});
    ASSERT_TRUE(bank) << path;
    const InstanceId id = bank->spawn();
    for (int k = 0; k < 2; ++k) bank->spawn();
    for (const Door& door : doors_of(*bank)) {
      for (const std::size_t size : {std::size_t{0}, door.size - std::min<std::size_t>(door.size, 1), door.size,
                                     door.size + 1, door.size + 1000}) {
        std::vector<float> values(size, 0.25F);
        const bool empty_step = std::string(door.name) == "step()" && size == 0;  // nothing is asked for
        const bool right = size == door.size || (door.rows && size > door.size) || empty_step;
        const std::string said = reported_by([&] { door.call(*bank, id, values); });
        EXPECT_EQ(said == "", right) << path << ", " << door.name << " of " << size << ": " << said;
        EXPECT_TRUE(right || said.find(door.name) != std::string::npos) << said;
        ++checked;
      }
    }
    if (bank->polyline_points() == 0) {
      std::vector<float> none;
      EXPECT_NE(reported_by([&] { bank->polylines(none); }).find("no outline"), std::string::npos) << path;
      EXPECT_NE(reported_by([&] { bank->polyline(id, none); }).find("no outline"), std::string::npos) << path;
    }
  }
  EXPECT_GT(checked, 300);
}

// A game allocates once for all that may live; its last candle ends, then one in the middle.
TEST(Misuse, ABufferOfCapacityRowsAlwaysServes) {
  for (const std::string& path : shipped_models()) {
    auto bank = Bank::create(*read_model(path), {.capacity = 4});
    const auto width = static_cast<std::size_t>(bank->output_count());
    std::vector<float> inputs(4 * static_cast<std::size_t>(bank->input_count())), outputs(4 * width);
    std::vector<InstanceId> ids;
    for (int k = 0; k < 4; ++k) ids.push_back(bank->spawn());
    for (const std::size_t ended : {3, 1}) {
      bank->end(ids[ended]);
      std::fill(outputs.begin(), outputs.end(), 77.0F);
      EXPECT_EQ(reported_by([&] {
                  bank->set_inputs(inputs);
                  bank->step();
                  bank->outputs(outputs);
                }),
                "")
          << path;
      for (std::size_t i = 0; i < width; ++i) {
        EXPECT_EQ(outputs[ended * width + i], 0) << path;
        EXPECT_NE(outputs[i], 77) << path;
      }
    }
  }
}

TEST(Misuse, ASavedBankOfEveryShippedModelIsRestored) {
  for (const std::string& path : shipped_models()) {
    const auto model = read_model(path);
    for (const std::uint64_t seed : {1, 2, 3}) {
      auto bank = Bank::create(*model, {.capacity = 4, .seed = seed});
      for (int k = 0; k < 4; ++k) bank->spawn();
      if (bank->extinction()) bank->extinction()->extinguish(bank->at(2));
      std::vector<std::byte> saved(bank->save_bytes());
      for (int frame = 0; frame < 20; ++frame) {
        bank->advance(std::chrono::milliseconds(37));
        bank->save(saved);
        const auto restored = bank->restore(saved);
        ASSERT_TRUE(restored) << path << ": " << restored.error().message;
      }
    }
  }
}

TEST(Misuse, AHandlerThatReturnsLeavesTheBankAsItWas) {
  static int reports = 0;
  auto bank = Bank::create(*read_model(shipped_models()[0]));
  const InstanceId id = bank->spawn();
  bank->step();
  std::vector<float> before(static_cast<std::size_t>(bank->output_count())), short_by_one(before.size() - 1),
      after(before);
  bank->outputs(id, before);
  const MisuseHandler handler = set_misuse_handler([](const char*) { ++reports; });
  EXPECT_FALSE(bank->outputs(id, short_by_one));
  bank->step(-1);
  bank->set_crew({.parts = 0});
  set_misuse_handler(handler);
  EXPECT_EQ(reports, 3);
  bank->outputs(id, after);
  EXPECT_EQ(before, after);
}

TEST(MisuseDeathTest, AnErrorsValueEndsWithItsSentence) {
  const auto wrong = read_model("/there/is/none.wisp");
  EXPECT_DEATH((void)wrong.value(), "none.wisp");
  const Result<int> right = 3;
  EXPECT_DEATH((void)right.error(), "holds a value");
  const Result<void> done;
  EXPECT_DEATH((void)done.error(), "holds no error");
}

TEST(Misuse, SecondsPassAsNanosecondsDo) {
  const auto model = read_model(shipped_models()[0]);
  auto a = Bank::create(*model), b = Bank::create(*model);
  const InstanceId in_a = a->spawn(), in_b = b->spawn();
  std::vector<float> of_a(static_cast<std::size_t>(a->output_count())), of_b(of_a);
  for (const double seconds : {0.016, 0.25, -1.0, std::nan(""), 1e300}) {
    const double time = seconds > 0 ? std::min(seconds, 10.0) : 0;
    EXPECT_EQ(a->advance(seconds), b->advance(std::chrono::nanoseconds(std::llround(time * 1e9)))) << seconds;
    a->outputs(in_a, of_a);
    b->outputs(in_b, of_b);
    EXPECT_EQ(of_a, of_b) << seconds;
  }
}

}  // namespace
}  // namespace wisp::misuse_test
