#include "learn/markov/markov_prediction.hpp"

#include <cmath>
#include <string>

#include "learn/numeric/constants.hpp"

namespace wisp::markov {
namespace {

using Eigen::Index;
using Eigen::RowVectorXd;

constexpr int kMaxSteps = 100'000;

Result<Rows> rows_of(const SwitchedArxModel& model, const Recording& recording, const ChannelChoice& channels) {
  if (auto ok = check(model); !ok) return ok.error();
  std::vector<double> offset = model.output_mean;
  offset.insert(offset.end(), model.input_mean.begin(), model.input_mean.end());
  return make_rows({&recording, 1}, channels, model.orders, std::move(offset));
}

// Outputs, then inputs, about the operating point; outputs are overwritten where they are simulated.
using Series = std::vector<std::vector<double>>;

Series deviations(const Rows& rows, const Recording& recording, const ChannelChoice& channels) {
  Series all;
  for (const auto* names : {&channels.outputs, &channels.inputs}) {
    for (const std::string& name : *names) {
      all.push_back(recording.channels[*find_channel(recording, name)].samples);
      for (double& x : all.back()) x -= rows.offset[all.size() - 1];
    }
  }
  return all;
}

class Predictor {
 public:
  Predictor(const SwitchedArxModel& model, const Rows& rows, const Series& measured)
      : chain_(chain_of(model, rows)), rows_(rows), measured_(measured), series_(measured) {
    belief_row_.assign(measured.front().size(), -1);
    for (std::size_t r = 0; r < rows.places.size(); ++r) belief_row_[rows.places[r].row] = static_cast<Index>(r);
    given_past_ = believe(chain_, rows).given_past;
  }

  // Every row from the samples up to `steps` before it, or from the episode's first rows.
  void predict(const Episode& episode, int steps, Series& out) {
    const std::size_t first = episode.begin + static_cast<std::size_t>(rows_.orders.history());
    if (steps == kFreeRun) {
      RowVectorXd chance;
      for (std::size_t t = first; t < episode.end; ++t) show(t, step(t, t == first, chance), out);
      return;
    }
    const auto back = static_cast<std::size_t>(steps - 1);
    for (std::size_t t = first + back; t < episode.end; ++t) {
      RowVectorXd chance, next;
      for (std::size_t s = t - back; s <= t; ++s) next = step(s, s == t - back, chance);
      show(t, next, out);
      for (std::size_t i = 0; i < out.size(); ++i) {
        for (std::size_t s = t - back; s <= t; ++s) series_[i][s] = measured_[i][s];
      }
    }
  }

 private:
  // The mean of row t, which takes the measured one's place; no number where a sample is missing, and the measured row
  // stays then. `chance`: of the modes at the row before.
  RowVectorXd step(std::size_t t, bool first, RowVectorXd& chance) {
    const Index known = belief_row_[t];
    chance = !first       ? RowVectorXd(chance * chain_.transitions)
             : known >= 0 ? RowVectorXd(given_past_.row(known))
                          : RowVectorXd(chain_.initial.transpose());
    const LagLayout& layout = rows_.design.layout;
    RowVectorXd phi = RowVectorXd::Ones(layout.size());
    for (int c = 0; c < layout.size(); ++c) {
      const auto [channel, lag] = layout[c];
      if (channel == kConstantChannel) continue;
      const bool target = channel < rows_.outputs() && lag == 0;
      phi(c) = target ? 0 : series_[static_cast<std::size_t>(channel)][t - static_cast<std::size_t>(lag)];
    }
    if (!phi.allFinite()) return RowVectorXd::Constant(rows_.outputs(), kMissing);
    RowVectorXd next = RowVectorXd::Zero(rows_.outputs());
    for (std::size_t k = 0; k < chain_.modes.size(); ++k) {
      next += chance(static_cast<Index>(k)) * (phi * chain_.modes[k].theta);
    }
    for (Index i = 0; i < next.size(); ++i) series_[static_cast<std::size_t>(i)][t] = next(i);
    return next;
  }

  static void show(std::size_t t, const RowVectorXd& next, Series& out) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i][t] = next(static_cast<Index>(i));
  }

  Chain chain_;
  const Rows& rows_;
  const Series& measured_;
  Series series_;
  std::vector<Index> belief_row_;
  Eigen::MatrixXd given_past_;
};

}  // namespace

Result<Belief> believe(const SwitchedArxModel& model, const Recording& recording, const ChannelChoice& channels) {
  const auto rows = rows_of(model, recording, channels);
  if (!rows) return rows.error();
  return believe(chain_of(model, *rows), *rows);
}

Result<Series> predict(const SwitchedArxModel& model, const Recording& recording, const ChannelChoice& channels,
                       int steps) {
  if (steps < 0 || steps > kMaxSteps) {
    return Error{"predictions were requested " + std::to_string(steps) + " steps ahead, expected 1 to 100000, or free"};
  }
  const auto rows = rows_of(model, recording, channels);
  if (!rows) return rows.error();
  const Series measured = deviations(*rows, recording, channels);
  Predictor predictor(model, *rows, measured);
  Series out(channels.outputs.size(), std::vector<double>(recording.rows(), kMissing));
  for (const Episode& episode : episodes(recording)) predictor.predict(episode, steps, out);
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (double& y : out[i]) y += model.output_mean[i];
  }
  return out;
}

Result<PredictionFigures> figures(const SwitchedArxModel& model, std::span<const Recording> recordings,
                                  const ChannelChoice& channels, int steps) {
  std::vector<Series> predicted;
  for (const Recording& recording : recordings) {
    auto one = predict(model, recording, channels, steps);
    if (!one) return one.error();
    predicted.push_back(std::move(*one));
  }
  PredictionFigures out;
  out.steps = steps;
  for (std::size_t i = 0; i < channels.outputs.size(); ++i) {
    double count = 0, error = 0, sum = 0, square = 0, size = 0;
    for (std::size_t r = 0; r < predicted.size(); ++r) {
      const auto& measured = recordings[r].channels[*find_channel(recordings[r], channels.outputs[i])].samples;
      for (std::size_t t = 0; t < measured.size(); ++t) {
        const double y = measured[t] - model.output_mean[i], e = measured[t] - predicted[r][i][t];
        if (std::isnan(e)) continue;
        ++count, error += e * e, size += std::abs(e), sum += y, square += y * y;
      }
    }
    out.rows = static_cast<std::size_t>(count);
    count = std::max(count, 1.0);
    const double spread = square - sum * sum / count;
    out.mean_square.push_back(error / count);
    out.fit_percent.push_back(spread > 0 ? 100 * (1 - std::sqrt(error / spread)) : 0);
    out.j.push_back(size / count);
  }
  return out;
}

}  // namespace wisp::markov
