// Fixed point. P is the smallest power of two that the output's distance from its mean does not exceed. The state is in
// units of P · 2^-29, coefficients in 2^-28 and sums in P · 2^-25, so that a product is the upper half of 32 by 32
// bits. Shocks are drawn by inversion from 17 quantiles (L. Devroye, Non-Uniform Random Variate Generation, 1986,
// section II.2), interpolated linearly, and by a fourth power towards the first and the last. Random bits are those of
// G. Marsaglia's xorshift32 (Journal of Statistical Software 8, 2003).

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "base/statistics.hpp"
#include "export/templates.hpp"
#include "wisp/export/export.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"

namespace wisp {
namespace {

constexpr int kWeightBits = 28, kSumBits = 25, kOneBits = 12;
constexpr std::size_t kMaxModes = 16, kMaxLags = 32;
constexpr double kMaxWeight = 8, kMaxSum = 24;
// Quantiles of the normal distribution; the first and the last are set so that shocks have its kurtosis, 3.
constexpr std::array<double, kShockQuantiles> kNormal{-3.2,    -1.5341, -1.1503, -0.8871, -0.6745, -0.4888,
                                                      -0.3186, -0.1573, 0,       0.1573,  0.3186,  0.4888,
                                                      0.6745,  0.8871,  1.1503,  1.5341,  3.2};

// The coefficients of a model with one output.
struct Lamp {
  std::vector<std::vector<double>> feedback;                      // per mode and lag: weight in the prediction
  std::vector<double> constant, shock;                            // per mode
  std::vector<double> transitions;                                // modes × modes
  std::vector<double> quantiles{kNormal.begin(), kNormal.end()};  // quantiles of the shocks
  std::size_t lags = 1;
  double mean = 0;
};

void add_mode(const ArxModel& arx, double shock, Lamp& lamp) {
  auto& feedback = lamp.feedback.emplace_back();
  for (const double a : arx.a(0, 0)) feedback.push_back(-a);
  lamp.constant.push_back(arx.constant[0]);
  lamp.shock.push_back(shock);
  lamp.lags = std::max(lamp.lags, feedback.size());
  lamp.mean = arx.output_mean[0];
}

void add_only_mode(const ArxModel& arx, Lamp& lamp) {
  double square = arx.noise.sd.empty() ? 0 : arx.noise.sd[0] * arx.noise.sd[0];
  if (const auto& resampled = arx.noise.resampled; !resampled.empty()) {
    std::vector<double> rows(resampled.rows.begin(), resampled.rows.end());
    for (double& row : rows) row *= resampled.scale[0];
    square = mean(rows) * mean(rows) + deviation(rows) * deviation(rows);
    for (std::size_t k = 0; k < kShockQuantiles; ++k) {
      lamp.quantiles[k] = quantile(rows, static_cast<double>(k) / (kShockQuantiles - 1));
    }
  }
  add_mode(arx, std::sqrt(square), lamp);
  lamp.transitions = {1};
}

// Quantiles as bytes, and the mean and standard deviation of shocks drawn from them.
struct Shocks {
  std::array<int, kShockQuantiles> bytes{};
  double mean = 0, sd = 0;
};

Shocks shocks_of(const std::vector<double>& quantiles) {
  Shocks shocks;
  const double largest = std::max({1e-12, std::abs(quantiles.front()), std::abs(quantiles.back())});
  for (std::size_t k = 0; k < kShockQuantiles; ++k) {
    shocks.bytes[k] = static_cast<int>(std::lround(127 * std::clamp(quantiles[k] / largest, -1.0, 1.0)));
  }
  std::vector<double> drawn;
  const auto steeper = [](int part) { return (part * part >> 8) * (part * part >> 8) >> 8; };
  for (std::size_t k = 0; k + 1 < kShockQuantiles; ++k) {
    for (int part = 0; part < 256; ++part) {
      const int share = k == 0 ? 255 - steeper(255 - part) : k + 2 == kShockQuantiles ? steeper(part) : part;
      drawn.push_back(256 * shocks.bytes[k] + (shocks.bytes[k + 1] - shocks.bytes[k]) * share);
    }
  }
  shocks.mean = mean(drawn);
  shocks.sd = std::max(1.0, deviation(drawn));
  return shocks;
}

Result<Lamp> lamp_of(const Model& model) {
  if (model.outputs.size() != 1) {
    return Error{"the model has " + std::to_string(model.outputs.size()) +
                 " outputs, a lamp has one; learn its brightness with `wisp learn flicker`"};
  }
  if (!model.inputs.empty()) {
    return Error{"the model has an input, a lamp has none; learn its brightness with `wisp learn flicker`"};
  }
  Lamp lamp;
  if (const auto* arx = std::get_if<ArxModel>(&model.dynamics)) {
    add_only_mode(*arx, lamp);
  } else if (const auto* switched = std::get_if<SwitchedArxModel>(&model.dynamics)) {
    for (std::size_t mode = 0; mode < switched->modes.size(); ++mode) {
      add_mode(mode_model(*switched, mode), switched->modes[mode].shock[0], lamp);
    }
    lamp.transitions = switched->transitions;
    if (!switched->shock_quantiles.empty()) lamp.quantiles = switched->shock_quantiles;
  } else {
    return Error{"the model is a chain of segments, which no small microcontroller holds"};
  }
  return lamp;
}

// Checks the limits of fixed point and of a small memory.
Result<void> check(const Lamp& lamp) {
  if (lamp.feedback.size() > kMaxModes || lamp.lags > kMaxLags) {
    return Error{"the model has more than 16 modes or 32 lags; learn a smaller one"};
  }
  for (const auto& weights : lamp.feedback) {
    double sum = 0;
    for (const double weight : weights) {
      sum += std::abs(weight);
      if (std::abs(weight) >= kMaxWeight || sum >= kMaxSum) {
        return Error{
            "its coefficients are 8 or more, or 24 together, which fixed point does not hold; learn it with a "
            "lower order"};
      }
    }
  }
  return {};
}

std::string whole(double value) { return std::to_string(static_cast<std::int64_t>(std::llround(value))); }

// Formats rows of numbers as C initialisers.
template <class Value>
std::string table(const std::string& type, const std::string& name, std::size_t rows, std::size_t columns,
                  Value value) {
  std::string text = "static const " + type + " " + name + "[" + std::to_string(rows) + "][" + std::to_string(columns) +
                     "] LAMP_FLASH = {\n";
  for (std::size_t row = 0; row < rows; ++row) {
    text += "    {";
    for (std::size_t column = 0; column < columns; ++column) {
      text += (column > 0 ? ", " : "") + whole(value(row, column));
    }
    text += "},\n";
  }
  return text + "};\n";
}

constexpr const char* kSwitch = R"(  uint8_t k;
  word = next_random(lamp);
  for (k = 0; k < @LASTMODE@ && (uint16_t)word >= LAMP_16(&thresholds[lamp->mode][k]); ++k) continue;
  /* Below 128 breeze skips some moves to a higher mode, from 128 on some to a lower one. */
  const uint8_t chance = (uint8_t)(word >> 24) & 0x7f;
  if ((k > lamp->mode ? lamp->breeze : (uint8_t)~lamp->breeze) > chance) lamp->mode = k;
)";

std::string thresholds(const Lamp& lamp) {
  const std::size_t modes = lamp.feedback.size();
  const auto value = [&](std::size_t from, std::size_t to) {
    double sum = 0;
    for (std::size_t k = 0; k <= to; ++k) sum += lamp.transitions[from * modes + k];
    return std::clamp(sum * 65536, 0.0, 65535.0);
  };
  return "/* From each mode: a random word below the first leads to mode 0, and so on. */\n" +
         table("uint16_t", "thresholds", modes, modes - 1, value);
}

}  // namespace

