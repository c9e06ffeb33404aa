#include "learn/outline/outline_preparation.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "model/bspline.hpp"
#include "record/number_text.hpp"

namespace wisp {
namespace {

using Matrix = Eigen::MatrixXd;

constexpr int kSamples = 200;

// Basis functions at equally spaced parameters: samples × control points.
Matrix basis_table(std::span<const double> knots) {
  const auto points = static_cast<Eigen::Index>(knots.size()) - kSplineDegree - 1;
  Matrix table = Matrix::Zero(kSamples, points);
  for (int k = 0; k < kSamples; ++k) {
    const BasisWeights weights = basis(knots, static_cast<double>(k) / (kSamples - 1));
    for (int r = 0; r < 4; ++r) table(k, weights.first + r) = weights.weight[r];
  }
  return table;
}

// Matrix from old to new control points. The first and the last are kept, since clamped curves end in them; the others
// are a least-squares fit.
Matrix change(const Matrix& from, const Matrix& to) {
  const Eigen::Index points = to.cols();
  const Matrix inner = to.middleCols(1, points - 2);
  Matrix rest = from;
  rest.col(0) -= to.col(0);
  rest.col(points - 1) -= to.col(points - 1);
  Matrix out = Matrix::Zero(points, points);
  out(0, 0) = out(points - 1, points - 1) = 1;
  out.middleRows(1, points - 2) = inner.colPivHouseholderQr().solve(rest);
  return out;
}

ChannelChoice channel_choice(const PreparedOutlines& prepared) {
  return {regressor_names(prepared.inputs, prepared.shape), outline_outputs(prepared.layout.points)};
}

// Moves the outputs before all other channels, in the layout's order, so that one layout fits all prepared recordings.
Recording outputs_first(Recording recording, const OutlineLayout& layout) {
  std::vector<Channel> ordered;
  for (std::size_t c : layout.outputs) ordered.push_back(std::move(recording.channels[c]));
  for (std::size_t c = 0; c < recording.channels.size(); ++c) {
    if (std::find(layout.outputs.begin(), layout.outputs.end(), c) != layout.outputs.end()) continue;
    ordered.push_back(std::move(recording.channels[c]));
  }
  recording.channels = std::move(ordered);
  return recording;
}

Result<void> add(const Recording& recording, double pixels_per_unit, PreparedOutlines& prepared) {
  const auto layout = outline_layout(recording);
  if (!layout) return layout.error();
  if (layout->knots != prepared.layout.knots) {
    const Reknotted other = with_knots(recording, *layout, prepared.layout.knots);
    prepared.warnings.push_back(recording.source + ": its knots are not the model's; its outlines were expressed in " +
                                "those, " + number_text(other.rms, 2) + " pixels away on average");
    return add(other.recording, pixels_per_unit, prepared);
  }
  const auto undisturbed = undisturbed_rows(recording, prepared.inputs);
  const double own = resting_height_pixels(recording, *layout, prepared.inputs);
  if (!(own > 0)) return Error{recording.source + ": has no row with an outline"};
  const double scale = pixels_per_unit > 0 ? pixels_per_unit : own;
  prepared.pixels_per_unit.push_back(scale);
  const Recording units = outputs_first(to_model_units(recording, *layout, scale), *layout);
  prepared.rest.push_back(mean_shape(units, prepared.layout, undisturbed));
  prepared.recordings.push_back(with_regressors(units, prepared.inputs, prepared.shape));
  return {};
}

// Warns of recordings tracked in different colours: a flame's edge is narrower in green than in red.
void warn_of_other_colours(std::span<const Recording> recordings, PreparedOutlines& prepared) {
  const auto first = find_attribute(recordings.front(), "channel");
  for (const Recording& recording : recordings.subspan(1)) {
    const auto own = find_attribute(recording, "channel");
    if (!first || !own || *own == *first) continue;
    prepared.warnings.push_back(recording.source + ": its outlines were found in " + std::string(*own) + ", those of " +
                                recordings.front().source + " in " + std::string(*first) +
                                ", so that they are not as wide; capture both with the same --channel");
  }
}

OutlineLayout prepared_layout(const std::vector<double>& knots) {
  OutlineLayout layout{knots.size() - kSplineDegree - 1, knots, {}};
  layout.outputs.resize(2 * layout.points);
  std::iota(layout.outputs.begin(), layout.outputs.end(), std::size_t{0});
  return layout;
}

std::vector<const std::vector<double>*> samples_of(const Recording& recording, const ChannelChoice& channels) {
  std::vector<const std::vector<double>*> out;
  for (const auto* names : {&channels.outputs, &channels.inputs}) {
    for (const std::string& name : *names) out.push_back(&samples_of(recording, name));
  }
  return out;
}

bool complete(const std::vector<const std::vector<double>*>& samples, std::size_t row) {
  return std::none_of(samples.begin(), samples.end(), [&](const auto* channel) { return std::isnan((*channel)[row]); });
}

// Returns the index of the first row with `count` complete rows before it.
std::size_t row_after(const Recording& recording, const ChannelChoice& channels, std::size_t count) {
  const auto samples = samples_of(recording, channels);
  std::size_t row = 0;
  for (; row < recording.rows() && count > 0; ++row) count -= complete(samples, row) ? 1 : 0;
  return row;
}

std::size_t near_episode_boundary(const Recording& recording, std::size_t cut) {
  std::size_t best = cut;
  std::size_t nearest = recording.rows() / 10 + 1;
  for (const Episode& episode : episodes(recording)) {
    if (episode.begin == 0) continue;
    const std::size_t away = episode.begin > cut ? episode.begin - cut : cut - episode.begin;
    if (away >= nearest) continue;
    nearest = away;
    best = episode.begin;
  }
  return best;
}

}  // namespace

Reknotted with_knots(const Recording& recording, const OutlineLayout& layout, std::span<const double> knots) {
  const Matrix from = basis_table(layout.knots);
  const Matrix to = basis_table(knots);
  const Matrix matrix = change(from, to);
  Reknotted out{recording, 0};
  set_numbers_attribute(out.recording, "knots", knots);
  const auto points = static_cast<Eigen::Index>(layout.points);
  double square = 0;
  double rows = 0;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    Matrix old(points, 2);
    for (Eigen::Index k = 0; k < 2 * points; ++k) {
      old(k / 2, k % 2) = recording.channels[layout.outputs[k]].samples[row];
    }
    if (!old.allFinite()) continue;
    const Matrix fresh = matrix * old;
    for (Eigen::Index k = 0; k < 2 * points; ++k) {
      out.recording.channels[layout.outputs[k]].samples[row] = fresh(k / 2, k % 2);
    }
    square += (to * fresh - from * old).squaredNorm() / kSamples;
    rows += 1;
  }
  out.rms = rows > 0 ? std::sqrt(square / rows) : 0;
  return out;
}

