#include "studies/baselines/emulator.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <type_traits>
#include <vector>

namespace wisp::baselines {
namespace {

// Examples as columns: what the network is given, and the scaled change that follows.
struct Examples {
  Eigen::MatrixXd given;
  Eigen::MatrixXd wanted;

  Eigen::Index size() const { return given.cols(); }
};

struct Parts {
  Examples learned;
  Examples held_out;
};

Eigen::Index inputs_of(const Emulator& net) { return net.lags * net.mean.size() + net.wind_lags; }

void scale(std::span<const Frames> frames, Emulator& net) {
  net.mean = mean_of(frames);
  const Eigen::Index ny = net.mean.size();
  Eigen::ArrayXd square = Eigen::ArrayXd::Zero(ny), change = Eigen::ArrayXd::Zero(ny);
  double count = 0, steps = 0, wind = 0;
  net.lowest = Eigen::VectorXd::Constant(ny, std::numeric_limits<double>::infinity());
  net.highest = -net.lowest;
  for (const Frames& each : frames) {
    square += (each.outputs.rowwise() - net.mean.transpose()).array().square().colwise().sum().transpose();
    change += (each.outputs.bottomRows(each.size() - 1) - each.outputs.topRows(each.size() - 1))
                  .array()
                  .square()
                  .colwise()
                  .sum()
                  .transpose();
    wind += each.wind.squaredNorm();
    net.lowest = net.lowest.cwiseMin(each.outputs.colwise().minCoeff().transpose());
    net.highest = net.highest.cwiseMax(each.outputs.colwise().maxCoeff().transpose());
    count += static_cast<double>(each.size());
    steps += static_cast<double>(each.size() - 1);
  }
  const double least = 1e-9;  // what never moves is not divided by 0
  net.sd = (square / count).sqrt().max(least);
  net.spread = (change / steps).sqrt().max(least);
  net.wind_scale = std::max(std::sqrt(wind / count), least);
  const Eigen::VectorXd margin = (net.highest - net.lowest) / 2;
  net.lowest -= margin;
  net.highest += margin;
}

int first_row(const Emulator& net) { return std::max(net.lags, net.wind_lags - 1); }

void fill(const Frames& frames, Eigen::Index row, const Emulator& net, Eigen::Ref<Eigen::VectorXd> given) {
  const Eigen::Index ny = net.mean.size();
  for (int lag = 1; lag <= net.lags; ++lag) {
    given.segment((lag - 1) * ny, ny) = (frames.outputs.row(row - lag).transpose() - net.mean).cwiseQuotient(net.sd);
  }
  for (int lag = 0; lag < net.wind_lags; ++lag) given[net.lags * ny + lag] = frames.wind[row - lag] / net.wind_scale;
}

Examples examples(std::span<const Frames> frames, const Emulator& net, double from, double to) {
  const auto bound = [&](const Frames& each, double share) {
    const auto row = static_cast<Eigen::Index>(std::lround(share * static_cast<double>(each.size())));
    return std::max<Eigen::Index>(row, first_row(net));
  };
  Eigen::Index count = 0;
  for (const Frames& each : frames) count += std::max<Eigen::Index>(0, bound(each, to) - bound(each, from));
  Examples out{Eigen::MatrixXd(inputs_of(net), count), Eigen::MatrixXd(net.mean.size(), count)};
  Eigen::Index at = 0;
  for (const Frames& each : frames) {
    for (Eigen::Index row = bound(each, from); row < std::min(bound(each, to), each.size()); ++row, ++at) {
      fill(each, row, net, out.given.col(at));
      out.wanted.col(at) = (each.outputs.row(row) - each.outputs.row(row - 1)).transpose().cwiseQuotient(net.spread);
    }
  }
  out.given.conservativeResize(Eigen::NoChange, at);
  out.wanted.conservativeResize(Eigen::NoChange, at);
  return out;
}

Eigen::MatrixXd hidden(const Emulator& net, const Eigen::MatrixXd& given) {
  return ((net.w1 * given).colwise() + net.b1).array().tanh();
}

Eigen::MatrixXd answer(const Emulator& net, const Eigen::MatrixXd& given) {
  return (net.w2 * hidden(net, given)).colwise() + net.b2;
}

double mean_square(const Emulator& net, const Examples& examples) {
  if (examples.size() == 0) return 0;
  return (answer(net, examples.given) - examples.wanted).squaredNorm() / static_cast<double>(examples.wanted.size());
}

// One array of weights under Adam.
class Moments {
 public:
  explicit Moments(Eigen::Index size) : mean_(Eigen::ArrayXd::Zero(size)), square_(Eigen::ArrayXd::Zero(size)) {}

