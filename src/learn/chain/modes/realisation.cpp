#include "wisp/learn/realisation.hpp"

#include <array>
#include <string>

namespace wisp {
namespace {

constexpr std::array<std::string_view, 5> kWords = {"segments", "linear", "ode", "chain", "spline"};

}  // namespace

Result<Realisation> parse_realisation(std::string_view text) {
  for (std::size_t k = 0; k < kWords.size(); ++k) {
    if (text == kWords[k]) return static_cast<Realisation>(k);
  }
  return Error{"modes are to be realised by \"" + std::string(text) +
               "\", expected segments, linear, ode, chain or spline"};
}

std::string_view word_of(Realisation realisation) { return kWords[static_cast<std::size_t>(realisation)]; }

}  // namespace wisp
