// Fixed point: the state is in units of 2^-29 of a power of two above its range, coefficients in 2^-28, and sums in
// 2^-25, so that a product is the upper half of 32 by 32 bits. Shocks: the sum of four uniform bytes (Irwin-Hall), from
// G. Marsaglia's xorshift32 (Journal of Statistical Software 8, 2003).

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "wisp/export/export.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"

// What is written, with words to fill in: lamp.h.in and lamp.c.in.
namespace wisp::exporting {
extern const char* const lamp_header;
extern const char* const lamp_source;
}  // namespace wisp::exporting

namespace wisp {
namespace {

constexpr int kWeightBits = 28, kSumBits = 25, kOneBits = 12;
constexpr std::size_t kMaxModes = 16, kMaxLags = 32;
constexpr double kMaxWeight = 8, kMaxSum = 24;
// Standard deviation of the sum of four bytes from -128 to 127.
const double kBytesSd = std::sqrt(4.0 * (256 * 256 - 1) / 12);

// The coefficients of a model with one output.
struct Lamp {
  std::vector<std::vector<double>> feedback;  // per mode and lag, sign of the prediction
  std::vector<double> constant, shock;        // per mode
  std::vector<double> transitions;            // modes × modes
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

// Standard deviation of the shocks of a single ARX model.
double shock_of(const ArxModel& arx) {
  double square = arx.noise.sd.empty() ? 0 : arx.noise.sd[0] * arx.noise.sd[0];
  for (const double each : arx.noise.mixing) square += each * each;
  if (!arx.noise.resampled.empty()) {
    square = 0;
    for (const std::int16_t row : arx.noise.resampled.rows) square += std::pow(row * arx.noise.resampled.scale[0], 2);
    square /= static_cast<double>(arx.noise.resampled.row_count());
  }
  return std::sqrt(square);
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
    add_mode(*arx, shock_of(*arx), lamp);
    lamp.transitions = {1};
  } else if (const auto* switched = std::get_if<SwitchedArxModel>(&model.dynamics)) {
    for (std::size_t mode = 0; mode < switched->modes.size(); ++mode) {
      add_mode(mode_model(*switched, mode), switched->modes[mode].shock[0], lamp);
    }
    lamp.transitions = switched->transitions;
  } else {
    return Error{"the model is a chain of segments, which no small microcontroller holds"};
  }
  return lamp;
}

// Limits of fixed point and a small memory.
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

bool is_name(std::string_view name) {
  const auto plain = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  return !name.empty() && !std::isdigit(static_cast<unsigned char>(name[0])) &&
         std::all_of(name.begin(), name.end(), plain);
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

// Replaces every @KEY@.
std::string filled(std::string text, const std::vector<std::pair<std::string, std::string>>& words) {
  for (const auto& [key, word] : words) {
    const std::string mark = "@" + key + "@";
    for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + word.size())) {
      text.replace(at, mark.size(), word);
    }
  }
  return text;
}

constexpr const char* kSwitch = R"(  word = next_random(lamp) >> 16;
  for (k = 0; k < @LASTMODE@ && word >= LAMP_16(&thresholds[lamp->mode][k]); ++k) continue;
  lamp->mode = k;
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

Result<FirmwareSource> firmware_source(const Model& model, std::string_view name) {
  if (!is_name(name)) return Error{"\"" + std::string(name) + "\" is no name in C; call the file after one"};
  if (auto ok = wisp::check(model); !ok) return ok.error();
  const auto lamp = lamp_of(model);
  if (!lamp) return lamp.error();
  if (auto ok = check(*lamp); !ok) return ok.error();
  const Output& output = model.outputs[0];
  const double margin = kRangeMargin * (output.highest - output.lowest), one = 1 << kOneBits;
  const double below = output.lowest - margin, highest = output.highest + margin;
  const double lowest = output.lowest >= 0 ? std::max(0.0, below) : below;  // light is never negative
  const double reach = std::max({highest - lamp->mean, lamp->mean - lowest, 1e-6});
  const int exponent = static_cast<int>(std::ceil(std::log2(reach)));
  // The shown range then fits into 16 bits.
  if (exponent > 2 || exponent < -8 || std::abs(lamp->mean) > 3.9) {
    return Error{"the output is about " + std::to_string(lamp->mean) + " and moves by " + std::to_string(reach) +
                 ", expected at most 3.9 and 0.004 to 4; learn it with mean 1"};
  }
  const double sum_one = std::ldexp(1, kSumBits - exponent);
  const std::size_t modes = lamp->feedback.size();
  const auto constant = [&](std::size_t mode, std::size_t column) {
    return column == 0 ? lamp->constant[mode] * sum_one : lamp->shock[mode] * sum_one / kBytesSd * 16;
  };
  const auto weight = [&](std::size_t mode, std::size_t k) {
    return k < lamp->feedback[mode].size() ? std::ldexp(lamp->feedback[mode][k], kWeightBits) : 0;
  };
  std::string upper(name);
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  std::string called = model.name;
  std::erase_if(called,
                [](char c) { return c == '*' || c == '/' || c == '"' || static_cast<unsigned char>(c) < 0x20; });
  const std::vector<std::pair<std::string, std::string>> words = {
      {"SWITCH", modes > 1 ? kSwitch : ""},
      {"THRESHOLDS", modes > 1 ? thresholds(*lamp) : ""},
      {"CONSTANTS", table("int32_t", "constants", modes, 2, constant)},
      {"WEIGHTS", table("int32_t", "weights", modes, lamp->lags, weight)},
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
      {"MODEL", called},
      {"NAME", std::string(name)}};
  FirmwareSource out{filled(exporting::lamp_header, words), filled(exporting::lamp_source, words), 0};
  out.state_bytes = 4 * lamp->lags + 4 + 1;
  return out;
}

}  // namespace wisp