  void descend(Eigen::Map<Eigen::ArrayXd> weights, const Eigen::Map<const Eigen::ArrayXd>& gradient, double rate,
               int step) {
    constexpr double kMean = 0.9, kSquare = 0.999, kMin = 1e-8;
    mean_ = kMean * mean_ + (1 - kMean) * gradient;
    square_ = kSquare * square_ + (1 - kSquare) * gradient.square();
    const double m = 1 - std::pow(kMean, step), s = 1 - std::pow(kSquare, step);
    weights -= rate * (mean_ / m) / ((square_ / s).sqrt() + kMin);
  }

 private:
  Eigen::ArrayXd mean_;
  Eigen::ArrayXd square_;
};

class Teacher {
 public:
  Teacher(Emulator& net, const EmulatorOptions& options)
      : net_(net),
        options_(options),
        random_(options.seed),
        w1_(net.w1.size()),
        b1_(net.b1.size()),
        w2_(net.w2.size()),
        b2_(net.b2.size()) {}

  void start() {
    const auto spread = [&](Eigen::MatrixXd& weights) {
      const double size = std::sqrt(1.0 / static_cast<double>(weights.cols()));
      weights = Eigen::MatrixXd::NullaryExpr(weights.rows(), weights.cols(), [&] { return size * random_.next(); });
    };
    spread(net_.w1);
    spread(net_.w2);
    net_.w2 *= 0.1;  // at first: nothing changes
    net_.b1.setZero();
    net_.b2.setZero();
  }

  void epoch(const Examples& all) {
    std::vector<Eigen::Index> order(static_cast<std::size_t>(all.size()));
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t k = order.size(); k > 1; --k) {
      std::swap(order[k - 1], order[static_cast<std::size_t>(random_.uniform() * static_cast<double>(k))]);
    }
    const auto batch = static_cast<std::size_t>(options_.batch);
    for (std::size_t first = 0; first < order.size(); first += batch) {
      const std::vector<Eigen::Index> some(
          order.begin() + static_cast<std::ptrdiff_t>(first),
          order.begin() + static_cast<std::ptrdiff_t>(std::min(first + batch, order.size())));
      Eigen::MatrixXd given = all.given(Eigen::all, some);
      const Eigen::Index history = net_.lags * net_.mean.size();
      given.topRows(history) += Eigen::MatrixXd::NullaryExpr(
          history, given.cols(), [this] { return options_.jitter > 0 ? options_.jitter * random_.next() : 0.0; });
      Eigen::MatrixXd wanted = all.wanted(Eigen::all, some);
      // The last frame is known to the network with its jitter: the way back is part of what is wanted.
      const Eigen::Index ny = net_.mean.size();
      wanted -=
          (net_.sd.cwiseQuotient(net_.spread)).asDiagonal() * (given.topRows(ny) - all.given(Eigen::seqN(0, ny), some));
      learn(given, wanted);
    }
  }

 private:
  void learn(const Eigen::MatrixXd& given, const Eigen::MatrixXd& wanted) {
    const Eigen::MatrixXd inner = hidden(net_, given);
    const Eigen::MatrixXd error =
        (((net_.w2 * inner).colwise() + net_.b2) - wanted) / static_cast<double>(given.cols());
    const Eigen::MatrixXd back = (net_.w2.transpose() * error).array() * (1 - inner.array().square());
    ++step_;
    descend(w2_, net_.w2, error * inner.transpose());
    descend(b2_, net_.b2, error.rowwise().sum());
    descend(w1_, net_.w1, back * given.transpose());
    descend(b1_, net_.b1, back.rowwise().sum());
  }

  template <class Weights>
  void descend(Moments& moments, Weights& weights, const std::type_identity_t<Weights>& gradient) {
    moments.descend({weights.data(), weights.size()}, {gradient.data(), gradient.size()}, options_.rate, step_);
  }

