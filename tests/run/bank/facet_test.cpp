// What only some models have is there for them, and null for the others.

#include <gtest/gtest.h>

#include "model/sample_chain.hpp"
#include "model/sample_switched.hpp"
#include "run/flame_model.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/chain_facet.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace wisp::facet_test {
namespace {

Bank bank_of(const Model& model) {
  auto bank = Bank::create(model);
  EXPECT_TRUE(bank) << bank.error().message;
  bank->spawn();
  return std::move(bank).value();
}

TEST(Facets, AnArxModelHasNone) {
  Bank bank = bank_of(flame_model());
  EXPECT_EQ(bank.chain(), nullptr);
  EXPECT_EQ(bank.extinction(), nullptr);
  EXPECT_FALSE(bank.mode(bank.at(0)));
}

TEST(Facets, EachKindHasItsOwn) {
  Model mortal = flame_model();
  mortal.extinction.emplace();
  Bank flame = bank_of(mortal), leaf = bank_of(sample_chain()), tank = bank_of(sample_switched());
  EXPECT_NE(flame.extinction(), nullptr);
  EXPECT_EQ(flame.chain(), nullptr);
  EXPECT_NE(leaf.chain(), nullptr);
  EXPECT_EQ(leaf.extinction(), nullptr);
  EXPECT_FALSE(leaf.mode(leaf.at(0)));
  EXPECT_FALSE(tank.mode(tank.at(0)));
  tank.step();
  EXPECT_TRUE(tank.mode(tank.at(0)));
  EXPECT_EQ(tank.chain(), nullptr);
}

TEST(Facets, TheyMoveWithTheirBank) {
  Bank bank = bank_of(sample_chain());
  ChainFacet* chain = bank.chain();
  chain->set_ground(-1.0f);
  const Bank moved = std::move(bank);
  EXPECT_EQ(moved.chain(), chain);
  EXPECT_EQ(chain->ground(), -1.0f);
  EXPECT_TRUE(chain->place_of(moved.at(0)));
}

TEST(Facets, AChainSaysWhetherItCanBeSteered) {
  EXPECT_FALSE(bank_of(sample_chain()).chain()->can_steer());
  EXPECT_TRUE(bank_of(steered_chain()).chain()->can_steer());
}

TEST(Facets, TheModeOfAPlaceIsThatOfItsSegment) {
  const Model model = sample_chain();
  Bank bank = bank_of(model);
  for (int step = 0; step < 200; ++step) {
    const ChainPlace place = *bank.chain()->place_of(bank.at(0));
    ASSERT_EQ(place.mode, std::get<ChainModel>(model.dynamics).segments.mode[place.segment]);
    bank.step();
  }
}

}  // namespace
}  // namespace wisp::facet_test
