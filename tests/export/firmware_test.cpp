// A lamp in fixed point: beside what a bank plays, and on the processors that it is for.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "folder_test.hpp"
#include "paths.hpp"
#include "run/flame_model.hpp"
#include "wisp/export/export.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"

namespace wisp::firmware_test {
namespace {

// A light that is calm and restless by turns, as `wisp learn flicker` makes them.
Model light() {
  SwitchedArxModel dynamics;
  dynamics.orders = {OrderMatrix(1, 1, 4), OrderMatrix(1, 0), OrderMatrix(1, 0)};
  dynamics.output_mean = {1};
  // Poles of size 0.88, 0.31 and 0.20, in a mode that is shaken hardly and in one that is.
  dynamics.modes = {{.theta = {{-1.5, 0.8725, -0.00525, -0.04755}}, .constant = {0}, .shock = {0.0008}},
                    {.theta = {{-1.5, 0.8725, -0.00525, -0.04755}}, .constant = {0.002}, .shock = {0.03}}};
  dynamics.transitions = {0.98, 0.02, 0.03, 0.97};
  dynamics.initial = {0.6, 0.4};
  Model model{.name = "a light", .rate_hz = 50};
  model.outputs = {{"brightness", "", 0.5, 1.8}};
  model.dynamics = dynamics;
  return model;
}

// Mean, standard deviation, and share of half seconds that hardly change.
struct Look {
  double mean = 0, sd = 0, calm = 0;
};

Look look_of(const std::vector<double>& trace) {
  constexpr std::size_t kHalf = 25;
  Look look;
  for (const double value : trace) look.mean += value / static_cast<double>(trace.size());
  for (const double value : trace) look.sd += std::pow(value - look.mean, 2) / static_cast<double>(trace.size());
  look.sd = std::sqrt(look.sd);
  for (std::size_t at = 0; at + kHalf <= trace.size(); at += kHalf) {
    double mean = 0, square = 0;
    for (std::size_t k = at; k < at + kHalf; ++k) mean += trace[k] / kHalf;
    for (std::size_t k = at; k < at + kHalf; ++k) square += std::pow(trace[k] - mean, 2) / kHalf;
    look.calm += square < 0.02 * 0.02;
  }
  look.calm /= static_cast<double>(trace.size() / kHalf);
  return look;
}

class Firmware : public FolderTest {
 protected:
  void write(const Model& model) const {
    const auto source = firmware_source(model, "lamp");
    ASSERT_TRUE(source) << source.error().message;
    std::ofstream(folder_ / "lamp.h") << source->header;
    std::ofstream(folder_ / "lamp.c") << source->source;
  }

  // What a shell prints, run in the folder; empty where it fails.
  std::string said(const std::string& command) const {
    const std::string line = "cd '" + folder_.string() + "' && " + command + " 2>&1";
    std::FILE* pipe = ::popen(line.c_str(), "r");
    std::string text;
    std::array<char, 4096> part{};
    while (const std::size_t got = std::fread(part.data(), 1, part.size(), pipe)) text.append(part.data(), got);
    return ::pclose(pipe) == 0 ? text : "";
  }

  bool has(const std::string& compiler, const std::string& runner) const {
    return !said("command -v " + compiler + " && command -v " + runner).empty();
  }