  Emulator& net_;
  const EmulatorOptions& options_;
  NormalStream random_;
  Moments w1_, b1_, w2_, b2_;
  int step_ = 0;
};

void teach(Emulator& net, const Parts& parts, const EmulatorOptions& options) {
  const Examples& judged = parts.held_out.size() > 0 ? parts.held_out : parts.learned;
  Teacher teacher(net, options);
  teacher.start();
  Emulator best = net;
  best.held_out_error = mean_square(net, judged);
  for (int epoch = 1; epoch <= options.max_epochs && epoch - best.epochs <= options.patience; ++epoch) {
    teacher.epoch(parts.learned);
    net.epochs = epoch;
    net.held_out_error = mean_square(net, judged);
    if (net.held_out_error < best.held_out_error) best = net;
  }
  net = best;
  net.learned_error = mean_square(net, parts.learned);
}

Eigen::MatrixXd noise_of(const Emulator& net, const Examples& examples) {
  const Eigen::MatrixXd left = net.spread.asDiagonal() * (examples.wanted - answer(net, examples.given));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(left * left.transpose() /
                                                              static_cast<double>(examples.size()));
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

}  // namespace

Emulator learn_emulator(std::span<const Frames> frames, const EmulatorOptions& options) {
  Emulator net{.lags = options.lags, .wind_lags = options.wind_lags};
  scale(frames, net);
  net.w1.resize(options.hidden, inputs_of(net));
  net.b1.resize(options.hidden);
  net.w2.resize(net.mean.size(), options.hidden);
  net.b2.resize(net.mean.size());
  const Parts parts{examples(frames, net, 0, 1 - options.held_out), examples(frames, net, 1 - options.held_out, 1)};
  teach(net, parts, options);
  // What it leaves where it has not learned is what it leaves anywhere else.
  net.noise = noise_of(net, parts.held_out.size() > 0 ? parts.held_out : parts.learned);
  return net;
}

Eigen::VectorXd Emulator::next(const std::deque<Eigen::VectorXd>& history, const std::deque<double>& wind) const {
  Eigen::VectorXd given(inputs_of(*this));
  for (int lag = 0; lag < lags; ++lag) {
    given.segment(lag * mean.size(), mean.size()) = (history[static_cast<std::size_t>(lag)] - mean).cwiseQuotient(sd);
  }
  for (int lag = 0; lag < wind_lags; ++lag) {
    given[lags * mean.size() + lag] = wind[static_cast<std::size_t>(lag)] / wind_scale;
  }
  return history.front() + spread.cwiseProduct(answer(*this, given));
}

std::size_t Emulator::bytes() const {
  // Scales are folded into the weights; what is held takes two numbers an output.
  return 4 * static_cast<std::size_t>(w1.size() + b1.size() + w2.size() + b2.size() + noise.size() + 2 * mean.size());
}

std::int64_t Emulator::operations() const {
  // Sums of products, a tanh a unit, the change added, and noise.
  return 2 * (w1.size() + w2.size()) + b1.size() + b2.size() + 2 * noise.size();
}

EmulatorPlayer::EmulatorPlayer(const Emulator& emulator, std::uint64_t seed, bool noise)
    : emulator_(emulator),
      random_(seed),
      noise_(noise),
      history_(static_cast<std::size_t>(emulator.lags), emulator.mean),
      wind_(static_cast<std::size_t>(emulator.wind_lags), 0.0) {}

Eigen::VectorXd EmulatorPlayer::step(double wind) {
  if (!wind_.empty()) {
    wind_.pop_back();
    wind_.push_front(wind);
  }
  Eigen::VectorXd outputs = emulator_.next(history_, wind_);
  if (noise_) outputs += emulator_.noise * random_.next(outputs.size());
  const Eigen::VectorXd held = outputs.cwiseMax(emulator_.lowest).cwiseMin(emulator_.highest);
  ++steps_;
  held_ += held == outputs ? 0 : 1;
  history_.pop_back();
  history_.push_front(held);
  return held;
}

double EmulatorPlayer::held_share() const {
  return steps_ == 0 ? 0 : static_cast<double>(held_) / static_cast<double>(steps_);
}

}  // namespace wisp::baselines
