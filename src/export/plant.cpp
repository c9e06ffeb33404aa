// Source: L. Ljung, System Identification (2nd ed.), section 4.2 and appendix 4A: an ARX model as a difference equation
// and as a state space in observer form, where every output has as many states as its row has lags.

#include <algorithm>
#include <charconv>

#include "base/json_text.hpp"
#include "export/templates.hpp"
#include "wisp/export/export.hpp"

namespace wisp {
namespace {

using PlantRows = std::vector<std::vector<double>>;
using Words = std::vector<std::pair<std::string, std::string>>;

std::size_t largest_lag(const ArxOrders& orders, int i) {
  int most = 0;
  for (int j = 0; j < orders.outputs(); ++j) most = std::max(most, orders.na(i, j));
  for (int k = 0; k < orders.inputs(); ++k) {
    if (orders.nb(i, k) > 0) most = std::max(most, orders.nk(i, k) + orders.nb(i, k) - 1);
  }
  return static_cast<std::size_t>(most);
}

// Return the coefficients at lags 0, 1, 2, … (at least `size`) of output j or input k in row i of A(q) y = B(q) u.
std::vector<double> lags_of_output(const ArxModel& arx, int i, int j, std::size_t size) {
  std::vector<double> lags{i == j ? 1.0 : 0.0};
  lags.insert(lags.end(), arx.a(i, j).begin(), arx.a(i, j).end());
  lags.resize(std::max(size, lags.size()));
  return lags;
}

std::vector<double> lags_of_input(const ArxModel& arx, int i, int k, std::size_t size) {
  std::vector<double> lags(arx.orders.nb(i, k) > 0 ? static_cast<std::size_t>(arx.orders.nk(i, k)) : 0, 0.0);
  lags.insert(lags.end(), arx.b(i, k).begin(), arx.b(i, k).end());
  lags.resize(std::max(size, lags.size()));
  return lags;
}

// x(t+1) = A x(t) + B u(t), y(t) = C x(t) + D u(t).
struct StateSpace {
  PlantRows a, b, c, d;
};

StateSpace state_space_of(const ArxModel& arx) {
  const auto ny = static_cast<std::size_t>(arx.orders.outputs()), nu = static_cast<std::size_t>(arx.orders.inputs());
  std::vector<std::size_t> first{0};
  for (std::size_t i = 0; i < ny; ++i) first.push_back(first[i] + largest_lag(arx.orders, static_cast<int>(i)));
  const std::size_t n = first[ny];
  const auto zeros = [](std::size_t rows, std::size_t columns) {
    return PlantRows(rows, std::vector<double>(columns));
  };
  StateSpace s{zeros(n, n), zeros(n, nu), zeros(ny, n), zeros(ny, nu)};
  const auto has_states = [&](std::size_t i) { return first[i + 1] > first[i]; };
  for (std::size_t i = 0; i < ny; ++i) {
    if (has_states(i)) s.c[i][first[i]] = 1;
    for (std::size_t k = 0; k < nu; ++k) s.d[i][k] = lags_of_input(arx, static_cast<int>(i), static_cast<int>(k), 1)[0];
  }
  for (std::size_t i = 0; i < ny; ++i) {
    const std::size_t lags = first[i + 1] - first[i];
    for (std::size_t l = 1; l <= lags; ++l) {
      const std::size_t row = first[i] + l - 1;
      if (l < lags) s.a[row][row + 1] = 1;
      for (std::size_t k = 0; k < nu; ++k) {
        s.b[row][k] = lags_of_input(arx, static_cast<int>(i), static_cast<int>(k), lags + 1)[l];
      }
      for (std::size_t j = 0; j < ny; ++j) {
        const double weight = -lags_of_output(arx, static_cast<int>(i), static_cast<int>(j), lags + 1)[l];
        if (has_states(j)) s.a[row][first[j]] += weight;
        for (std::size_t k = 0; k < nu; ++k) s.b[row][k] += weight * s.d[j][k];
      }
    }
  }
  return s;
}

std::string text_of(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

std::string list_of(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + text_of(value);
  return text;
}

std::string matrix_of(const PlantRows& rows, bool python) {
  std::string text;
  for (const auto& row : rows) {
    text += text.empty() ? "" : python ? ", " : "; ";
    text += python ? "[" + list_of(row) + "]" : list_of(row);
  }
  return text;
}

template <class Channels>
std::string names_of(const Channels& channels) {
  std::string text;
  for (const auto& one : channels) {
    text += (text.empty() ? "" : ", ") + one.name + (one.unit.empty() ? "" : " [" + one.unit + "]");
  }
  return exporting::comment_text(text);
}

// Returns the values of the placeholders that the templates of all languages have.
Words common_words(const Model& model, const ArxModel& arx) {
  const Usable& use = model.training.usable;
  return {{"MODEL", exporting::comment_text(model.name)},
          {"USE", use.verdict ? "" : exporting::comment_text(" (not usable: " + use.reason + ")")},
          {"INPUTS", names_of(model.inputs)},
          {"OUTPUTS", names_of(model.outputs)},
          {"RATE", text_of(model.rate_hz)},
          {"U0", list_of(arx.input_mean)},
          {"Y0", list_of(arx.output_mean)},
          {"CONSTANT", list_of(arx.constant)},
          {"NY", std::to_string(model.outputs.size())},
          {"NU", std::to_string(model.inputs.size())}};
}

constexpr const char* kOctaveTransfer = R"(
% G{k}: discrete transfer function from input k. Gc{k}, followed by a dead time of dead(k) seconds, is the continuous
% transfer function with the same samples under a zero-order hold.
num = {@NUMERATORS@};
den = {@DENOMINATORS@};
lead = [@LEADS@];  % samples of dead time
dead = lead * Ts;
G = cell(1, @NU@);
Gc = cell(1, @NU@);
for k = 1:@NU@
  G{k} = tf(num{k}, den{k}, Ts);
  without = den{k}(1:end - lead(k));
  p = roots(without);
  if isscalar(without), Gc{k} = tf(num{k}, 1); continue, end  % a gain; Octave's d2c() takes none
  if any(real(p) <= 1e-9 & abs(imag(p)) < 1e-9)
    warning('wisp:continuous', 'input %d: a pole at 0 or left of it; Gc{%d} is empty: no continuous system with a zero-order hold has these samples', k, k);
    continue
  end
  if any(abs(p) < 1e-3)
    warning('wisp:continuous', 'input %d: a pole near 0, far faster than the samples; Gc{%d} is uncertain', k, k);
  end
  Gc{k} = d2c(tf(num{k}(1 + lead(k):end), without, Ts), 'zoh');
end)";

constexpr const char* kPythonTransfer = R"(
# Per input: numerator and denominator in falling powers of z, and the dead time in samples.
transfer = [
@PAIRS@]


def continuous_transfer(k):
    """continuous() of the transfer function from input k without its dead time, and the dead time in seconds."""
    lead = transfer[k][2]
    num, den = np.array(transfer[k][0][lead:]), np.array(transfer[k][1][: len(transfer[k][1]) - lead])
    a = np.eye(len(den) - 1, k=1)
    a[:, :1] = -den[1:, None]  # of a gain: no rows
    b = (num - num[0] * den)[1:, None]
    return continuous(a, b, np.eye(1, len(a)), np.array([num[:1]])), lead * Ts

)";

// Returns the transfer functions of the only output. All polynomials of one input have equal degrees.
std::string transfers_of(const ArxModel& arx, bool python) {
  std::string numerators, denominators, leads, pairs;
  for (int k = 0; k < arx.orders.inputs(); ++k) {
    const auto a = static_cast<std::size_t>(arx.orders.na(0, 0));
    const int nb = arx.orders.nb(0, k), nk = arx.orders.nk(0, k);
    const std::size_t size = 1 + std::max(a, nb > 0 ? static_cast<std::size_t>(nk + nb - 1) : 0);
    const std::string num = "[" + list_of(lags_of_input(arx, 0, k, size)) + "]";
    const std::string den = "[" + list_of(lags_of_output(arx, 0, 0, size)) + "]";
    // The zero-order hold contributes one sample of nk.
    const std::string lead = std::to_string(std::min(size - 1 - a, static_cast<std::size_t>(std::max(0, nk - 1))));
    numerators += (k > 0 ? ", " : "") + num;
    denominators += (k > 0 ? ", " : "") + den;
    leads += (k > 0 ? ", " : "") + lead;
    pairs += "    (" + num + ", " + den + ", " + lead + "),\n";
  }
  return exporting::filled(python ? kPythonTransfer : kOctaveTransfer, {{"NUMERATORS", numerators},
                                                                        {"DENOMINATORS", denominators},
                                                                        {"LEADS", leads},
                                                                        {"PAIRS", pairs},
                                                                        {"NU", std::to_string(arx.orders.inputs())}});
}

std::string script_text(const Model& model, const ArxModel& arx, bool python) {
  const StateSpace s = state_space_of(arx);
  Words words = common_words(model, arx);
  const bool single = model.outputs.size() == 1;
  const std::string many =
      python ? "" : "G = tf(sys);  % all pairs; continuous: d2c(sys, 'zoh'), if no pole is zero or negative real";
  words.insert(words.end(), {{"A", matrix_of(s.a, python)},
                             {"B", matrix_of(s.b, python)},
                             {"C", matrix_of(s.c, python)},
                             {"D", matrix_of(s.d, python)},
                             {"STATES", std::to_string(s.a.size())},
                             {"TRANSFER", single ? transfers_of(arx, python) : many}});
  return exporting::filled(python ? exporting::plant_py : exporting::plant_m, words);
}

void add_rows(std::string_view key, const PlantRows& rows, JsonText& json) {
  json.list(key);
  for (const auto& row : rows) json.values(row);
  json.end();
}

// Returns A and B as lists of polynomials in rising powers of 1/z: A[i][j] begins with 1 or 0, B[i][k] with nk zeros.
std::string json_text(const Model& model, const ArxModel& arx) {
  JsonText json;
  json.object().value(model.name, "name").value(model.rate_hz, "rate_hz");
  if (!model.training.usable.verdict) json.value(model.training.usable.reason, "not_usable");
  json.list("inputs");
  for (const Input& input : model.inputs) json.value(input.name, {});
  json.end().list("outputs");
  for (const Output& output : model.outputs) json.value(output.name, {});
  json.end().values(arx.input_mean, "u0").values(arx.output_mean, "y0").values(arx.constant, "c");
  json.values(arx.noise.sd, "noise_sd");
  for (const bool of_a : {true, false}) {
    json.list(of_a ? "A" : "B");
    for (int i = 0; i < arx.orders.outputs(); ++i) {
      PlantRows row;
      for (int j = 0; j < (of_a ? arx.orders.outputs() : arx.orders.inputs()); ++j) {
        row.push_back(of_a ? lags_of_output(arx, i, j, 1) : lags_of_input(arx, i, j, 1));
      }
      add_rows({}, row, json);
    }
    json.end();
  }
  const StateSpace s = state_space_of(arx);
  json.object("state_space");
  for (const auto& [key, rows] : {std::pair("A", &s.a), {"B", &s.b}, {"C", &s.c}, {"D", &s.d}}) {
    add_rows(key, *rows, json);
  }
  return json.end().end().text() + "\n";
}

// Returns every output as a C expression on the deviations that plant.h.in declares.
std::string c_equations(const ArxModel& arx) {
  std::string out;
  const auto add = [&](double weight, const char* channel, int index, std::size_t lag) {
    out += "\n      + " + text_of(weight) + " * state->" + channel + "[" + std::to_string(index) + "][" +
           std::to_string(lag) + "]";
  };
  for (int i = 0; i < arx.orders.outputs(); ++i) {
    out += "  now[" + std::to_string(i) + "] = " + text_of(arx.constant[static_cast<std::size_t>(i)]);
    for (int j = 0; j < arx.orders.outputs(); ++j) {
      for (std::size_t l = 0; l < arx.a(i, j).size(); ++l) add(-arx.a(i, j)[l], "y", j, l);
    }
    for (int k = 0; k < arx.orders.inputs(); ++k) {
      const auto nk = static_cast<std::size_t>(arx.orders.nk(i, k));
      for (std::size_t l = 0; l < arx.b(i, k).size(); ++l) add(arx.b(i, k)[l], "u", k, nk + l);
    }
    out += ";\n";
  }
  return out;
}

Words c_words(const Model& model, const ArxModel& arx, std::string_view name) {
  std::size_t outputs = 1, inputs = 1;
  for (const int order : arx.orders.na.values()) outputs = std::max(outputs, static_cast<std::size_t>(order));
  for (int i = 0; i < arx.orders.outputs(); ++i) inputs = std::max(inputs, largest_lag(arx.orders, i) + 1);
  Words words = common_words(model, arx);
  std::string upper(name);
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  words.insert(words.end(), {{"YLAGS", std::to_string(outputs)},
                             {"ULAGS", std::to_string(inputs)},
                             {"EQUATIONS", c_equations(arx)},
                             {"GUARD", upper + "_H"},
                             {"UPPER", upper},
                             {"NAME", std::string(name)}});
  return words;
}

}  // namespace

Result<PlantText> plant_text(const Model& model, PlantLanguage language, std::string_view name) {
  const auto* arx = std::get_if<ArxModel>(&model.dynamics);
  if (!arx || !std::holds_alternative<PlainView>(model.view) || model.inputs.empty()) {
    return Error{"the model is no plant: expected an ARX model with inputs, as wisp learn arx makes them"};
  }
  for (const Input& input : model.inputs) {
    if (input.shape != InputShape::kLinear) return Error{"input '" + input.name + "' does not enter linearly"};
  }
  if (language == PlantLanguage::kJson) return PlantText{json_text(model, *arx), ""};
  if (language != PlantLanguage::kC) return PlantText{script_text(model, *arx, language == PlantLanguage::kPython), ""};
  if (!exporting::is_name(name)) return Error{"\"" + std::string(name) + "\" is no name in C; call the file after one"};
  const Words words = c_words(model, *arx, name);
  return PlantText{exporting::filled(exporting::plant_c, words), exporting::filled(exporting::plant_h, words)};
}

}  // namespace wisp
