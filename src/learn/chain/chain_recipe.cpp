#include "wisp/learn/chain_recipe.hpp"

#include <array>

namespace wisp {
namespace {

constexpr std::array<std::string_view, 3> kKinds = {"zero", "min", "max"};
constexpr std::array<std::string_view, 5> kRealisations = {"segments", "linear", "ode", "chain", "spline"};

}  // namespace

Result<EventSpec> parse_event(std::string_view text) {
  const std::size_t colon = text.find(':');
  for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
    if (text.substr(0, colon) != kKinds[kind] || colon == std::string_view::npos || colon + 1 == text.size()) continue;
    return EventSpec{static_cast<EventKind>(kind), std::string(text.substr(colon + 1))};
  }
  return Error{"the event is \"" + std::string(text) +
               "\", expected zero:SIGNAL, min:SIGNAL or max:SIGNAL, such as min:horizontal_speed"};
}

Result<Realisation> parse_realisation(std::string_view text) {
  for (std::size_t k = 0; k < kRealisations.size(); ++k) {
    if (text == kRealisations[k]) return static_cast<Realisation>(k);
  }
  return Error{"the realisation of modes is \"" + std::string(text) +
               "\", expected segments, linear, ode, chain or spline"};
}

std::string word_of(const EventSpec& event) {
  return std::string(kKinds[static_cast<std::size_t>(event.kind)]) + ":" + event.signal;
}

std::string_view word_of(Realisation realisation) { return kRealisations[static_cast<std::size_t>(realisation)]; }

}  // namespace wisp
