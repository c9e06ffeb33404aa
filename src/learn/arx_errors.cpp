#include "arx_errors.hpp"

#include <algorithm>

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

std::vector<std::vector<int>> lags_of_model(const ArxModel& model) {
  const ArxOrders& orders = model.orders;
  const int ny = orders.outputs();
  std::vector<std::vector<int>> lags(ny + orders.inputs());
  for (int i = 0; i < ny; ++i) {
    lags[i].push_back(0);
    for (int j = 0; j < ny; ++j) {
      for (int lag = 1; lag <= orders.na(i, j); ++lag) lags[j].push_back(lag);
    }
    for (int k = 0; k < orders.inputs(); ++k) {
      for (int lag = 0; lag < orders.nb(i, k); ++lag) lags[ny + k].push_back(orders.nk(i, k) + lag);
    }
  }
  for (auto& list : lags) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return lags;
}

ErrorFilter::ErrorFilter(const ArxModel& model, const Signals& signals)
    : model_(model), signals_(signals), history_(model.orders.history()), terms_(model.orders.outputs()) {
  const int ny = model.orders.outputs();
  for (int i = 0; i < ny; ++i) {
    for (int j = 0; j < ny; ++j) {
      const auto a = model.a(i, j);
      for (std::size_t l = 0; l < a.size(); ++l) terms_[i].push_back({j, static_cast<int>(l) + 1, a[l]});
    }
    for (int k = 0; k < model.orders.inputs(); ++k) {
      const auto b = model.b(i, k);
      for (std::size_t l = 0; l < b.size(); ++l) {
        terms_[i].push_back({ny + k, model.orders.nk(i, k) + static_cast<int>(l), -b[l]});
      }
    }
  }
}

void ErrorFilter::errors(std::size_t recording, std::size_t begin, Eigen::Ref<Eigen::MatrixXd> out) {
  rows_ = out.rows();
  samples_.resize(rows_ + history_, signals_.channels());
  for (int c = 0; c < signals_.channels(); ++c) {
    copy_scaled(signals_, recording, c, begin - static_cast<std::size_t>(history_),
                begin + static_cast<std::size_t>(rows_), samples_.col(c).data());
  }
  for (int i = 0; i < model_.orders.outputs(); ++i) {
    out.col(i) = samples_.col(i).tail(rows_).array() - model_.constant[i];
    for (const Term& term : terms_[i]) {
      out.col(i) += term.weight * samples_.col(term.channel).segment(history_ - term.lag, rows_);
    }
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