  // The hash and the slowest step that a compiled lamp prints.
  std::string played(const std::string& compiler, const std::string& flags, const std::string& runner) const {
    const std::string bench = WISP_SOURCE_DIR "/studies/export/firmware/";
    const std::string built = said(compiler +
                                   " -std=c99 -I. -DLAMP_HEADER='\"lamp.h\"' -DLAMP_NAME=lamp "
                                   "-DLAMP_STEPS=3000 " +
                                   flags + " " + bench + "lamp_main.c lamp.c -o play && echo built");
    EXPECT_NE(built.find("built"), std::string::npos) << built;
    return said(runner);
  }
};

TEST_F(Firmware, PlaysAsABankDoes) {
  const Model model = light();
  write(model);
  std::ofstream(folder_ / "main.c")
      << "#include <stdio.h>\n#include \"lamp.h\"\n"
         "int main(void) { lamp_state lamp; int k; lamp_start(&lamp, 3);\n"
         "for (k = 0; k < 400000; ++k) printf(\"%d\\n\", lamp_step(&lamp));\nreturn 0; }\n";
  ASSERT_NE(said("cc -std=c99 -O1 -Wall -Wextra -Werror lamp.c main.c -o play && ./play > out && echo done"), "");
  std::vector<double> lamp, bank_light;
  std::ifstream stream(folder_ / "out");
  for (double value = 0; stream >> value;) lamp.push_back(value / 4096);
  ASSERT_EQ(lamp.size(), 400000u);
  auto bank = Bank::create(model, {.seed = 3});
  const InstanceId id = bank->spawn();
  std::array<float, 1> value{};
  for (int k = 0; k < 400000; ++k) {
    bank->step();
    bank->outputs(id, value);
    bank_light.push_back(value[0]);
  }
  const Look a = look_of(lamp), b = look_of(bank_light);
  // 8,000 s in modes that last about a second: shares are known to about 0.01, the deviation to 1 %.
  EXPECT_NEAR(a.mean, b.mean, 0.005);
  EXPECT_NEAR(a.sd / b.sd, 1, 0.04);
  EXPECT_NEAR(a.calm, b.calm, 0.03);
}

// What a lamp of one mode without memory plays: its shocks.
TEST_F(Firmware, ShocksHaveTheQuantilesThatWereRecorded) {
  Model model = light();
  auto& dynamics = std::get<SwitchedArxModel>(model.dynamics);
  dynamics.modes = {{.theta = {{0, 0, 0, 0}}, .constant = {0}, .shock = {0.05}}};
  dynamics.transitions = dynamics.initial = {1};
  // A light that flares: calm below, rarely far above.
  dynamics.shock_quantiles = {-1.2, -0.8, -0.6, -0.5, -0.42, -0.35, -0.3, -0.25, -0.2,
                              -0.1, 0,    0.05, 0.12, 0.2,   0.35,  0.7,  9};
  ASSERT_TRUE(check(model));
  const auto shocks_of = [&](const Model& lamp_model) {
    write(lamp_model);
    EXPECT_NE(said("cc -std=c99 -O1 -Wall -Wextra -Werror lamp.c main.c -o play && ./play > out && echo done"), "");
    std::vector<double> shocks;
    std::ifstream stream(folder_ / "out");
    for (double value = 0; stream >> value;) shocks.push_back((value / 4096 - 1) / 0.05);
    return shocks;
  };
  std::ofstream(folder_ / "main.c")
      << "#include <stdio.h>\n#include \"lamp.h\"\n"
         "int main(void) { lamp_state lamp; int k; lamp_start(&lamp, 3);\n"
         "for (k = 0; k < 400000; ++k) printf(\"%d\\n\", lamp_step(&lamp));\nreturn 0; }\n";
  const auto moment = [](const std::vector<double>& values, int power, double mean) {
    double sum = 0;
    for (const double value : values) sum += std::pow(value - mean, power) / static_cast<double>(values.size());
    return sum;
  };
  const auto flaring = shocks_of(model);
  ASSERT_EQ(flaring.size(), 400000u);
  const double mean = moment(flaring, 1, 0), sd = std::sqrt(moment(flaring, 2, mean));
  EXPECT_NEAR(mean, 0, 0.01);
  EXPECT_NEAR(sd, 1, 0.02);
  EXPECT_GT(moment(flaring, 3, mean), 2);
  EXPECT_GT(moment(flaring, 4, mean), 9);
  dynamics.shock_quantiles.clear();
  const auto normal = shocks_of(model);
  EXPECT_NEAR(std::sqrt(moment(normal, 2, 0)), 1, 0.02);
  EXPECT_NEAR(moment(normal, 4, 0), 3, 0.2);
}

// The dial: calm for ever, as recorded, and hardly ever calm.
TEST_F(Firmware, TheDialGoesFromCalmToBreezy) {
  write(light());
  std::ofstream(folder_ / "main.c")
      << "#include <stdio.h>\n#include \"lamp.h\"\n"
         "int main(void) { lamp_state lamp; int k; lamp_start(&lamp, 3); lamp.breeze = BREEZE;\n"
         "for (k = 0; k < 200000; ++k) printf(\"%d\\n\", lamp_step(&lamp));\nreturn 0; }\n";
  const auto calm_at = [&](int breeze) {
    EXPECT_NE(said("cc -std=c99 -O1 -DBREEZE=" + std::to_string(breeze) +
                   " lamp.c main.c -o play && ./play > out && echo ok"),
              "");
    std::vector<double> trace;
    std::ifstream stream(folder_ / "out");
    for (double value = 0; stream >> value;) trace.push_back(value / 4096);
    return look_of(trace).calm;
  };
  const double middle = calm_at(128);
  EXPECT_GT(calm_at(0), 0.99);
  EXPECT_GT(calm_at(64), middle + 0.05);
  EXPECT_LT(calm_at(192), middle - 0.05);
  EXPECT_LT(calm_at(255), 0.1);
}

// The three firmwares' headers need the chips' own compilers: stand-ins declare what their published sources do.
TEST_F(Firmware, ExamplesForLampsCompile) {
  const std::string lamps = WISP_SOURCE_DIR "/examples/07_led_candle/";
  const auto source = firmware_source(light(), "candle");
  ASSERT_TRUE(source);
  std::ofstream(folder_ / "candle.h") << source->header;
  std::ofstream(folder_ / "wled.h") << R"(#include <cstdint>
#define F(text) text
#define REGISTER_USERMOD(usermod) Usermod* const um_##usermod = &usermod
#define RGBW32(r, g, b, w) (uint32_t((w) << 24 | (r) << 16 | (g) << 8 | (b)))
#define R(c) ((c) >> 16 & 0xff)
#define G(c) ((c) >> 8 & 0xff)
#define B(c) ((c) & 0xff)
#define W(c) ((c) >> 24)
#define USERMOD_ID_UNSPECIFIED 1
struct Entry { Entry& operator=(int) { return *this; } };
struct JsonObject { Entry operator[](const char*) const { return {}; } JsonObject(Entry = {}) {} bool isNull() const { return true; }
  JsonObject createNestedObject(const char*) { return {}; } };
template <class T> bool getJsonValue(Entry, T&, T) { return true; }
struct Usermod { virtual void setup() = 0; virtual void loop() = 0; virtual void handleOverlayDraw() {}
  virtual void addToConfig(JsonObject&) {} virtual bool readFromConfig(JsonObject&) { return true; }
  virtual uint16_t getId() { return 0; } };
struct Segment { uint16_t start, stop; };
struct Strip { uint16_t getLengthTotal(); uint8_t getSegmentsNum(); Segment& getSegment(uint8_t);
  uint32_t getPixelColor(unsigned); void setPixelColor(unsigned, uint32_t); };
extern Strip strip;
uint32_t millis();
)";
  const std::string compile = "c++ -std=c++17 -Wall -Wextra -Werror -fsyntax-only -I. ";
  EXPECT_NE(said(compile + "-x c++ " + lamps + "wled/wisp_candle/wisp_candle.cpp && echo done"), "");
  said("mkdir -p esphome/components/light esphome/core");
  std::ofstream(folder_ / "esphome/core/hal.h") << "#include <cstdint>\nnamespace esphome { uint32_t millis(); }\n";
  std::ofstream(folder_ / "esphome/components/light/addressable_light_effect.h") << R"(#include <cstdint>
#include <string>
namespace esphome {
struct Color { Color operator*(uint8_t) const { return *this; } };
namespace light {
struct AddressableLight { int32_t size() const; Color& operator[](int32_t); void schedule_show(); };
struct AddressableLightEffect { explicit AddressableLightEffect(const std::string&) {}
  virtual void apply(AddressableLight&, const Color&) = 0; };
}}
)";
  std::ofstream(folder_ / "effect.cpp") << "#include \"" + lamps +
                                               "esphome/components/wisp_candle/wisp_candle.h\"\n"
                                               "esphome::wisp_candle::WispCandleEffect effect(\"candle\");\n";
  EXPECT_NE(said(compile + "effect.cpp && echo done"), "");
  EXPECT_NE(said("python3 -m py_compile " + lamps + "esphome/components/wisp_candle/__init__.py && rm -rf " + lamps +
                 "esphome/components/wisp_candle/__pycache__ && echo done"),
            "");
  std::ofstream(folder_ / "driver.cpp") << R"(#include <cstdint>
#define USE_WISP_CANDLE
#define USE_LIGHT
#define PROGMEM
#define FUNC_LOOP 1
#define FUNC_COMMAND 2
struct { int payload; } XdrvMailbox;
struct { uint8_t light_dimmer; } kept, *Settings = &kept;
struct { uint32_t power; } Light;
struct LightStateClass { static uint8_t DimmerToBri(uint8_t); void setBri(uint8_t); } light_state;
void ResponseCmndNumber(int); uint32_t millis(); uint32_t ESP_getChipId();
bool DecodeCommand(const char*, void (*const*)(void));
void CmndWispBreeze(void);
#include ")" + lamps + "tasmota/xdrv_120_wisp_candle.ino\"\n";
  EXPECT_NE(said(compile + "driver.cpp && echo done"), "");
}

