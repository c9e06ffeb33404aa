// A plant as other tools read it: their poles, gains and responses beside the difference equation, stepped here.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "folder_test.hpp"
#include "wisp/export/export.hpp"
#include "wisp/run/bank.hpp"

namespace wisp::plant_test {
namespace {

using testing::HasSubstr;

Model plant(int outputs, std::vector<int> na, std::vector<int> nb, std::vector<int> nk,
            std::vector<std::vector<double>> theta) {
  const int inputs = static_cast<int>(nb.size()) / outputs;
  ArxModel arx{.orders = {OrderMatrix(outputs, outputs), OrderMatrix(outputs, inputs), OrderMatrix(outputs, inputs)}};
  for (int i = 0; i < outputs; ++i) {
    for (int j = 0; j < outputs; ++j) arx.orders.na(i, j) = na[static_cast<std::size_t>(i * outputs + j)];
    for (int k = 0; k < inputs; ++k) {
      arx.orders.nb(i, k) = nb[static_cast<std::size_t>(i * inputs + k)];
      arx.orders.nk(i, k) = nk[static_cast<std::size_t>(i * inputs + k)];
    }
  }
  arx.theta = std::move(theta);
  arx.constant.assign(static_cast<std::size_t>(outputs), 0);
  arx.output_mean.assign(static_cast<std::size_t>(outputs), 5);
  arx.input_mean.assign(static_cast<std::size_t>(inputs), 2);
  arx.noise.sd.assign(static_cast<std::size_t>(outputs), 0.1);
  Model model{.name = "a plant", .rate_hz = 12.5};
  for (int k = 0; k < inputs; ++k) model.inputs.push_back({"u" + std::to_string(k), "V", -10, 10});
  for (int i = 0; i < outputs; ++i) model.outputs.push_back({"y" + std::to_string(i), "", -50, 50});
  model.dynamics = std::move(arx);
  return model;
}

// Poles 0.9 and 0.5 ± 0.3i; one input with a dead time of three samples, one that acts at once.
Model single() { return plant(1, {3}, {3, 2}, {4, 0}, {{-1.9, 1.24, -0.306, 0.5, 0.25, 0.125, 1.0, -0.75}}); }

// Two outputs that feed each other; nothing acts at once.
Model coupled() {
  return plant(2, {1, 1, 0, 2}, {1, 1, 1, 0}, {1, 2, 1, 0}, {{-0.8, 0.2, 1.0, 0.5}, {-0.9, 0.2, 0.75}});
}

double input_at(int t, int k) { return k == 0 ? (t % 17 < 8 ? 4.0 : -1.0) : std::sin(0.3 * t) + 2; }

// The model's difference equation as its header in include/wisp/model has it.
std::vector<std::vector<double>> stepped(const Model& model, int rows) {
  const auto& arx = std::get<ArxModel>(model.dynamics);
  std::vector<std::vector<double>> y;
  for (int t = 0; t < rows; ++t) {
    auto& now = y.emplace_back();
    for (int i = 0; i < arx.orders.outputs(); ++i) {
      double sum = 0;
      for (int j = 0; j < arx.orders.outputs(); ++j) {
        for (int l = 1; l <= std::min(t, arx.orders.na(i, j)); ++l) {
          sum -= arx.a(i, j)[static_cast<std::size_t>(l - 1)] *
                 y[static_cast<std::size_t>(t - l)][static_cast<std::size_t>(j)];
        }
      }
      for (int k = 0; k < arx.orders.inputs(); ++k) {
        for (int l = 0; l < arx.orders.nb(i, k); ++l) {
          const int lag = arx.orders.nk(i, k) + l;
          if (lag <= t) sum += arx.b(i, k)[static_cast<std::size_t>(l)] * (input_at(t - lag, k) - 2);
        }
      }
      now.push_back(sum);
    }
  }
  return y;
}

class Plant : public FolderTest {
 protected:
  static constexpr int kRows = 200;

  void write(const Model& model, PlantLanguage language, const std::string& file) const {
    const auto text = plant_text(model, language, "plant");
    ASSERT_TRUE(text) << text.error().message;
    std::ofstream(folder_ / file) << text->text;
    if (!text->header.empty()) std::ofstream(folder_ / "plant.h") << text->header;
    std::ofstream input(folder_ / "u"), output(folder_ / "y");
    input.precision(17), output.precision(17);
    const auto y = stepped(model, kRows);
    for (int t = 0; t < kRows; ++t) {
      for (std::size_t k = 0; k < model.inputs.size(); ++k) input << input_at(t, static_cast<int>(k)) - 2 << ' ';
      for (const double value : y[static_cast<std::size_t>(t)]) output << value << ' ';
      input << '\n', output << '\n';
    }
  }

