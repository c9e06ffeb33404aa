#include "wisp/learn/wind_gain.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "wisp/record/loudness.hpp"
#include "wisp/record/number_text.hpp"

namespace wisp {
namespace {

constexpr double kSame = 0.02;  // factors nearer to 1 than this are no choice

// The inputs that say in every recording how loud they are, and the loudest of each.
struct Loudest {
  std::string input;
  double rms = 0;
};

Result<std::vector<Loudest>> loudest_inputs(std::span<const Recording> recordings) {
  std::vector<Loudest> out;
  for (std::size_t c : channels_with_role(recordings.front(), Role::kInput)) {
    Loudest one{recordings.front().channels[c].name, 0};
    bool all = true;
    for (const Recording& recording : recordings) {
      const auto rms = one_rms(recording, one.input);
      if (!rms) return rms.error();
      all = all && *rms;
      one.rms = std::max(one.rms, rms->value_or(0));
    }
    if (all) out.push_back(std::move(one));
  }
  return out;
}

// What the first of these inputs is multiplied by, recording by recording.
std::vector<double> factors_of(std::span<const Recording> recordings, const Loudest& loudest) {
  std::vector<double> out;
  for (const Recording& recording : recordings) {
    out.push_back(*factor_at(recording, loudest.input, loudest.rms));  // says how loud it was: loudest_inputs()
  }
  return out;
}

// Mean error of free simulation over the control points on what is held out; nothing where too little is.
Result<std::optional<double>> held_out_error(std::span<const Recording> recordings, OutlineOptions options) {
  options.refit = false;
  options.noise = OutlineNoise::kIndependent;  // is not judged here
  options.match_variance = false;
  const auto fit = learn_outline(recordings, options);
  if (!fit) return fit.error();
  if (!fit->summary.held_out) return std::optional<double>();
  const std::vector<double>& free = fit->summary.held_out->j.back();
  return std::optional(std::accumulate(free.begin(), free.end(), 0.0) / static_cast<double>(free.size()));
}

std::string scale_words(const std::vector<double>& factors, bool one) {
  const auto [least, most] = std::minmax_element(factors.begin(), factors.end());
  if (!one) return "every recording's wind on a scale of its own";
  return "the winds of all recordings on one scale, as one microphone hears them (times " + number_text(*least, 3) +
         " to " + number_text(*most, 3) + ")";
}

Result<void> compare(std::span<const Recording> recordings, const OutlineOptions& options, WindGain& gain) {
  const auto together = at_one_gain({recordings.begin(), recordings.end()});
  if (!together) return together.error();
  const auto one = held_out_error(*together, options);
  if (!one) return one.error();
  const auto own = held_out_error(recordings, options);
  if (!own) return own.error();
  if (!*one || !*own) {
    gain.reason = "; too little is held out to tell whether it was one";
    return {};
  }
  gain.one_error = **one;
  gain.own_error = **own;
  gain.one = gain.one_error <= gain.own_error;
  gain.reason = ": free simulation of what is held out errs by " + number_text(gain.one_error, 3) + " on one scale, " +
                number_text(gain.own_error, 3) + " on scales of their own";
  return {};
}

}  // namespace

Result<std::vector<Recording>> at_one_gain(std::vector<Recording> recordings) {
  const auto inputs = loudest_inputs(recordings);
  if (!inputs) return inputs.error();
  for (const Loudest& loudest : *inputs) {
    for (Recording& recording : recordings) {
      auto heard = heard_at(std::move(recording), loudest.input, loudest.rms);
      if (!heard) return heard.error();
      recording = *std::move(heard);
    }
  }
  return recordings;
}

Result<WindGain> choose_wind_gain(std::span<const Recording> recordings, const OutlineOptions& options,
                                  std::optional<bool> wanted) {
  WindGain gain{.one = wanted.value_or(true), .factors = {}, .reason = {}};
  const auto inputs = loudest_inputs(recordings);
  if (!inputs) return inputs.error();
  if (inputs->empty() || (options.inputs && options.inputs->empty())) return gain;
  gain.factors = factors_of(recordings, inputs->front());
  const double least = *std::min_element(gain.factors.begin(), gain.factors.end());
  if (least > 1 - kSame) {
    gain.factors.clear();
    return gain;
  }
  if (wanted) {
    gain.reason = ", as asked for";
  } else if (auto ok = compare(recordings, options, gain); !ok) {
    return ok.error();
  }
  gain.reason = scale_words(gain.factors, gain.one) + gain.reason;
  return gain;
}

Result<double> factor_to_trained_gain(const Model& model, const Recording& recording) {
  for (std::size_t k = 0; k < model.training.inputs.size(); ++k) {
    const double trained = model.training.inputs[k].one_rms;
    if (trained > 0) return factor_at(recording, model.inputs[k].name, trained);
  }
  return 1.0;
}

Result<Recording> at_trained_gain(const Model& model, Recording recording) {
  for (std::size_t k = 0; k < model.training.inputs.size(); ++k) {
    const double trained = model.training.inputs[k].one_rms;
    if (trained == 0) continue;
    auto heard = heard_at(std::move(recording), model.inputs[k].name, trained);
    if (!heard) return heard.error();
    recording = *std::move(heard);
  }
  return recording;
}

}  // namespace wisp