// All pairs of 256 neighbouring seeds: none plays another's light, and none goes with it. Over 2,000 s a correlation of
// lights that have nothing to do with each other is 0.02 or so, the largest of 32,640 below 0.1.
TEST_F(Firmware, NeighbouringSeedsFlickerApart) {
  write(light());
  std::ofstream(folder_ / "main.c") << R"(#include <math.h>
#include <stdio.h>
#include "lamp.h"
enum { kLamps = 256, kSteps = 100000 };
static float light[kLamps][kSteps];
int main(void) {
  int a, b, t, equal = 0;
  double largest = 0;
  for (a = 0; a < kLamps; ++a) {
    lamp_state lamp;
    double mean = 0, square = 0;
    lamp_start(&lamp, FIRST_SEED + (uint32_t)a);
    for (t = 0; t < kSteps; ++t) mean += (light[a][t] = (float)lamp_step(&lamp)) / kSteps;
    for (t = 0; t < kSteps; ++t) square += (light[a][t] - mean) * (light[a][t] - mean);
    for (t = 0; t < kSteps; ++t) light[a][t] = (float)((light[a][t] - mean) / sqrt(square));
  }
  for (a = 0; a < kLamps; ++a) {
    for (b = a + 1; b < kLamps; ++b) {
      float along = 0;
      for (t = 0; t < kSteps; ++t) along += light[a][t] * light[b][t];
      equal += along > 0.999f;
      largest = fmax(largest, fabs(along));
    }
  }
  printf("%d %.3f", equal, largest);
  return 0;
}
)";
  for (const std::string first : {"0u", "0x9e377980u", "0xffffff80u"}) {
    std::istringstream words(
        said("cc -std=c99 -O3 -ffast-math -DFIRST_SEED=" + first + " lamp.c main.c -lm -o play && ./play"));
    int equal = -1;
    double largest = 2;
    words >> equal >> largest;
    EXPECT_EQ(equal, 0) << "seeds from " << first;
    EXPECT_LT(largest, 0.1) << "seeds from " << first;
  }
}

