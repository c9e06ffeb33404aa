#pragma once
// Recordings of linear systems whose coefficients are known.

#include <cstddef>
#include <random>
#include <string>

#include "wisp/model/arx.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Two outputs y1, y2 and two inputs u1, u2, stable, every entry with orders and a delay of its own, one of them 0.
inline ArxModel made_system() {
  ArxModel model;
  model.orders = {OrderMatrix(2, 2), OrderMatrix(2, 2), OrderMatrix(2, 2)};
  const auto set = [](OrderMatrix& matrix, int a, int b, int c, int d) {
    matrix(0, 0) = a, matrix(0, 1) = b, matrix(1, 0) = c, matrix(1, 1) = d;
  };
  set(model.orders.na, 2, 1, 0, 3);
  set(model.orders.nb, 2, 1, 0, 2);
  set(model.orders.nk, 1, 3, 0, 0);
  model.theta = {{-1.4, 0.65, 0.2, 0.5, 0.25, -0.4}, {-0.9, 0.3, -0.1, 0.7, -0.2}};
  model.constant = {0, 0};
  model.output_mean = {10, -3};
  model.input_mean = {1, 2};
  model.noise.sd = {0.1, 0.2};
  return model;
}

/// What the system does from rest, driven by noise; `noise` scales its residual.
inline Recording record_system(const ArxModel& model, std::size_t rows, unsigned seed, double noise = 1) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  const int ny = model.orders.outputs(), nu = model.orders.inputs();
  Recording recording;
  recording.source = "made";
  recording.rate_hz = 10;
  for (int k = 0; k < nu; ++k) {
    recording.channels.push_back({"u" + std::to_string(k + 1), "", Role::kInput, std::vector<double>(rows)});
  }
  for (int i = 0; i < ny; ++i) {
    recording.channels.push_back({"y" + std::to_string(i + 1), "", Role::kOutput, std::vector<double>(rows)});
  }
  const auto deviation = [&](int channel, double mean, std::size_t t, std::size_t lag) {
    return lag <= t ? recording.channels[channel].samples[t - lag] - mean : 0.0;
  };
  for (std::size_t t = 0; t < rows; ++t) {
    for (int k = 0; k < nu; ++k) recording.channels[k].samples[t] = model.input_mean[k] + normal(generator);
    for (int i = 0; i < ny; ++i) {
      double y = model.constant[i] + noise * model.noise.sd[i] * normal(generator);
      for (int j = 0; j < ny; ++j) {
        const auto a = model.a(i, j);
        for (std::size_t l = 0; l < a.size(); ++l) y -= a[l] * deviation(nu + j, model.output_mean[j], t, l + 1);
      }
      for (int k = 0; k < nu; ++k) {
        const auto b = model.b(i, k);
        const auto delay = static_cast<std::size_t>(model.orders.nk(i, k));
        for (std::size_t l = 0; l < b.size(); ++l) y += b[l] * deviation(k, model.input_mean[k], t, l + delay);
      }
      recording.channels[nu + i].samples[t] = model.output_mean[i] + y;
    }
  }
  return recording;
}

}  // namespace wisp
