// `wisp info --json`: all that a model's file holds. What is written again from it alone is the same file.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/program.hpp"
#include "model/sample_chain.hpp"
#include "run/flame_model.hpp"
#include "wisp/model/file.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::info_test {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;
namespace fs = std::filesystem;

template <class T>
void put(const Json& from, T& to) {
  if (!from.is_null()) to = from.get<T>();
}

// A list of lists as one.
template <class T>
std::vector<T> flat(const Json& rows) {
  std::vector<T> all;
  for (const Json& row : rows) {
    for (const Json& value : row) all.push_back(value.get<T>());
  }
  return all;
}

OrderMatrix orders_of(const Json& rows, int columns) {
  OrderMatrix orders(static_cast<int>(rows.size()), columns);
  for (int i = 0; i < orders.rows(); ++i) {
    for (int j = 0; j < columns; ++j) orders(i, j) = rows[i][j];
  }
  return orders;
}

ArxOrders orders_of(const Json& json) {
  const auto outputs = static_cast<int>(json["na"].size()), inputs = static_cast<int>(json["nb"][0].size());
  return {orders_of(json["na"], outputs), orders_of(json["nb"], inputs), orders_of(json["nk"], inputs)};
}

// Row i: all lags of A, then of B.
std::vector<std::vector<double>> theta_of(const Json& json) {
  std::vector<std::vector<double>> theta;
  if (json.is_null()) return theta;
  for (std::size_t i = 0; i < json["A"].size(); ++i) {
    theta.push_back(flat<double>(json["A"][i]));
    const auto b = flat<double>(json["B"][i]);
    theta.back().insert(theta.back().end(), b.begin(), b.end());
  }
  return theta;
}

ResampledResiduals resampled_of(const Json& json) {
  ResampledResiduals resampled;
  if (json.is_null()) return resampled;
  resampled.rows = flat<std::int8_t>(json["rows"]);
  put(json["scale"], resampled.scale);
  put(json["ends"], resampled.ends);
  put(json["wind_scale"], resampled.wind_scale);
  put(json["winds"], resampled.winds);
  put(json["toward"], resampled.toward);
  put(json["lags"], resampled.lags);
  put(json["tolerance"], resampled.tolerance);
  put(json["margin"], resampled.margin);
  put(json["longest"], resampled.longest);
  put(json["mirror"], resampled.mirror);
  return resampled;
}

ArxModel arx_of(const Json& json) {
  ArxModel arx{.orders = orders_of(json), .theta = theta_of(json)};
  if (json.contains("std_error")) arx.std_error = theta_of(json["std_error"]);
  put(json["constant"], arx.constant);
  put(json["output_mean"], arx.output_mean);
  put(json["input_mean"], arx.input_mean);
  const Json& noise = json["noise"];
  put(noise["sd"], arx.noise.sd);
  put(noise["sd_ci95"], arx.noise.sd_ci95);
  arx.noise.resampled = resampled_of(noise["resampled"]);
  return arx;
}

SwitchedArxModel switched_of(const Json& json) {
  SwitchedArxModel model{.orders = orders_of(json)};
  put(json["output_mean"], model.output_mean);
  put(json["input_mean"], model.input_mean);
  for (const Json& from : json["modes"]) {
    ArxMode& mode = model.modes.emplace_back();
    mode.theta = theta_of(from);
    if (from.contains("std_error")) mode.std_error = theta_of(from["std_error"]);
    put(from["constant"], mode.constant);
    mode.shock = flat<double>(from["shock"]);
  }
  put(json["initial"], model.initial);
  model.transitions = flat<double>(json["transitions"]);
  return model;
}

GustResponse::Axis axis_of(const Json& json) { return {json["change"], json["wind"], json["press"]}; }

ChainDrift drift_of(const Json& json) {
  ChainDrift drift{.lead = flat<std::int16_t>(json["lead"])};
  put(json["lead_scale"], drift.lead_scale);
  put(json["drift"], drift.drift);
  put(json["spread_ground"], drift.spread_ground);
  put(json["spread_height"], drift.spread_height);
  put(json["memory_seconds"], drift.memory_seconds);
  return drift;
}