// The compilers and simulators come with script/bootstrap --verify, not with what all tests need.
TEST_F(Firmware, FitsAnATmega328PAndPlaysTheSameNumbersThere) {
  if (!has("avr-gcc", "simavr")) GTEST_SKIP() << "no avr-gcc and simavr; script/bootstrap --verify brings them";
  write(light());
  const std::string host = played("cc", "-O2", "./play").substr(0, 8);
  ASSERT_EQ(host.size(), 8u);
  const std::string avr =
      played("avr-gcc", "-mmcu=atmega328p -Os", "timeout 120 simavr -m atmega328p -f 16000000 play");
  const std::size_t at = avr.find(host);
  ASSERT_NE(at, std::string::npos) << "the host says " << host << ", simavr: " << avr;
  // 2 % of 16 MHz at 50 steps a second.
  EXPECT_LE(std::stoul(avr.substr(at + 9, 8), nullptr, 16), 6400u);
  const std::string size = said("avr-gcc -mmcu=atmega328p -Os -std=c99 -c lamp.c -o lamp.o && avr-size lamp.o");
  std::istringstream words(size.substr(size.find('\n')));
  int text = 0, data = 0, bss = 0;
  words >> text >> data >> bss;
  EXPECT_GT(text, 100) << size;
  EXPECT_LE(text + data, 1024);
  EXPECT_EQ(bss, 0);
}

