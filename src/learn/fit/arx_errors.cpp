#include "learn/fit/arx_errors.hpp"

#include <algorithm>

#include "learn/numeric/stream_kernels.hpp"

namespace wisp {

Result<Signals> signals_of_model(const ArxModel& model, std::span<const Recording> recordings,
                                 const ChannelChoice& channels) {
  if (static_cast<int>(channels.outputs.size()) != model.orders.outputs() ||
      static_cast<int>(channels.inputs.size()) != model.orders.inputs()) {
    return Error{"the model has " + std::to_string(model.orders.outputs()) + " outputs and " +
                 std::to_string(model.orders.inputs()) + " inputs, but " + std::to_string(channels.outputs.size()) +
                 " and " + std::to_string(channels.inputs.size()) + " channels were named"};
  }
  auto signals = find_signals(recordings, channels);
  if (!signals) return signals;
  std::copy(model.output_mean.begin(), model.output_mean.end(), signals->offset.begin());
  std::copy(model.input_mean.begin(), model.input_mean.end(), signals->offset.begin() + signals->outputs);
  return signals;
}

ErrorFilter::ErrorFilter(const ArxModel& model, const Signals& signals)
    : model_(model), block_(signals, model.orders.history()), rows_(model.orders.outputs()) {
  const int ny = model.orders.outputs();
  for (int i = 0; i < ny; ++i) {
    for (int j = 0; j < ny; ++j) {
      const auto a = model.a(i, j);
      for (std::size_t l = 0; l < a.size(); ++l) rows_[i].columns.push_back({j, static_cast<int>(l) + 1});
      rows_[i].weights.insert(rows_[i].weights.end(), a.begin(), a.end());
    }
    for (int k = 0; k < model.orders.inputs(); ++k) {
      const auto b = model.b(i, k);
      for (std::size_t l = 0; l < b.size(); ++l) {
        rows_[i].columns.push_back({ny + k, model.orders.nk(i, k) + static_cast<int>(l)});
        rows_[i].weights.push_back(-b[l]);
      }
    }
  }
}

void ErrorFilter::errors(const RowRun& rows, Eigen::Ref<Eigen::MatrixXd> out) {
  block_.load(rows);
  for (int i = 0; i < model_.orders.outputs(); ++i) {
    series_.clear();
    for (const LaggedChannel& column : rows_[i].columns) series_.push_back(block_.series(column));
    combine(block_.series({i, 0}), series_, rows_[i].weights, block_.rows(), out.col(i).data());
    if (model_.constant[i] != 0) out.col(i).array() -= model_.constant[i];
  }
}

std::vector<Eigen::MatrixXd> noise_response(const ArxModel& model, int count) {
  const int ny = model.orders.outputs();
  std::vector<Eigen::MatrixXd> response(static_cast<std::size_t>(count), Eigen::MatrixXd::Zero(ny, ny));
  if (count > 0) response[0].setIdentity();
  for (int step = 1; step < count; ++step) {
    for (int i = 0; i < ny; ++i) {
      for (int j = 0; j < ny; ++j) {
        const auto a = model.a(i, j);
        for (int lag = 1; lag <= std::min(step, static_cast<int>(a.size())); ++lag) {
          response[step].row(i) -= a[lag - 1] * response[step - lag].row(j);
        }
      }
    }
  }
  return response;
}

}  // namespace wisp
