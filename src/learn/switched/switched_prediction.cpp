#include "learn/switched/switched_prediction.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "learn/numeric/constants.hpp"
#include "learn/switched/switched_rows.hpp"

namespace wisp {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;

constexpr int kMaxSteps = 100'000;

// A model's own operating point; sizes of 1, so that nothing is scaled.
SwitchedScales scales_of(const SwitchedArxModel& model) {
  return {model.output_mean, model.input_mean, std::vector<double>(model.output_mean.size(), 1.0),
          std::vector<double>(model.input_mean.size(), 1.0)};
}

Result<SwitchedRows> rows_of(const SwitchedArxModel& model, std::span<const Recording> recordings,
                             const ChannelChoice& channels) {
  if (auto ok = check(model); !ok) return ok.error();
  if (auto ok = check_switched_data(recordings, channels, model.orders); !ok) return ok.error();
  return make_switched_rows(recordings, channels, model.orders, scales_of(model));
}

// Deviations of one recording's channels; the outputs are overwritten where they are simulated.
struct Series {
  std::vector<std::vector<double>> outputs, inputs;

  RowVectorXd regressors(const std::vector<RegionSample>& samples, std::size_t t) const {
    RowVectorXd phi(1 + static_cast<Index>(samples.size()));
    phi(0) = 1;
    Index at = 1;
    for (const RegionSample& s : samples) {
      phi(at++) =
          (s.input ? inputs : outputs)[static_cast<std::size_t>(s.channel)][t - static_cast<std::size_t>(s.lag)];
    }
    return phi;
  }
};

Series deviations(const SwitchedArxModel& model, const Recording& recording, const ChannelChoice& channels) {
  const auto of = [&](const std::vector<std::string>& names, const std::vector<double>& means) {
    std::vector<std::vector<double>> all;
    for (std::size_t k = 0; k < names.size(); ++k) {
      all.push_back(recording.channels[*find_channel(recording, names[k])].samples);
      for (double& x : all.back()) x -= means[k];
    }
    return all;
  };
  return {of(channels.outputs, model.output_mean), of(channels.inputs, model.input_mean)};
}

class Predictor {
 public:
  Predictor(const SwitchedArxModel& model, const SwitchedRows& rows, const Series& measured)
      : modes_(scaled_modes(model, rows)), rows_(rows), measured_(measured) {
    belief_row_.assign(measured.outputs.front().size(), -1);
    for (std::size_t r = 0; r < rows.places.size(); ++r) belief_row_[rows.places[r].row] = static_cast<Index>(r);
    if (modes_.switching == Switching::kMarkov) {
      given_past_ = believe(modes_, rows, log_densities(modes_, rows)).given_past;
    }
  }

  // From the episode's first rows and its inputs; anew from measured samples after a gap in them.
  void free_run(const Episode& episode, std::vector<std::vector<double>>& out) const {
    Series series = measured_;
    RowVectorXd chance;
    for (std::size_t t = episode.begin + history(); t < episode.end; ++t) {
      chance = t == episode.begin + history() ? before(t) : onwards(chance);
      const RowVectorXd next = mean(series.regressors(rows_.samples, t), chance);
      for (std::size_t i = 0; i < out.size(); ++i) {
        out[i][t] = next(static_cast<Index>(i));
        if (!std::isnan(out[i][t])) series.outputs[i][t] = out[i][t];
      }
    }
  }

  // Every row from the samples up to `steps` before it.
  void ahead(const Episode& episode, int steps, std::vector<std::vector<double>>& out) const {
    Series series = measured_;
    const auto back = static_cast<std::size_t>(steps - 1);
    for (std::size_t t = episode.begin + history() + back; t < episode.end; ++t) {
      RowVectorXd chance, next;
      for (std::size_t s = t - back; s <= t; ++s) {
        chance = s == t - back ? before(s) : onwards(chance);
        next = mean(series.regressors(rows_.samples, s), chance);
        for (std::size_t i = 0; i < out.size(); ++i) series.outputs[i][s] = next(static_cast<Index>(i));
      }
      for (std::size_t i = 0; i < out.size(); ++i) {
        out[i][t] = next(static_cast<Index>(i));
        for (std::size_t s = t - back; s <= t; ++s) series.outputs[i][s] = measured_.outputs[i][s];
      }
    }
  }

 private:
  std::size_t history() const { return static_cast<std::size_t>(rows_.orders.history()); }

