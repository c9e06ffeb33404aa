#include "studies/baselines/frames.hpp"

#include <cmath>

#include "learn/fidelity/fidelity_distance.hpp"
#include "wisp/run/random.hpp"

namespace wisp::baselines {

Result<std::vector<Frames>> frames_of(std::span<const Recording> recordings, const std::vector<std::string>& outputs,
                                      const std::string& wind, Eigen::Index least) {
  std::vector<std::string> channels = outputs;
  channels.push_back(wind);
  const auto ny = static_cast<Eigen::Index>(outputs.size());
  std::vector<Frames> out;
  for (const Recording& recording : recordings) {
    const auto stretches = stretches_of(recording, channels);
    if (!stretches) return stretches.error();
    for (const Stretch& stretch : *stretches) {
      const auto rows = static_cast<Eigen::Index>(stretch.rows());
      if (rows < least) continue;
      using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      const Eigen::Map<const RowMajor> all(stretch.values.data(), rows, ny + 1);
      out.push_back({all.leftCols(ny), all.col(ny)});
    }
  }
  return out;
}

Eigen::VectorXd mean_of(std::span<const Frames> frames) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(frames.front().outputs.cols());
  Eigen::Index count = 0;
  for (const Frames& each : frames) {
    sum += each.outputs.colwise().sum().transpose();
    count += each.size();
  }
  return sum / static_cast<double>(count);
}

std::uint32_t NormalStream::word() {
  const std::uint64_t at = count_++;
  return random_words({.seed = seed_, .stream = 0, .step = at / 4, .group = 0})[at % 4];
}

double NormalStream::next() { return normal_pair(word())[0]; }

double NormalStream::uniform() { return word() / 4294967296.0; }

Eigen::VectorXd NormalStream::next(Eigen::Index count) {
  return Eigen::VectorXd::NullaryExpr(count, [this] { return next(); });
}

Recording play_along(const Step& step, std::span<const double> wind, std::size_t warm_up,
                     const std::vector<std::string>& outputs, double rate_hz) {
  const auto wind_at = [&](std::size_t row) { return std::isnan(wind[row]) ? 0.0 : wind[row]; };
  for (std::size_t t = warm_up; t > 0; --t) (void)step(wind_at((wind.size() - t % wind.size()) % wind.size()));
  Recording out{.source = "played", .rate_hz = rate_hz};
  for (const std::string& name : outputs) out.channels.push_back({name, "", Role::kOutput, {}});
  for (std::size_t row = 0; row < wind.size(); ++row) {
    const Eigen::VectorXd values = step(wind_at(row));
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      out.channels[k].samples.push_back(values[static_cast<Eigen::Index>(k)]);
    }
  }
  return out;
}

}  // namespace wisp::baselines
