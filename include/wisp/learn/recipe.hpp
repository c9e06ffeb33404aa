#pragma once
// How a model is learned: one plain struct of settings for each kind of model.

#include <variant>

#include "wisp/learn/arx_recipe.hpp"
#include "wisp/learn/chain_recipe.hpp"
#include "wisp/learn/outline_recipe.hpp"

namespace wisp {

using Recipe = std::variant<ArxRecipe, SwitchedRecipe, OutlineRecipe, FlameRecipe, ChainRecipe, LeafRecipe>;

}  // namespace wisp