ChainModel chain_of(const Json& json) {
  ChainModel chain{.motion = json["motion"] == "pose" ? ChainMotion::kPose : ChainMotion::kPosition};
  put(json["heading_free"], chain.heading_free);
  put(json["modes"], chain.modes);
  put(json["segment_modes"], chain.segments.mode);
  put(json["segment_steps"], chain.segments.steps);
  chain.segments.rows = flat<std::int16_t>(json["rows"]);
  put(json["row_scale"], chain.segments.row_scale);
  chain.segments.rates = flat<std::int16_t>(json["rates"]);
  put(json["rate_scale"], chain.segments.rate_scale);
  chain.segments.follow = flat<std::uint16_t>(json["follow"]);
  put(json["best_of"], chain.segments.breadth);
  put(json["height"], chain.segments.height);
  put(json["height_scale"], chain.segments.height_scale);
  put(json["initial"], chain.initial);
  put(json["history"], chain.history);
  chain.probabilities = flat<double>(json["probabilities"]);
  put(json["blend_steps"], chain.blend_steps);
  const auto there = [&](const char* part) { return !json[part].is_null(); };
  if (there("gust")) chain.gust = {axis_of(json["gust"]["ground"]), axis_of(json["gust"]["vertical"])};
  if (there("drift")) chain.drift = drift_of(json["drift"]);
  return chain;
}

Dynamics dynamics_of(const Json& json) {
  if (json["kind"] == "arx") return arx_of(json);
  if (json["kind"] == "chain") return chain_of(json);
  return switched_of(json);
}

std::vector<ValueRange> ranges_of(const Json& json) {
  std::vector<ValueRange> ranges;
  for (const Json& range : json) ranges.push_back({range[0], range[1]});
  return ranges;
}

ShapeComponents shape_of(const Json& json) {
  if (json.is_null()) return {};
  return {json["symmetric"], json["antisymmetric"],          json["rest"],
          json["basis"],     ranges_of(json["coordinates"]), ranges_of(json["components"])};
}

View view_of(const Json& json) {
  if (json["kind"] == "outline") {
    return OutlineView{json["knots"], json["metres_per_unit"], json["pixels_per_unit"], shape_of(json["shape"])};
  }
  if (json["kind"] == "pose") return PoseView{json["half_width"], json["half_length"]};
  if (json["kind"] == "position") return PositionView{json["half_width"]};
  return PlainView{};
}

Input input_of(const Json& json) {
  static const std::map<std::string, InputShape> shapes = {{"linear", InputShape::kLinear},
                                                           {"even_odd", InputShape::kEvenOdd}};
  return {json["name"], json["unit"], json["range"][0], json["range"][1], shapes.at(json["form"])};
}

Origin origin_of(const Json& word) {
  return word == "learned" ? Origin::kLearned : word == "given" ? Origin::kGiven : Origin::kDefault;
}

Training training_of(const Json& json, const Json& usable) {
  Training made{.program = json["program"], .sources = json["sources"]};
  for (const Json& note : json["recipe"]) made.recipe.push_back({note["name"], note["value"]});
  for (const Json& figure : json["figures"]) made.figures.push_back({figure["name"], figure["value"]});
  made.usable = {usable["verdict"], usable["reason"]};
  for (const Json& input : json["inputs"]) made.inputs.push_back({input["scale"], input["one_rms"]});
  put(json["residual_sd"], made.residual_sd);
  if (!json["underside"].is_null()) made.underside = json["underside"].get<bool>();
  if (const Json& motion = json["motion"]; !motion.is_null()) {
    made.motion = {motion["event"], motion["min_seconds"], motion["debounce"], motion["smooth_rows"]};
  }
  if (const Json& rule = json["extinction"]; !rule.is_null()) {
    made.extinction = {origin_of(rule["origin"]), rule["deaths"], rule["died"], rule["gusts"], rule["spared"],
                       rule["vanishing_seconds"]};
  }
  put(json["multiply_adds_per_frame"], made.multiply_adds_per_frame);
  put(json["operations_per_frame"], made.operations_per_frame);
  return made;
}

Model model_of(const Json& json) {
  Model model{.name = json["name"], .rate_hz = json["rate_hz"]};
  for (const Json& input : json["inputs"]) model.inputs.push_back(input_of(input));
  for (const Json& output : json["outputs"]) {
    model.outputs.push_back({output["name"], output["unit"], output["range"][0], output["range"][1]});
  }
  model.dynamics = dynamics_of(json["dynamics"]);
  model.view = view_of(json["view"]);
  model.training = training_of(json["training"], json["usable"]);
  const Json& rule = json["extinction"];
  if (rule.is_null()) return model;
  model.extinction = Extinction{.level = rule["level"], .seconds = rule["seconds"], .haste = rule["haste"]};
  while (model.inputs.at(model.extinction->input).name != rule["input"]) ++model.extinction->input;
  put(rule["recovery"], model.extinction->recovery);
  for (const auto& [name, events] : std::initializer_list<std::pair<const char*, FlameEvents*>>{
           {"dying", &model.extinction->dying}, {"catching", &model.extinction->catching}}) {
    if (rule[name]["borrowed"] == false)
      *events = {rule[name]["sizes"], rule[name]["ends"], rule[name]["scale"], rule[name]["shapes"]};
  }
  return model;
}