TEST_F(Firmware, PlaysTheSameNumbersOnACortexM0) {
  if (!has("arm-none-eabi-gcc", "qemu-system-arm"))
    GTEST_SKIP() << "no arm-none-eabi-gcc and qemu-system-arm; script/bootstrap --verify brings them";
  write(light());
  const std::string host = played("cc", "-O2", "./play").substr(0, 8);
  ASSERT_EQ(host.size(), 8u);
  const std::string bench = WISP_SOURCE_DIR "/studies/export/firmware/";
  const std::string arm =
      played("arm-none-eabi-gcc",
             "-mcpu=cortex-m0 -mthumb -Os -nostartfiles -T " + bench + "cortex_m0.ld " + bench + "cortex_m0.c",
             "timeout 60 qemu-system-arm -M microbit -nographic -semihosting-config "
             "enable=on,target=native -kernel play </dev/null");
  EXPECT_NE(arm.find(host), std::string::npos) << "the host says " << host << ", QEMU: " << arm;
}

TEST_F(Firmware, ALampIsSmall) { EXPECT_LE(firmware_source(light(), "lamp")->state_bytes, 64u); }

TEST_F(Firmware, WhatNoLampCanPlayIsSaid) {
  const auto says = [](const Model& model, const std::string& words, const std::string& name = "lamp") {
    const auto source = firmware_source(model, name);
    ASSERT_FALSE(source);
    EXPECT_NE(source.error().message.find(words), std::string::npos) << source.error().message;
  };
  says(flame_model(), "16 outputs, a lamp has one");
  says(light(), "no name in C", "my lamp");
  Model far = light();
  std::get<SwitchedArxModel>(far.dynamics).output_mean = {90};
  says(far, "expected at most 3.9");
  Model driven = light();
  driven.inputs = {{"wind", "", 0, 1}};
  std::get<SwitchedArxModel>(driven.dynamics).orders = {OrderMatrix(1, 1, 4), OrderMatrix(1, 1), OrderMatrix(1, 1)};
  std::get<SwitchedArxModel>(driven.dynamics).input_mean = {0};
  says(driven, "a lamp has none");
}

TEST_F(Firmware, ARateThatIsNoWholeNumberIsRefused) {
  Model lamp = light();
  for (const double rate : {12.5, 0.2}) {
    lamp.rate_hz = rate;
    const auto source = firmware_source(lamp, "lamp");
    ASSERT_FALSE(source) << rate;
    EXPECT_NE(source.error().message.find("steps a second, expected a whole number from 1"), std::string::npos);
  }
  lamp.rate_hz = 29.97;
  EXPECT_TRUE(firmware_source(lamp, "lamp"));
}

TEST_F(Firmware, WhatFixedPointDoesNotHoldIsSaid) {
  const auto says = [](const Model& model, const std::string& words) {
    const auto source = firmware_source(model, "lamp");
    ASSERT_FALSE(source);
    EXPECT_NE(source.error().message.find(words), std::string::npos) << source.error().message;
  };
  // Five poles at 0.9.
  ArxModel steep_memory;
  steep_memory.orders = {OrderMatrix(1, 1, 5), OrderMatrix(1, 0), OrderMatrix(1, 0)};
  steep_memory.theta = {{-4.5, 8.1, -7.29, 3.2805, -0.59049}};
  steep_memory.constant = {0};
  steep_memory.output_mean = {1};
  steep_memory.noise.sd = {1e-6};
  Model steep = light();
  steep.dynamics = steep_memory;
  says(steep, "8 or more");
  ArxModel long_memory;
  long_memory.orders = {OrderMatrix(1, 1, 33), OrderMatrix(1, 0), OrderMatrix(1, 0)};
  long_memory.theta = {std::vector<double>(33, 0.001)};
  long_memory.constant = {0};
  long_memory.output_mean = {1};
  long_memory.noise.sd = {0.01};
  Model slow = light();
  slow.dynamics = long_memory;
  says(slow, "32 lags");
}

}  // namespace
}  // namespace wisp::firmware_test
