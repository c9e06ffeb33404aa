#include "wisp/learn/chain_recipe.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace wisp {
namespace {

constexpr std::array<std::string_view, 3> kKinds = {"zero", "min", "max"};
constexpr std::array<std::string_view, 5> kRealisations = {"segments", "linear", "ode", "chain", "spline"};

constexpr std::pair<std::string_view, bool FeatureChoice::*> kFeatures[] = {
    {"velocity", &FeatureChoice::velocity},   {"length", &FeatureChoice::length},
    {"direction", &FeatureChoice::direction}, {"spin", &FeatureChoice::spin},
    {"tilt", &FeatureChoice::tilt},           {"duration", &FeatureChoice::duration}};

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

Result<FeatureChoice> parse_features(std::string_view text) {
  FeatureChoice choice{.velocity = false, .length = false, .direction = false};
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(','));
    bool known = false;
    for (const auto& [name, feature] : kFeatures) {
      if (word != name) continue;
      choice.*feature = known = true;
    }
    if (!known) {
      return Error{"a feature is \"" + std::string(word) +
                   "\", expected velocity, length, direction, spin, tilt or duration, separated by commas"};
    }
    text.remove_prefix(std::min(text.size(), word.size() + 1));
  }
  return choice;
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

std::string word_of(const FeatureChoice& features) {
  std::string words;
  for (const auto& [name, feature] : kFeatures) {
    if (features.*feature) words += (words.empty() ? "" : ",") + std::string(name);
  }
  return words;
}

std::string_view word_of(Realisation realisation) { return kRealisations[static_cast<std::size_t>(realisation)]; }

}  // namespace wisp