  RowVectorXd before(std::size_t t) const {
    if (modes_.switching != Switching::kMarkov) return {};
    const Index row = belief_row_[t];
    return row >= 0 ? RowVectorXd(given_past_.row(row)) : RowVectorXd(modes_.initial.transpose());
  }

  RowVectorXd onwards(const RowVectorXd& chance) const {
    return modes_.switching == Switching::kMarkov ? RowVectorXd(chance * modes_.transitions) : chance;
  }

  RowVectorXd mean(const RowVectorXd& phi, const RowVectorXd& chance) const {
    if (!phi.allFinite()) return RowVectorXd::Constant(rows_.outputs(), kMissing);
    if (modes_.switching == Switching::kRegions) {
      Index best = 0;
      (modes_.regions * phi.transpose()).maxCoeff(&best);
      return phi * modes_.theta[static_cast<std::size_t>(best)];
    }
    RowVectorXd sum = RowVectorXd::Zero(rows_.outputs());
    for (int k = 0; k < modes_.modes(); ++k) sum += chance(k) * (phi * modes_.theta[static_cast<std::size_t>(k)]);
    return sum;
  }

  ScaledModes modes_;
  const SwitchedRows& rows_;
  const Series& measured_;
  std::vector<Index> belief_row_;
  MatrixXd given_past_;
};

PredictionFigures figures_of(const SwitchedArxModel& model, const Series& measured,
                             const std::vector<std::vector<double>>& predicted, int steps) {
  PredictionFigures figures;
  figures.steps = steps;
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    double count = 0, error = 0, sum = 0, square = 0, size = 0;
    for (std::size_t t = 0; t < predicted[i].size(); ++t) {
      const double y = measured.outputs[i][t], e = y + model.output_mean[i] - predicted[i][t];
      if (std::isnan(e)) continue;
      ++count, error += e * e, size += std::abs(e), sum += y, square += y * y;
    }
    figures.rows = static_cast<std::size_t>(count);
    count = std::max(count, 1.0);
    const double spread = square - sum * sum / count;
    figures.mean_square.push_back(error / count);
    figures.fit_percent.push_back(spread > 0 ? 100 * (1 - std::sqrt(error / spread)) : 0);
    figures.j.push_back(size / count);
  }
  return figures;
}

}  // namespace

Result<std::vector<double>> row_log_likelihoods(const SwitchedArxModel& model, std::span<const Recording> recordings,
                                                const ChannelChoice& channels) {
  const auto rows = rows_of(model, recordings, channels);
  if (!rows) return rows.error();
  return row_log_likelihoods(scaled_modes(model, *rows), *rows);
}

Result<std::vector<int>> mode_sequence(const SwitchedArxModel& model, const Recording& recording,
                                       const ChannelChoice& channels) {
  const auto rows = rows_of(model, {&recording, 1}, channels);
  if (!rows) return rows.error();
  const std::vector<int> modes = likeliest_modes(scaled_modes(model, *rows), *rows);
  std::vector<int> out(recording.rows(), -1);
  for (std::size_t r = 0; r < modes.size(); ++r) out[rows->places[r].row] = modes[r];
  return out;
}

Result<std::vector<std::vector<double>>> predict_switched(const SwitchedArxModel& model, const Recording& recording,
                                                          const ChannelChoice& channels, int steps) {
  if (steps < 0 || steps > kMaxSteps) {
    return Error{"predictions were requested " + std::to_string(steps) + " steps ahead, expected 1 to 100000, or free"};
  }
  const auto rows = rows_of(model, {&recording, 1}, channels);
  if (!rows) return rows.error();
  const Series measured = deviations(model, recording, channels);
  const Predictor predictor(model, *rows, measured);
  std::vector<std::vector<double>> out(channels.outputs.size(), std::vector<double>(recording.rows(), kMissing));
  for (const Episode& episode : episodes(recording)) {
    steps == kFreeRun ? predictor.free_run(episode, out) : predictor.ahead(episode, steps, out);
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (double& y : out[i]) y += model.output_mean[i];
  }
  return out;
}

Result<std::vector<PredictionFigures>> switched_figures(const SwitchedArxModel& model, const Recording& recording,
                                                        const ChannelChoice& channels, const std::vector<int>& steps) {
  std::vector<PredictionFigures> all;
  for (int step : steps) {
    const auto predicted = predict_switched(model, recording, channels, step);
    if (!predicted) return predicted.error();
    all.push_back(figures_of(model, deviations(model, recording, channels), *predicted, step));
  }
  return all;
}

}  // namespace wisp