class Info : public InFolder {
 protected:
  // Whether the model's bytes come again from what the program says of it.
  void expect_complete(const std::string& path) {
    const Said said = wisp("info " + path + " --json");
    ASSERT_EQ(said.status, 0) << said.err;
    const auto again = model_bytes(model_of(said.json()));
    ASSERT_TRUE(again) << path << ": " << again.error().message;
    const auto model = read_model(path);
    ASSERT_TRUE(model) << model.error().message;
    EXPECT_TRUE(*again == *model_bytes(*model)) << path;
  }
};

TEST_F(Info, AModelIsWrittenAgainFromItsJsonToTheByte) {
  for (const auto& file : fs::directory_iterator(WISP_SOURCE_DIR "/tests/model/golden")) expect_complete(file.path());
  for (const char* name : {"flame-2", "flame-6", "leaf"}) {
    expect_complete(std::string(WISP_SOURCE_DIR "/apps/web/public/models/") + name + ".wisp");
  }
  const FlameOptions mirrored{.points = 4, .wind = InputShape::kEvenOdd, .resampled_rows = 60};
  for (const Model& model : {bounded_chain(), steered_chain(), flame_model(mirrored)}) {
    ASSERT_TRUE(write_model(at("m.wisp"), model));
    expect_complete(at("m.wisp"));
  }
}

TEST_F(Info, FlagsOfARecordingAreRefusedForAModel) {
  for (const std::string& flag : {"-o " + at("plot.png"), std::string("--inputs z"), std::string("--rate 30")}) {
    const Said said = wisp("info " WISP_SOURCE_DIR "/tests/c/models/leaf.wisp " + flag);
    EXPECT_EQ(said.status, 2) << flag;
    EXPECT_THAT(said.err, HasSubstr("is of a recording, not of a model")) << flag;
  }
}

TEST_F(Info, ModelsAreLookedAtOneAtATime) {
  const std::string model = WISP_SOURCE_DIR "/tests/c/models/leaf.wisp";
  EXPECT_THAT(wisp("info " + model + " " + model).err, HasSubstr("leaf.wisp: is no table, expected recordings, or"));
}

// examples/08_play_json/play.py plays what `info` says; `run` plays the model.
class InfoPlayed : public Info {
 protected:
  void SetUp() override {
    if (std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0) GTEST_SKIP() << "no Python with numpy";
    Info::SetUp();
  }

  // Every output of every frame, in Python and by `run`.
  void expect_same_bits(const std::string& path, const std::string& noise, const std::string& wind = "-0.7") {
    expect_same_bits(path, noise, wind, "--frames 80 --wind " + wind);
  }

  // `wind` is what Python is told of it, `flags` is what `run` is told.
  void expect_same_bits(const std::string& path, const std::string& noise, const std::string& wind,
                        const std::string& flags) {
    const std::string asked = " --seed 3 --noise " + noise + " " + flags;
    ASSERT_EQ(wisp("run " + path + asked + " -o " + at("run.csv")).status, 0);
    ASSERT_EQ(wisp("info " + path + " --json").status, 0);
    const std::string python = "/usr/bin/python3 -B " WISP_SOURCE_DIR "/examples/08_play_json/play.py 80 " + wind +
                               " 3 " + noise + " <" + at("said.out") + " >" + at("play.csv");
    ASSERT_EQ(std::system(python.c_str()), 0) << path;
    const auto ran = read_csv(at("run.csv"));
    ASSERT_TRUE(ran) << ran.error().message;
    std::ifstream played(at("play.csv"));
    std::string line;
    std::getline(played, line);
    for (std::size_t row = 0; row < 80; ++row) {
      ASSERT_TRUE(std::getline(played, line)) << row;
      std::istringstream cells(line);
      for (const Channel& channel : ran->channels) {
        if (channel.role != Role::kOutput) continue;
        ASSERT_TRUE(std::getline(cells, line, ','));
        ASSERT_EQ(std::stod(line), channel.samples[row]) << path << ' ' << channel.name << " in frame " << row;
      }
    }
  }
};

TEST_F(InfoPlayed, GaussianAndSwitchedModelsInPythonAreRunsToTheBit) {
  const std::string golden = WISP_SOURCE_DIR "/tests/model/golden/";
  for (const char* name : {"v1.wisp", "v1_switched.wisp"}) {
    for (const char* noise : {"on", "off"}) expect_same_bits(golden + name, noise);
  }
}

TEST_F(InfoPlayed, PowersOfAnInputAndLargeRangesToo) {
  Model model = flame_model({.points = 4, .wind = InputShape::kEvenOdd});
  model.inputs[0].lowest = -300;
  model.inputs[0].highest = 300;
  ASSERT_TRUE(write_model(at("m.wisp"), model));
  for (const char* wind : {"-120", "3"}) expect_same_bits(at("m.wisp"), "on", wind);
}

