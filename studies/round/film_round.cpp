// Films a candle of three dimensions from several level directions, each film with a camera, a microphone and a start
// of its own, and writes what is true: film_round PREFIX [--seconds 20] [--angles 0,90] [--seed 1] [--from DEG]
// [--side 36] [--cell 1.25] [--wind SPEED] [--orbit SECONDS]: a steady wind, and cameras that go once round in so long.
// PREFIX.ANGLE.mp4 and PREFIX.truth.csv.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "film_round.hpp"
#include "round_flow.hpp"
#include "simulate/candle/virtual_camera.hpp"
#include "simulate/candle/wind_signal.hpp"
#include "simulate/random_numbers.hpp"
#include "studies/value_or_abort.hpp"
#include "wisp/draw/video_writer.hpp"
#include "wisp/record/csv.hpp"

namespace {

using namespace wisp;
using verify::value_or_abort;

void must(const Result<void>& done) {
  if (done) return;
  std::fprintf(stderr, "%s\n", done.error().message.c_str());
  std::exit(1);
}

constexpr double kRate = 60, kSettle = 1;
constexpr double kHaste =
    1.6;                     // blows follow each other faster than in the plane rig, so that a short film has several
constexpr int kHeights = 6;  // of the truth's axis, as shares of the height from the rim

// A blow's direction is its own: drawn anew after a pause that is more than a lull.
class Winds {
 public:
  Winds(std::uint64_t seed, double seconds, double from, double steady)
      : signal_(value_or_abort(
            WindSignal::generate({.most = 0.9, .bandwidth_hz = 6 / kHaste, .seed = seed}, kHaste * seconds))),
        from_(from),
        steady_(steady) {
    flow::RandomNumbers random(seed, 77);
    double direction = 0, calm = 1;
    for (double t = 0; t < seconds; t += 1 / 240.0) {
      if (speed(t) > 0 && calm > 0.3) direction = random.uniform(0, 2 * std::numbers::pi);
      calm = speed(t) > 0 ? 0 : calm + 1 / 240.0;
      directions_.push_back(direction);
    }
  }
  double speed(double t) const {
    if (steady_ > 0) return steady_ * std::clamp(t, 0.0, 1.0);
    return t < 0 ? 0 : signal_.at(kHaste * t);
  }
  double direction(double t) const {
    if (from_ >= 0) return from_ * std::numbers::pi / 180;
    const double place = std::max(0.0, t) * 240;
    return directions_[std::min(static_cast<std::size_t>(place), directions_.size() - 1)];
  }

 private:
  WindSignal signal_;
  double from_, steady_;
  std::vector<double> directions_;
};

struct Phone {
  double azimuth, start;  // start: seconds after the first phone's
  VirtualCamera camera;
  VirtualMicrophone microphone;
  VideoWriter film;
  std::uint64_t frames = 0, heard = 0;
};

}  // namespace

