// The tables of recipes' fields: whole, and true of the recipes.

#include <gmock/gmock.h>

#include <set>
#include <string>
#include <tuple>

#include "wisp/learn/arx_recipe.hpp"
#include "wisp/learn/chain_recipe.hpp"
#include "wisp/learn/outline_recipe.hpp"

namespace wisp {
namespace {

using ::testing::HasSubstr;

template <class Recipe>
constexpr std::size_t kFields = std::tuple_size_v<decltype(fields_of(std::declval<Recipe>()))>;

// A field that joins a recipe breaks its binding here, and has to join the table too.
TEST(RecipeFields, HaveEveryField) {
  const auto& [a1, a2, a3, a4, a5, a6, a7, a8, a9, a10, a11, a12, a13, a14, a15, a16] = ArxRecipe{};
  static_assert(kFields<ArxRecipe> == 16);
  const auto& [s1, s2, s3, s4, s5, s6, s7, s8, s9] = SwitchedRecipe{};
  static_assert(kFields<SwitchedRecipe> == 9);
  const auto& [f1, f2, f3, f4, f5, f6] = FlickerRecipe{};
  static_assert(kFields<FlickerRecipe> == 6);
  const auto& [o1, o2, o3, o4, o5, o6, o7, o8] = OutlineRecipe{};
  static_assert(kFields<OutlineRecipe> == 8);
  const auto& [c1, c2, c3, c4, c5, c6, c7, c8, c9, c10, c11, c12, c13, c14, c15, c16] = ChainRecipe{};
  static_assert(kFields<ChainRecipe> == 16);
}

template <class Recipe>
void expect_sound(const Recipe& defaults) {
  std::set<std::string> names, flags;
  for_each_field(defaults, [&](const auto& field) {
    EXPECT_TRUE(names.insert(field.name).second) << field.name << " stands twice";
    EXPECT_STRNE(field.help, "") << field.name;
    const std::string flag = field.traits.flag ? field.traits.flag : "";
    EXPECT_TRUE(flag.empty() || flags.insert(flag).second) << flag << " stands twice";
  });
  const auto fits = check_fields(defaults);
  EXPECT_TRUE(fits) << fits.error().message;
}

TEST(RecipeFields, AreSoundAndHoldTheDefaults) {
  expect_sound(ArxRecipe{});
  expect_sound(SwitchedRecipe{});
  expect_sound(FlickerRecipe{});
  expect_sound(OutlineRecipe{});
  expect_sound(FlameRecipe{});
  expect_sound(ChainRecipe{});
  expect_sound(LeafRecipe{});
}

TEST(RecipeFields, SayWhichNumberIsOutsideItsRange) {
  EXPECT_EQ(check_fields(ChainRecipe{.best_of = 300}).error().message, "best_of is 300, expected 0 to 256");
  EXPECT_EQ(check_fields(SwitchedRecipe{.modes = 65}).error().message, "modes is 65, expected 1 to 64");
  EXPECT_EQ(check_fields(OutlineRecipe{.pixels_per_unit = -1}).error().message,
            "pixels_per_unit is -1, expected 0 or more");
  EXPECT_THAT(check_fields(FlickerRecipe{.rate_hz = std::nan("")}).error().message, HasSubstr("rate_hz is nan"));
  EXPECT_TRUE(check_fields(SwitchedRecipe{.modes = std::nullopt}));
  EXPECT_TRUE(check_fields(ChainRecipe{.modes = 0})) << "left open";
}

TEST(RecipeFields, HaveWordsThatReadBack) {
  for (const std::string_view word : kWordsOf<Realisation>) EXPECT_EQ(word_of(*value_of<Realisation>(word)), word);
  EXPECT_EQ(value_of<Realisation>("spline"), Realisation::kSpline);
  EXPECT_EQ(value_of<InitialState>("zero"), InitialState::kZero);
  EXPECT_EQ(value_of<Coupling>("loose"), std::nullopt);
}

}  // namespace
}  // namespace wisp
