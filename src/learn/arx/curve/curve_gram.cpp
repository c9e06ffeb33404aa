#include "learn/arx/curve/curve_gram.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "learn/arx/fit/arx_check.hpp"
#include "learn/arx/rows/arx_design.hpp"
#include "learn/arx/rows/lag_gram.hpp"
#include "learn/numeric/decompositions.hpp"

namespace wisp {
namespace {

constexpr double kMinGap = 1e-3;      // of the curve's length: knots that are nearer are one
constexpr double kSideRidge = 1e-12;  // of a column's own product: sides that never blow are nobody's

// How far an input has come from a knot to the next, 0 to 1; NaN stays NaN.
double climbed(double input, double from, double to) {
  if (input <= from) return 0;
  return input >= to ? 1 : (input - from) / (to - from);
}

std::string piece_name(const std::string& channel, std::size_t piece) {
  return channel + " from knot " + std::to_string(piece);
}

// An input channel as pieces: where it stands in the model's order, and whose curve bends it.
struct Bent {
  int curve = 0;
  std::size_t pieces = 0;
  int first = 0;  // of its pieces, among the expanded inputs
};

// The regression with every input channel replaced by the pieces of its curve.
struct Expanded {
  std::vector<Recording> recordings;
  ChannelChoice channels;
  ArxOrders orders;
  std::vector<Bent> bent;  // one an input channel
};

Result<int> curve_of(const std::string& channel, const CurveFitOptions& options) {
  for (std::size_t c = 0; c < options.inputs.size(); ++c) {
    const auto& names = options.inputs[c].channels;
    if (std::find(names.begin(), names.end(), channel) != names.end()) return static_cast<int>(c);
  }
  return Error{"no curve was requested input " + channel + ", and all inputs have one or none has"};
}

Recording in_pieces(const Recording& recording, const ChannelChoice& channels, const std::vector<Bent>& bent,
                    const std::vector<std::vector<double>>& knots) {
  Recording out = recording;
  for (std::size_t k = 0; k < channels.inputs.size(); ++k) {
    const std::vector<double>& samples = recording.channels[*find_channel(recording, channels.inputs[k])].samples;
    const std::vector<double>& at = knots[static_cast<std::size_t>(bent[k].curve)];
    for (std::size_t p = 0; p + 1 < at.size(); ++p) {
      Channel piece{piece_name(channels.inputs[k], p), "", Role::kInput, {}};
      for (double u : samples) piece.samples.push_back(climbed(u, at[p], at[p + 1]));
      out.channels.push_back(std::move(piece));
    }
  }
  return out;
}

ArxOrders orders_in_pieces(const ArxOrders& orders, const std::vector<Bent>& bent) {
  int count = 0;
  for (const Bent& one : bent) count += static_cast<int>(one.pieces);
  ArxOrders out{orders.na, OrderMatrix(orders.outputs(), count), OrderMatrix(orders.outputs(), count)};
  for (int i = 0; i < orders.outputs(); ++i) {
    for (std::size_t k = 0; k < bent.size(); ++k) {
      for (int p = 0; p < static_cast<int>(bent[k].pieces); ++p) {
        out.nb(i, bent[k].first + p) = orders.nb(i, static_cast<int>(k));
        out.nk(i, bent[k].first + p) = orders.nk(i, static_cast<int>(k));
      }
    }
  }
  return out;
}

Result<Expanded> expanded(std::span<const Recording> recordings, const ChannelChoice& channels,
                          const CurveFitOptions& options, const std::vector<std::vector<double>>& knots) {
  Expanded out{{}, {{}, channels.outputs}, {}, {}};
  for (const std::string& name : channels.inputs) {
    const auto curve = curve_of(name, options);
    if (!curve) return curve.error();
    const std::size_t pieces = knots[static_cast<std::size_t>(*curve)].size() - 1;
    out.bent.push_back({*curve, pieces, static_cast<int>(out.channels.inputs.size())});
    for (std::size_t p = 0; p < pieces; ++p) out.channels.inputs.push_back(piece_name(name, p));
  }
  for (const Recording& one : recordings) out.recordings.push_back(in_pieces(one, channels, out.bent, knots));
  out.orders = orders_in_pieces(options.orders, out.bent);
  return out;
}

// What is left of the products of `kept` columns when what `taken` ones explain is gone.
Eigen::MatrixXd left_over(const Eigen::MatrixXd& gram, const std::vector<int>& kept, const std::vector<int>& taken) {
  Eigen::MatrixXd left = gram(kept, kept);
  if (taken.empty()) return left;
  Eigen::MatrixXd own = gram(taken, taken);
  own.diagonal() *= 1 + kSideRidge;
  own.diagonal().array() += (own.diagonal().array() == 0).cast<double>();
  const Eigen::MatrixXd shared = gram(taken, kept);
  left.noalias() -= shared.transpose() * symmetric_solutions(own, shared);
  return left;
}

CurveRow row_of(const Expanded& data, const ArxOrders& orders, const Signals& signals, const LagLayout& layout,
                const Eigen::MatrixXd& gram, int output) {
  CurveRow row;
  std::vector<int> kept, taken;
  std::vector<double> units;
  for (int j = 0; j < orders.outputs(); ++j) {
    for (int lag = 1; lag <= orders.na(output, j); ++lag) taken.push_back(layout.find({j, lag}));
  }
  for (std::size_t k = 0; k < data.bent.size(); ++k) {
    const int input = static_cast<int>(k);
    for (int lag = 0; lag < orders.nb(output, input); ++lag) {
      row.taps.push_back({data.bent[k].curve, static_cast<int>(kept.size())});
      for (int p = 0; p < static_cast<int>(data.bent[k].pieces); ++p) {
        const int channel = orders.outputs() + data.bent[k].first + p;
        kept.push_back(layout.find({channel, orders.nk(output, input) + lag}));
        // Rises are compared with each other, so pieces must not have scales of their own.
        const double scale = signals.scale[static_cast<std::size_t>(channel)];
        units.push_back(scale > 0 ? 1 / scale : 0);
      }
    }
  }
  kept.push_back(layout.target(output));
  units.push_back(1);
  const Eigen::Map<const Eigen::VectorXd> unit(units.data(), static_cast<Eigen::Index>(units.size()));
  row.gram = unit.asDiagonal() * left_over(gram, kept, taken) * unit.asDiagonal();
  row.own_columns = static_cast<double>(taken.size());
  const double scale = signals.scale[static_cast<std::size_t>(output)];
  row.unit = scale > 0 ? 1 / scale : 0;
  return row;
}

Result<void> check_options(const CurveFitOptions& options) {
  if (options.knots >= 3 && options.knots <= static_cast<int>(kMaxCurveKnots)) return {};
  return Error{"a curve of " + std::to_string(options.knots) + " knots was requested, expected 3 to 16"};
}

}  // namespace

std::vector<double> curve_knots(std::span<const Recording> recordings, const CurvedInput& input, int knots) {
  std::vector<double> samples;
  for (const Recording& recording : recordings) {
    for (const std::string& name : input.channels) {
      for (double u : recording.channels[*find_channel(recording, name)].samples) {
        if (u > std::max(input.lowest, input.calm) && u < input.highest) samples.push_back(u);
      }
    }
  }
  std::sort(samples.begin(), samples.end());
  const double gap = kMinGap * (input.highest - input.lowest);
  std::vector<double> at{input.lowest};
  for (int k = 1; k < knots - 1 && !samples.empty(); ++k) {
    const double share = static_cast<double>(k) / (knots - 1);
    const double next = samples[static_cast<std::size_t>(share * static_cast<double>(samples.size() - 1))];
    if (next - at.back() > gap && input.highest - next > gap) at.push_back(next);
  }
  at.push_back(input.highest);
  return at;
}

Result<CurveGram> curve_gram(std::span<const Recording> recordings, const ChannelChoice& channels,
                             const CurveFitOptions& options) {
  if (auto ok = check_options(options); !ok) return ok.error();
  if (auto ok = check_orders(options.orders, channels); !ok) return ok.error();
  if (const auto found = find_signals(recordings, channels); !found) return found.error();
  CurveGram out;
  for (const CurvedInput& input : options.inputs) {
    out.knots.push_back(curve_knots(recordings, input, options.knots));
    if (out.knots.back().size() >= 3) continue;
    return Error{recordings.front().source + ": its input " + input.channels.front() +
                 " takes too few values to tell a curve from a line; learn without --input-curve"};
  }
  const auto data = expanded(recordings, channels, options, out.knots);
  if (!data) return data.error();
  const auto signals = gather_signals(data->recordings, data->channels, ArxOffset::kMean);
  if (!signals) return signals.error();
  const ArxDesign design = make_design(data->orders, ArxOffset::kMean);
  const RowPlan plan = plan_rows(*signals, design.layout, design.layout.history());
  out.samples = plan.rows;
  for (int i = 0; i < options.orders.outputs(); ++i) {
    if (plan.rows > 2 * design.row_size(i)) continue;
    return Error{recordings.front().source + ": has " + std::to_string(plan.rows) + " complete rows, and " +
                 std::to_string(design.row_size(i)) +
                 " pieces and lags of an output need more than twice as many; record longer or lower the order"};
  }
  const Eigen::MatrixXd gram = lag_gram(*signals, plan, design.layout, wanted_pairs(design));
  for (int i = 0; i < options.orders.outputs(); ++i) {
    out.rows.push_back(row_of(*data, options.orders, *signals, design.layout, gram, i));
  }
  return out;
}

}  // namespace wisp
