#include "learn/outline/outline_components.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "learn/arx/rows/arx_orders.hpp"
#include "learn/numeric/chi_squared.hpp"
#include "learn/numeric/decompositions.hpp"

namespace wisp {
namespace {

constexpr double kMinSd = 1e-3;  // of the largest component's: below it is rounding

// Calls visit(row of outputs) for every row that has all of them.
template <class Visit>
void each_shape(std::span<const Recording> recordings, const PreparedOutlines& prepared, Visit visit) {
  Eigen::VectorXd row(static_cast<Eigen::Index>(prepared.layout.outputs.size()));
  for (const Recording& recording : recordings) {
    for (std::size_t t = 0; t < recording.rows(); ++t) {
      for (std::size_t k = 0; k < prepared.layout.outputs.size(); ++k) {
        row[static_cast<Eigen::Index>(k)] = recording.channels[prepared.layout.outputs[k]].samples[t];
      }
      if (row.allFinite()) visit(row);
    }
  }
}

Eigen::VectorXd mean_row(std::span<const Recording> recordings, const PreparedOutlines& prepared) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(prepared.layout.outputs.size()));
  double rows = 0;
  each_shape(recordings, prepared, [&](const Eigen::VectorXd& row) {
    sum += row;
    ++rows;
  });
  return sum / std::max(1.0, rows);
}

// The mean of the recordings' calm shapes; nothing where one of them is never calm.
std::optional<Eigen::VectorXd> calm_shape(const PreparedOutlines& prepared) {
  if (prepared.inputs.empty()) return std::nullopt;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(prepared.layout.outputs.size()));
  for (const std::vector<double>& rest : prepared.rest) {
    if (rest.empty()) return std::nullopt;
    sum += Eigen::Map<const Eigen::VectorXd>(rest.data(), sum.size());
  }
  return sum / static_cast<double>(prepared.rest.size());
}

// The recording with components in the place of its outputs. Weighted rows are longer or shorter.
Recording in_components(const Recording& recording, const PreparedOutlines& prepared, const ShapeComponents& components,
                        double weight) {
  Recording out = recording;
  std::erase_if(out.channels, [](const Channel& channel) { return channel.role != Role::kInput; });
  const double length = std::sqrt(weight);
  for (Channel& input : out.channels) {
    for (double& value : input.samples) value *= length;
  }
  const Eigen::Index ny = components.score.cols();
  for (Eigen::Index c = 0; c < components.score.rows(); ++c) {
    Channel channel{components.names[static_cast<std::size_t>(c)], "", Role::kOutput, {}};
    channel.samples.assign(recording.rows(), 0.0);
    for (Eigen::Index k = 0; k < ny; ++k) {
      const double score = components.score(c, k);
      if (score == 0) continue;
      const auto place = static_cast<std::size_t>(k);
      const std::vector<double>& samples = recording.channels[prepared.layout.outputs[place]].samples;
      for (std::size_t row = 0; row < samples.size(); ++row) {
        channel.samples[row] += length * score * (samples[row] - components.rest[place]);
      }
    }
    out.channels.push_back(std::move(channel));
  }
  return out;
}

// Orders of the components: all of them hear each other and every input.
ArxOrders component_orders(const ArxOrders& coordinates, std::size_t components) {
  const auto m = static_cast<int>(components);
  const int nu = coordinates.inputs();
  ArxOrders out{OrderMatrix(m, m, coordinates.na(0, 0)), OrderMatrix(m, nu), OrderMatrix(m, nu)};
  for (int i = 0; i < m; ++i) {
    for (int k = 0; k < nu; ++k) {
      out.nb(i, k) = coordinates.nb(0, k);
      out.nk(i, k) = coordinates.nk(0, k);
    }
  }
  return out;
}

// Of one lag, the matrix by which all outputs hear all channels.
Eigen::MatrixXd lag_of_a(const ArxModel& model, int lag) {
  const int m = model.orders.outputs();
  Eigen::MatrixXd out(m, m);
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < m; ++j) out(i, j) = model.a(i, j)[static_cast<std::size_t>(lag)];
  }
  return out;
}

Eigen::VectorXd lag_of_b(const ArxModel& model, int input, int lag) {
  const int m = model.orders.outputs();
  Eigen::VectorXd out(m);
  for (int i = 0; i < m; ++i) out[i] = model.b(i, input)[static_cast<std::size_t>(lag)];
  return out;
}

Eigen::VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

std::vector<double> values_of(const Eigen::VectorXd& vector) { return {vector.begin(), vector.end()}; }

// The model of the components as one of the coordinates.
ArxModel in_coordinates(const ArxModel& model, const ShapeComponents& components, const ArxOrders& orders) {
  ArxModel out;
  out.orders = orders;
  const int ny = orders.outputs();
  std::vector<Eigen::MatrixXd> a;
  a.reserve(static_cast<std::size_t>(orders.na(0, 0)));
  for (int lag = 0; lag < orders.na(0, 0); ++lag) {
    a.push_back(components.shape * lag_of_a(model, lag) * components.score);
  }
  std::vector<std::vector<Eigen::VectorXd>> b(static_cast<std::size_t>(orders.inputs()));
  for (int k = 0; k < orders.inputs(); ++k) {
    for (int lag = 0; lag < orders.nb(0, k); ++lag) {
      b[static_cast<std::size_t>(k)].push_back(components.shape * lag_of_b(model, k, lag));
    }
  }
  for (int i = 0; i < ny; ++i) {
    std::vector<double>& row = out.theta.emplace_back();
    for (int j = 0; j < ny; ++j) {
      for (int lag = 0; lag < orders.na(i, j); ++lag) row.push_back(a[static_cast<std::size_t>(lag)](i, j));
    }
    for (const auto& lags : b) {
      for (const Eigen::VectorXd& lag : lags) row.push_back(lag[i]);
    }
  }
  out.constant = values_of(components.shape * vector_of(model.constant));
  out.output_mean = values_of(vector_of(components.rest) + components.shape * vector_of(model.output_mean));
  out.input_mean = model.input_mean;
  return out;
}