  std::string said(const std::string& command) const {
    const std::string line = "cd '" + folder_.string() + "' && (" + command + ") 2>&1";
    std::FILE* pipe = ::popen(line.c_str(), "r");
    std::string text;
    std::array<char, 4096> part{};
    while (const std::size_t got = std::fread(part.data(), 1, part.size(), pipe)) text.append(part.data(), got);
    ::pclose(pipe);
    return text;
  }

  // Octave 7 with a package loaded complains of itself as it ends.
  std::string octave_said(const std::string& arguments) const {
    return said("octave-cli --norc --quiet " + arguments + " 2>&1 | grep -v 'ignoring const execution_exception'");
  }

  // What Octave prints after the plant's script and these lines.
  std::string octave(const std::string& lines) const {
    std::ofstream(folder_ / "judge.m") << "plant\nu = load('-ascii', 'u'); y = load('-ascii', 'y');\n"
                                       << "near = @(a, b) max(abs(a(:) - b(:))) <= 1e-9;\n"
                                       << lines;
    return octave_said("judge.m");
  }

  // What SciPy prints; `near` and `responses` are there.
  std::string python(const std::string& lines) const {
    std::ofstream(folder_ / "judge.py")
        << "from plant import *\nu, y = np.loadtxt('u', ndmin=2), np.loadtxt('y', ndmin=2)\n"
        << "near = lambda a, b: print(bool(np.max(np.abs(a - b)) <= 1e-9))\n"
        << lines;
    return said("/usr/bin/python3 judge.py");
  }
  bool has_octave() const { return octave_said("--eval 'pkg load control; disp(7)'") == "7\n"; }
  bool has_scipy() const { return said("/usr/bin/python3 -c 'import scipy.signal; print(7)'") == "7\n"; }
};

TEST_F(Plant, OctaveFindsItsPolesGainsAndResponses) {
  if (!has_octave())
    GTEST_SKIP() << "no Octave with its control package: script/bootstrap --verify installs them, 100 MB that a build "
                    "does not need";
  write(single(), PlantLanguage::kOctave, "plant.m");
  const std::string text = octave(
      "disp(near(lsim(sys, u), y))\n"
      "disp(near(lsim(G{1}, u(:, 1)) + lsim(G{2}, u(:, 2)), y))\n"
      "p = sort(pole(G{2})); disp(near(sort(abs(p)), sort(abs([0.9; 0.5 + 0.3i; 0.5 - 0.3i]))))\n"
      "disp(near(dcgain(sys), [0.875 / 0.034, 0.25 / 0.034]))\n"
      "t = (0:100)' * Ts; g = step(G{1}, t); c = step(Gc{1}, t); n = lead(1);\n"
      "disp([n, near(g(1 + n:end), c(1:end - n))])\n"
      "disp(near(sort(real(exp(pole(Gc{2}) * Ts))), [0.5; 0.5; 0.9]))\n");
  EXPECT_EQ(text, "1\n1\n1\n1\n   3   1\n1\n");
}

TEST_F(Plant, OctaveStepsCoupledOutputs) {
  if (!has_octave())
    GTEST_SKIP() << "no Octave with its control package: script/bootstrap --verify installs them, 100 MB that a build "
                    "does not need";
  write(coupled(), PlantLanguage::kOctave, "plant.m");
  EXPECT_EQ(octave("disp(near(lsim(sys, u), y))\ndisp(near(lsim(ss(G), u), y))\n"), "1\n1\n");
}

TEST_F(Plant, SciPyFindsItsPolesGainsAndResponses) {
  if (!has_scipy()) GTEST_SKIP() << "no SciPy: script/bootstrap --verify installs it, which a build does not need";
  write(single(), PlantLanguage::kPython, "plant.py");
  const std::string text = python(
      "near(signal.dlsim(system, u)[1], y)\n"
      "near(sum(signal.lfilter(n, d, u[:, [k]], axis=0) for k, (n, d, _) in enumerate(transfer)), y)\n"
      "near(np.sort_complex(np.roots(transfer[1][1])), [0.5 - 0.3j, 0.5 + 0.3j, 0.9])\n"
      "near(C @ np.linalg.inv(np.eye(len(A)) - A) @ B + D, [[0.875 / 0.034, 0.25 / 0.034]])\n"
      "system_c, dead = continuous_transfer(0)\n"
      "near(dead, 3 * Ts)\n"
      "again = signal.cont2discrete((system_c.A, system_c.B, system_c.C, system_c.D), Ts)\n"
      "near(signal.dlsim(signal.dlti(*again[:4], dt=Ts), np.r_[np.zeros(3), np.ones(97)])[1],\n"
      "     signal.lfilter(*transfer[0][:2], np.ones(100))[:, None])\n"
      "near(np.sort(np.exp(np.linalg.eigvals(system_c.A) * Ts).real), [0.5, 0.5, 0.9])\n");
  EXPECT_EQ(text, "True\nTrue\nTrue\nTrue\nTrue\nTrue\nTrue\n");
  write(coupled(), PlantLanguage::kPython, "plant.py");
  EXPECT_EQ(python("near(signal.dlsim(system, u)[1], y)\n"), "True\n");
}

TEST_F(Plant, APoleAtOrLeftOfZeroHasNoContinuousSystemAndIsWarnedOf) {
  const Model alternating = plant(1, {2}, {1}, {1}, {{-0.4, -0.45, 1.0}});  // 0.9 and −0.5
  if (has_octave()) {
    write(alternating, PlantLanguage::kOctave, "plant.m");
    const std::string text = octave("disp(isempty(Gc{1}))\n");
    EXPECT_THAT(text, HasSubstr("no continuous system with a zero-order hold"));
    EXPECT_TRUE(text.ends_with("\n1\n")) << text;
  }
  if (has_scipy()) {
    write(alternating, PlantLanguage::kPython, "plant.py");
    const std::string text = python("print(continuous_transfer(0)[0])\n");
    EXPECT_THAT(text, HasSubstr("no continuous system with a zero-order hold"));
    EXPECT_TRUE(text.ends_with("\nNone\n")) << text;
  }
  // An integrator has one.
  write(plant(1, {1}, {1}, {1}, {{-1.0, 0.1}}), PlantLanguage::kPython, "plant.py");
  if (has_scipy()) {
    EXPECT_EQ(python("s = continuous_transfer(0)[0]\nnear(s.A, 0)\nnear(s.C @ s.B, 0.1 / Ts)\n"), "True\nTrue\n");
  }
}

TEST_F(Plant, AGainIsItsOwnContinuousSystem) {
  const Model gains = plant(1, {0}, {1, 1}, {0, 2}, {{2.0, 3.0}});  // the first input acts at once, and only then
  if (has_octave()) {
    write(gains, PlantLanguage::kOctave, "plant.m");
    EXPECT_TRUE(octave("disp(dcgain(Gc{1}))\n").ends_with("2\n"));
  }
  if (has_scipy()) {
    write(gains, PlantLanguage::kPython, "plant.py");
    EXPECT_EQ(python("s, dead = continuous_transfer(0)\nnear(s.D, 2)\nnear(dead, 0)\n"), "True\nTrue\n");
  }
}

TEST_F(Plant, CompiledItPlaysWhatABankPlays) {
  for (const Model& model : {single(), coupled()}) {
    write(model, PlantLanguage::kC, "plant.c");
    const std::string ny = std::to_string(model.outputs.size()), nu = std::to_string(model.inputs.size());
    std::ofstream(folder_ / "main.c") << "#include <stdio.h>\n#include \"plant.h\"\n"
                                         "int main(void) { plant_state state = {{{0}}, {{0}}}; double u[" +
                                             nu + "], y[" + ny + "]; int k;\nfor (;;) {\n for (k = 0; k < " + nu +
                                             "; ++k) { if (scanf(\"%lf\", &u[k]) != 1) return 0; u[k] += 2; }\n"
                                             " plant_step(&state, u, y);\n for (k = 0; k < " +
                                             ny + "; ++k) printf(\"%.17g\\n\", y[k]); } }\n";
    ASSERT_EQ(said("cc -std=c99 -Wall -Wextra -Werror -Wconversion -pedantic plant.c main.c -o play"), "");
    std::istringstream played(said("./play <u"));
    const auto exact = stepped(model, kRows);
    auto bank = Bank::create(model, {});
    bank->set_noise(0);
    const InstanceId id = bank->spawn();
    std::vector<float> u(model.inputs.size()), y(model.outputs.size());
    for (int t = 0; t < kRows; ++t) {
      for (std::size_t k = 0; k < u.size(); ++k) u[k] = static_cast<float>(input_at(t, static_cast<int>(k)));
      bank->set_inputs(id, u);
      bank->step();
      bank->outputs(id, y);
      for (std::size_t i = 0; i < y.size(); ++i) {
        double value = 0;
        ASSERT_TRUE(played >> value);
        EXPECT_NEAR(value, exact[static_cast<std::size_t>(t)][i] + 5, 1e-12);
        // A bank rounds to 6e-8 in each step: terms of 130 together, over a gain of noise of 29.
        EXPECT_NEAR(value, y[i], 130 * 6e-8 * 29);
      }
    }
  }
}

TEST_F(Plant, JsonHasItsPolynomialsAndStateSpace) {
  const auto json = nlohmann::json::parse(plant_text(single(), PlantLanguage::kJson, "")->text);
  EXPECT_EQ(json["A"][0][0], (std::vector<double>{1, -1.9, 1.24, -0.306}));
  EXPECT_EQ(json["B"][0][0], (std::vector<double>{0, 0, 0, 0, 0.5, 0.25, 0.125}));
  EXPECT_EQ(json["y0"], (std::vector<double>{5}));
  EXPECT_EQ(json["rate_hz"], 12.5);
  // x(t+1) = A x + B u, y = C x + D u.
  const auto& space = json["state_space"];
  const std::size_t states = space["A"].size();
  std::vector<double> x(states);
  const auto exact = stepped(single(), kRows);
  for (int t = 0; t < kRows; ++t) {
    double y = 0;
    std::vector<double> next(states);
    for (int k = 0; k < 2; ++k) y += space["D"][0][k].get<double>() * (input_at(t, k) - 2);
    for (std::size_t r = 0; r < states; ++r) {
      y += space["C"][0][r].get<double>() * x[r];
      for (std::size_t s = 0; s < states; ++s) next[r] += space["A"][r][s].get<double>() * x[s];
      for (int k = 0; k < 2; ++k) next[r] += space["B"][r][k].get<double>() * (input_at(t, k) - 2);
    }
    EXPECT_NEAR(y, exact[static_cast<std::size_t>(t)][0], 1e-9);
    x = next;
  }
}

TEST_F(Plant, AModelThatIsNotUsableSaysSoInItsFile) {
  Model model = single();
  for (const bool usable : {false, true}) {
    model.training.usable = {usable, "it drifts */"};
    for (const PlantLanguage language : {PlantLanguage::kOctave, PlantLanguage::kPython, PlantLanguage::kC}) {
      EXPECT_EQ(plant_text(model, language, "plant")->text.find("(not usable: it drifts ") == std::string::npos,
                usable);
    }
    const auto json = nlohmann::json::parse(plant_text(model, PlantLanguage::kJson, "")->text);
    EXPECT_EQ(json.contains("not_usable"), !usable);
  }
}

TEST_F(Plant, UnitsAreWholeInComments) {
  Model model = single();
  model.inputs[0].unit = "m/s";
  model.outputs[0].unit = "*/ W/m\n";
  for (const PlantLanguage language : {PlantLanguage::kOctave, PlantLanguage::kPython}) {
    EXPECT_THAT(plant_text(model, language, "plant")->text, HasSubstr("u0 [m/s], u1 [V]. Outputs: y0 [/ W/m].\n"));
  }
  EXPECT_THAT(plant_text(model, PlantLanguage::kC, "plant")->header,
              HasSubstr("u0 [m/s], u1 [V]. Outputs: y0 [/ W/m]."));
}

TEST_F(Plant, AnotherModelIsRefused) {
  Model lamp = single();
  lamp.inputs.clear();
  EXPECT_THAT(plant_text(lamp, PlantLanguage::kOctave, "a").error().message, HasSubstr("no plant"));
  EXPECT_THAT(plant_text(single(), PlantLanguage::kC, "1a").error().message, HasSubstr("no name in C"));
}

}  // namespace
}  // namespace wisp::plant_test