TEST_F(InfoPlayed, ResampledResidualsJumpAsInRunWhileTheWindChanges) {
  ASSERT_TRUE(
      write_model(at("m.wisp"), flame_model({.points = 4, .wind = InputShape::kEvenOdd, .resampled_rows = 60})));
  std::ofstream table(at("wind.csv")), lines(at("wind.txt"));
  table << "# wisp-recording 1\n# rate_hz 30\nu:wind[m/s]\n";  // the golden model's unit: taken as it is
  for (int t = 0; t < 80; ++t) {
    const double wind = t % 40 < 15 ? 0 : std::sin(0.3 * t);
    table << wind << '\n';
    lines << wind << '\n';
  }
  table.close();
  lines.close();
  for (const std::string& path : {at("m.wisp"), std::string(WISP_SOURCE_DIR "/tests/model/golden/v1-resampled.wisp")}) {
    expect_same_bits(path, "off");
    expect_same_bits(path, "on");
    expect_same_bits(path, "on", at("wind.txt"), "--input " + at("wind.csv"));
  }
}

TEST_F(InfoPlayed, RowsThatNothingDrivesAreLookedUpAsInRun) {
  ASSERT_TRUE(write_model(at("m.wisp"), still_flame_model(90)));
  for (const char* noise : {"on", "off"}) expect_same_bits(at("m.wisp"), noise, "0", "--frames 80");
}

TEST_F(InfoPlayed, ChainsOfPosesAndTheirGusts) {
  const std::string golden = WISP_SOURCE_DIR "/tests/model/golden/";
  for (const char* noise : {"on", "off"}) expect_same_bits(golden + "v1_chain.wisp", noise, "0", "--frames 80");
  std::ofstream table(at("wind.csv")), lines(at("wind.txt"));
  table << "# wisp-recording 1\n# rate_hz 60\nu:wind.x,u:wind.y,u:wind.z\n";
  for (int t = 0; t < 80; ++t) {
    std::ostringstream row;
    row << (t % 50 > 20 ? std::sin(0.05 * t) : 0) << ',' << (t % 50 > 20 ? 0.4 : 0) << ",-0.1\n";
    table << row.str();
    lines << row.str();
  }
  table.close();
  lines.close();
  expect_same_bits(WISP_SOURCE_DIR "/apps/web/public/models/leaf.wisp", "on", at("wind.txt"),
                   "--input " + at("wind.csv"));
}

TEST_F(InfoPlayed, AFlameGoesOut) {
  for (const char* wind : {"1.9", "3"})
    expect_same_bits(WISP_SOURCE_DIR "/tests/model/golden/v1-extinction.wisp", "on", wind);
  for (const char* wind : {"2.5", "-2.5"})
    expect_same_bits(WISP_SOURCE_DIR "/apps/web/public/models/flame.wisp", "on", wind);
}

TEST_F(InfoPlayed, WhatIsNotPlayedIsRefusedInASentence) {
  ASSERT_TRUE(write_model(at("point.wisp"), sample_chain(ChainMotion::kPosition)));
  ASSERT_EQ(wisp("info " + at("point.wisp") + " --json").status, 0);
  const std::string python = "/usr/bin/python3 -B " WISP_SOURCE_DIR "/examples/08_play_json/play.py <" +
                             at("said.out") + " 2>" + at("why") + " >/dev/null";
  EXPECT_NE(std::system(python.c_str()), 0);
  std::string why;
  std::ifstream stream(at("why"));
  std::getline(stream, why);
  EXPECT_NE(why.find("the chain moves a point"), std::string::npos) << why;
}

class InfoOfATable : public InFolder {};

// What a stranger's table holds, before anybody said what drives what.
TEST_F(InfoOfATable, SaysWhatItHasToAssume) {
  std::ofstream(at("plain.csv")) << "heat,temperature,who\n1,2,ann\n3,4,bob\n5,7,ann\n";
  const Said said = wisp("info " + at("plain.csv"));
  ASSERT_EQ(said.status, 0) << said.err;
  for (const char* sentence : {"the table states no rate: taken as 1 Hz", "say --rate HZ or --dt S", "not said",
                               "'who' is not a column of numbers", "has only 3 rows"}) {
    EXPECT_THAT(said.out, HasSubstr(sentence));
  }
  EXPECT_THAT(said.out, testing::Not(HasSubstr("nothing was found")));
}

TEST_F(InfoOfATable, ALongTableOfKnownRateHasNothingToSay) {
  const Said said = wisp("info " WISP_SOURCE_DIR "/examples/load.csv --inputs busy --outputs load");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_THAT(said.out, HasSubstr("nothing was found that spoils a model"));
  EXPECT_THAT(said.out, HasSubstr("in steps of 5 s"));
}

}  // namespace
}  // namespace wisp::info_test