bool exporting::is_name(std::string_view name) {
  const auto plain = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  return !name.empty() && !std::isdigit(static_cast<unsigned char>(name[0])) &&
         std::all_of(name.begin(), name.end(), plain);
}

std::string exporting::comment_text(std::string text) {
  std::erase_if(text, [](char c) { return c == '*' || c == '"' || static_cast<unsigned char>(c) < 0x20; });
  return text;
}

Result<FirmwareSource> firmware_source(const Model& model, std::string_view name) {
  if (!exporting::is_name(name)) return Error{"\"" + std::string(name) + "\" is no name in C; call the file after one"};
  if (auto ok = wisp::check(model); !ok) return ok.error();
  const auto lamp = lamp_of(model);
  if (!lamp) return lamp.error();
  if (auto ok = check(*lamp); !ok) return ok.error();
  if (std::abs(model.rate_hz - std::round(model.rate_hz)) > 0.005 * model.rate_hz)  // the header has it as an integer
    return Error{"the model makes " + std::to_string(model.rate_hz) +
                 " steps a second, expected a whole number from 1"};
  const Output& output = model.outputs[0];
  const double margin = kRangeMargin * (output.highest - output.lowest), one = 1 << kOneBits;
  const double below = output.lowest - margin, highest = output.highest + margin;
  const double lowest = output.lowest >= 0 ? std::max(0.0, below) : below;  // light is never negative
  const double reach = std::max({highest - lamp->mean, lamp->mean - lowest, 1e-6});
  const int exponent = static_cast<int>(std::ceil(std::log2(reach)));
  // Within these limits the output range fits into 16 bits.
  if (exponent > 2 || exponent < -8 || std::abs(lamp->mean) > 3.9) {
    return Error{"the output is about " + std::to_string(lamp->mean) + " and moves by " + std::to_string(reach) +
                 ", expected at most 3.9 and 0.002 to 4; learn it with mean 1"};
  }
  const double sum_one = std::ldexp(1, kSumBits - exponent);
  const std::size_t modes = lamp->feedback.size();
  const Shocks shocks = shocks_of(lamp->quantiles);
  const auto unit = [&](std::size_t mode) { return lamp->shock[mode] * sum_one / shocks.sd; };  // weight of a shock
  const auto weight = [&](std::size_t mode, std::size_t column) {
    if (column == 0) return lamp->constant[mode] * sum_one - shocks.mean * unit(mode);
    if (column > lamp->lags) return std::min(65536 * unit(mode), 2147483647.0);
    const auto& feedback = lamp->feedback[mode];
    return column <= feedback.size() ? std::ldexp(feedback[column - 1], kWeightBits) : 0;
  };
  std::string upper(name);
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const std::vector<std::pair<std::string, std::string>> words = {
      {"SWITCH", modes > 1 ? kSwitch : ""},
      {"THRESHOLDS", modes > 1 ? thresholds(*lamp) : ""},
      {"QUANTILES", table("int8_t", "quantiles", 1, kShockQuantiles, [&](auto, auto k) { return shocks.bytes[k]; })},
      {"WEIGHTS", table("int32_t", "weights", modes, lamp->lags + 2, weight)},
      {"LASTMODE", std::to_string(modes - 1)},
      {"ONEWORDS", output.name == "brightness" ? ", the mean light" : ""},
      {"LAGS", std::to_string(lamp->lags)},
      {"LARGEST", std::to_string((1 << kSumBits) - 1)},
      {"SHOWNSHIFT", std::to_string(kSumBits - exponent - kOneBits)},
      {"MEAN", whole(one * lamp->mean)},
      {"LOWEST", whole(one * lowest)},
      {"HIGHEST", whole(one * highest)},
      {"RATE", whole(model.rate_hz)},
      {"GUARD", upper + "_H"},
      {"UPPER", upper},
      {"MODEL", exporting::comment_text(model.name)},
      {"NAME", std::string(name)}};
  FirmwareSource out{exporting::filled(exporting::lamp_h, words), exporting::filled(exporting::lamp_c, words), 0};
  out.state_bytes = 4 * (lamp->lags + 1) + 4 + 2;
  return out;
}

}  // namespace wisp