// What is known of the noise, in coordinates. Of `rows` that were observed; weighted mirror images are no observations.
void set_noise(const ShapeComponents& components, double weight, ArxFit& fitted, ArxModel& model) {
  ArxSummary& summary = fitted.summary;
  const Eigen::Index m = components.shape.cols(), ny = components.shape.rows();
  Eigen::MatrixXd covariance(m, m);
  for (Eigen::Index i = 0; i < m; ++i) {
    for (Eigen::Index j = 0; j < m; ++j)
      covariance(i, j) = summary.noise_covariance[static_cast<std::size_t>(i * m + j)];
  }
  const double share = weight > 0 ? (1 + weight) / 2 : 1;
  const Eigen::MatrixXd noise = components.shape * covariance * components.shape.transpose() / share;
  const double rows = static_cast<double>(summary.samples_used) / (weight > 0 ? 2 : 1);
  const double coefficients = fitted.model.orders.row_size(0), freedom = std::max(1.0, rows - coefficients);
  const double known = std::max(1.0, rows - coefficients);
  summary.noise_covariance.clear();
  summary.loss.clear();
  summary.row_fpe.clear();
  for (Eigen::Index i = 0; i < ny; ++i) {
    for (Eigen::Index j = 0; j < ny; ++j) summary.noise_covariance.push_back(noise(i, j));
    const double loss = noise(i, i), sd = std::sqrt(std::max(0.0, loss) * rows / known);
    summary.loss.push_back(loss);
    summary.row_fpe.push_back(loss * (rows + coefficients) / known);
    model.noise.sd.push_back(sd);
    model.noise.sd_ci95.push_back({sd * std::sqrt(freedom / chi_squared_quantile(0.975, freedom)),
                                   sd * std::sqrt(freedom / chi_squared_quantile(0.025, freedom))});
  }
}

}  // namespace

ShapeComponents shape_components(std::span<const Recording> recordings, const PreparedOutlines& prepared) {
  ShapeComponents out;
  const Eigen::VectorXd mean = mean_row(recordings, prepared);
  const auto calm = calm_shape(prepared);
  out.about_calm = calm.has_value();
  out.rest = values_of(calm.value_or(mean));
  const Eigen::Index ny = mean.size();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(ny, ny);
  double rows = 0;
  each_shape(recordings, prepared, [&](const Eigen::VectorXd& row) {
    covariance += (row - mean) * (row - mean).transpose();
    ++rows;
  });
  const SymmetricEigensystem found = symmetric_eigensystem(covariance / std::max(1.0, rows));
  const Eigen::VectorXd sd = found.values.cwiseMax(0).cwiseSqrt();
  Eigen::Index m = 0;
  while (m < ny && sd[ny - 1 - m] > kMinSd * sd[ny - 1]) ++m;
  m = std::max<Eigen::Index>(1, std::min(m, ny - 2));
  out.shape.resize(ny, m);
  out.score.resize(m, ny);
  for (Eigen::Index c = 0; c < m; ++c) {
    const double size = std::max(sd[ny - 1 - c], std::numeric_limits<double>::min());
    out.shape.col(c) = found.vectors.col(ny - 1 - c) * size;
    out.score.row(c) = found.vectors.col(ny - 1 - c).transpose() / size;
    out.names.push_back("component " + std::to_string(c));
  }
  for (Eigen::Index k = 0; k < 2; ++k) {
    const Eigen::Index last = ny - 2 + k;
    out.score.col(k) -= out.score.col(last);
    out.score.col(last).setZero();
    out.shape.row(last) = -out.shape.row(k);
    const auto first = static_cast<std::size_t>(k);
    out.rest[static_cast<std::size_t>(last)] = -out.rest[first];
  }
  return out;
}

Result<ArxFit> fit_components(std::span<const Recording> recordings, const PreparedOutlines& prepared,
                              const ComponentOptions& options) {
  const ShapeComponents components = shape_components(recordings, prepared);
  std::vector<Recording> rows;
  for (const Recording& one : recordings) rows.push_back(in_components(one, prepared, components, 1));
  const double weight = components.about_calm ? options.mirror_weight : options.mirror_weight > 0 ? 1 : 0;
  if (weight > 0) {
    const std::vector<Recording> both = with_mirror_images(recordings, prepared);
    for (std::size_t r = recordings.size(); r < both.size(); ++r) {
      rows.push_back(in_components(both[r], prepared, components, weight));
    }
  }
  const ArxOptions arx{.orders = component_orders(options.orders, components.names.size()),
                       .offset = weight > 0 && weight < 1 ? ArxOffset::kNone : ArxOffset::kMean,  // shrunk about rest
                       .ridge = options.ridge,
                       .judge_free_run = false};  // nobody knows components by name
  const ChannelChoice channels{prepared.channels.inputs, components.names};
  auto fitted = fit_arx(rows, channels, arx);
  if (!fitted) return fitted;
  ArxModel model = in_coordinates(fitted->model, components, options.orders);
  set_noise(components, weight, *fitted, model);
  fitted->model = std::move(model);
  return fitted;
}

}  // namespace wisp