Result<PreparedOutlines> prepare_outlines(std::span<const Recording> recordings, const PreparationOptions& options) {
  const auto layout = common_layout(recordings);
  if (!layout) return layout.error();
  std::vector<OutlineInput> inputs;
  for (const std::string& name : options.inputs ? *options.inputs : input_names(recordings.front())) {
    auto input = scaled_input(recordings, name);
    if (!input) return input.error();
    inputs.push_back(*std::move(input));
  }
  return prepare_outlines(recordings, layout->knots, std::move(inputs), options.shape, options.pixels_per_unit);
}

Result<PreparedOutlines> prepare_outlines(std::span<const Recording> recordings, const std::vector<double>& knots,
                                          std::vector<OutlineInput> inputs, RegressorShape shape,
                                          double pixels_per_unit) {
  PreparedOutlines prepared;
  prepared.layout = prepared_layout(knots);
  prepared.inputs = std::move(inputs);
  if (!prepared.inputs.empty()) prepared.shape = shape;
  prepared.channels = channel_choice(prepared);
  for (const Recording& recording : recordings) {
    if (auto ok = add(recording, pixels_per_unit, prepared); !ok) return ok.error();
  }
  warn_of_other_colours(recordings, prepared);
  return prepared;
}

std::size_t complete_rows(std::span<const Recording> recordings, const ChannelChoice& channels) {
  std::size_t count = 0;
  for (const Recording& recording : recordings) {
    const auto samples = samples_of(recording, channels);
    for (std::size_t row = 0; row < recording.rows(); ++row) count += complete(samples, row) ? 1 : 0;
  }
  return count;
}

OutlineParts hold_out(std::span<const Recording> recordings, const ChannelChoice& channels, double share) {
  OutlineParts parts;
  for (const Recording& recording : recordings) {
    const auto kept = (1 - share) * static_cast<double>(complete_rows({&recording, 1}, channels));
    const std::size_t in_time = row_after(recording, channels, static_cast<std::size_t>(std::lround(kept)));
    const std::size_t cut = share > 0 ? near_episode_boundary(recording, in_time) : recording.rows();
    parts.learned.push_back(slice(recording, 0, cut));
    if (cut < recording.rows()) parts.held_out.push_back(slice(recording, cut, recording.rows()));
  }
  return parts;
}

}  // namespace wisp