int film_round(int count, char** words) {
  std::map<std::string, std::string> flags{{"--seconds", "20"}, {"--angles", "0,90"}, {"--seed", "1"},
                                           {"--from", "-1"},    {"--side", "36"},     {"--cell", "1.25"},
                                           {"--wind", "0"},     {"--orbit", "0"}};
  for (int k = 2; k + 1 < count; k += 2) flags[words[k]] = words[k + 1];
  const auto number = [&](const char* flag) { return std::atof(flags[flag].c_str()); };
  const std::string prefix = count > 1 ? words[1] : "round";
  const double seconds = number("--seconds");
  const auto seed = static_cast<std::uint64_t>(number("--seed"));
  const Winds winds(seed, seconds + 1, number("--from"), number("--wind"));
  const double around = number("--orbit") > 0 ? 360 / number("--orbit") : 0;
  flow::RoundOptions options{.side = static_cast<int>(number("--side")), .cell_mm = number("--cell")};
  flow::RoundFlow flow(options);

  std::vector<Phone> phones;
  std::stringstream angles(flags["--angles"]);
  for (std::string angle; std::getline(angles, angle, ',');) {
    const auto k = phones.size();
    // Not in step by whole frames: a phone begins when its owner touches it.
    const double start = k == 0 ? 0 : 0.7 * static_cast<double>(k) + 1 / 120.0;
    phones.push_back(Phone{std::atof(angle.c_str()), start,
                           value_or_abort(VirtualCamera::create({.width = 480, .seed = seed + 11 * k})),
                           value_or_abort(VirtualMicrophone::create({.other_sounds = 0, .seed = seed + 13 * k})),
                           value_or_abort(VideoWriter::create(
                               prefix + "." + angle + ".mp4",
                               {.width = 480, .height = 480, .rate_hz = kRate, .crf = 12, .sound_rate_hz = 44100}))});
  }

  Recording truth{.source = "simulated candle in the round", .rate_hz = kRate};
  for (const char* name : {"wind.x", "wind.z"}) truth.channels.push_back({name, "m/s", Role::kInput, {}});
  truth.channels.push_back({"height", "mm", Role::kOutput, {}});
  for (int k = 0; k < kHeights; ++k)
    for (const char* what : {".x", ".y", ".z", ".r"})
      truth.channels.push_back({"p" + std::to_string(k) + what, "mm", Role::kOutput, {}});

  const double step = 1 / options.steps_a_second;
  const int per_half = static_cast<int>(std::lround(options.steps_a_second / (2 * kRate)));
  for (int s = 0; s < static_cast<int>(kSettle / step); ++s) flow.step(0, 0);
  std::vector<float> wind, sound;
  for (long half = 0; half < std::lround(seconds * 2 * kRate); ++half) {
    for (int s = 0; s < per_half; ++s) {
      const double t = static_cast<double>(half) / (2 * kRate) + (s + 1) * step;
      const double speed = winds.speed(t), direction = winds.direction(t);
      flow.step(static_cast<float>(speed * std::cos(direction)), static_cast<float>(speed * std::sin(direction)));
    }
    const double now = static_cast<double>(half + 1) / (2 * kRate);
    for (Phone& phone : phones) {
      const double due = phone.start + static_cast<double>(phone.frames + 1) / kRate;
      if (std::abs(now - due) > 1e-6) continue;
      const auto pixels = phone.camera.picture(flow.seen_from(phone.azimuth + around * now), phone.frames);
      must(phone.film.write(Image::from_rgb(pixels, 480, 480)));
      const auto end = static_cast<std::uint64_t>(std::llround((due - phone.start) * 44100));
      wind.clear();
      for (std::uint64_t n = phone.heard; n < end; ++n)
        wind.push_back(static_cast<float>(winds.speed(phone.start + static_cast<double>(n) / 44100)));
      sound.resize(wind.size());
      phone.microphone.hear(wind, sound);
      must(phone.film.write_sound(sound));
      phone.heard = end;
      ++phone.frames;
    }
    if (half % 2 == 0) continue;
    std::vector<double> row{winds.speed(now) * std::cos(winds.direction(now)),
                            winds.speed(now) * std::sin(winds.direction(now))};
    const auto sections = flow.sections();
    const double height = sections.empty() ? std::nan("") : sections.back().y;
    row.push_back(height);
    for (int k = 0; k < kHeights; ++k) {
      const double wanted = height * (k + 1) / (kHeights + 1);
      std::size_t n = 1;
      while (n + 1 < sections.size() && sections[n].y < wanted) ++n;
      if (sections.size() < 2) {
        row.insert(row.end(), 4, std::nan(""));
        continue;
      }
      const auto &a = sections[n - 1], &b = sections[n];
      const double share = std::clamp((wanted - a.y) / (b.y - a.y), 0.0, 1.0);
      for (const double value :
           {a.x + share * (b.x - a.x), wanted, a.z + share * (b.z - a.z), a.radius + share * (b.radius - a.radius)})
        row.push_back(value);
    }
    for (std::size_t c = 0; c < row.size(); ++c) truth.channels[c].samples.push_back(row[c]);
    if (half % 120 == 119)
      std::printf("%.0f s: height %.1f mm, hottest %.0f K\n", now, height, flow.hottest()), std::fflush(stdout);
  }
  for (Phone& phone : phones) must(phone.film.finish());
  must(write_csv(prefix + ".truth.csv", truth));
  return 0;
}
