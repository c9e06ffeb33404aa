#pragma once
// Inner loops over several series at once: lagged channels are shifted views of the same samples, so a block of them
// stays in the first-level cache while all of its products are computed.

#include <cstddef>
#include <cstring>
#include <span>

namespace wisp {

/// Two doubles, in one 128-bit register where the machine has them (SSE2, NEON, WebAssembly), elsewhere in two.
/// Wider registers are avoided on purpose: a recording must give the same model on every machine.
#ifdef __GNUC__
using Pair = double __attribute__((vector_size(16)));
#else
struct Pair {
  double value[2];

  double operator[](std::size_t k) const { return value[k]; }
  Pair& operator+=(Pair b) { return value[0] += b.value[0], value[1] += b.value[1], *this; }
  friend Pair operator+(Pair a, Pair b) { return a += b; }
  friend Pair operator-(Pair a, Pair b) { return {{a.value[0] - b.value[0], a.value[1] - b.value[1]}}; }
  friend Pair operator*(Pair a, Pair b) { return {{a.value[0] * b.value[0], a.value[1] * b.value[1]}}; }
};
#endif

inline Pair load_pair(const double* from) {
  Pair pair;
  std::memcpy(&pair, from, sizeof pair);
  return pair;
}

inline void store_pair(double* to, Pair pair) { std::memcpy(to, &pair, sizeof pair); }

template <std::size_t kCount>
void add_products_of(const double* x, const double* const* y, std::size_t rows, double* sums) {
  Pair even[kCount] = {};
  std::size_t t = 0;
  for (; t + 2 <= rows; t += 2) {
    const Pair a = load_pair(x + t);
    for (std::size_t s = 0; s < kCount; ++s) even[s] += a * load_pair(y[s] + t);
  }
  for (std::size_t s = 0; s < kCount; ++s) {
    double sum = even[s][0] + even[s][1];
    if (t < rows) sum += x[t] * y[s][t];
    sums[s] += sum;
  }
}

// add_products() for the remaining series, fewer than kMore.
template <std::size_t kMore>
void add_products_of_rest(const double* x, std::span<const double* const> y, std::size_t rows, double* sums) {
  if (y.size() + 1 == kMore) return add_products_of<kMore - 1>(x, y.data(), rows, sums);
  if constexpr (kMore > 2) add_products_of_rest<kMore - 1>(x, y, rows, sums);
}

/// sums[s] += Σ_t x[t]·y[s][t] for every series s.
inline void add_products(const double* x, std::span<const double* const> y, std::size_t rows, double* sums) {
  std::size_t s = 0;
  for (; s + 8 <= y.size(); s += 8) add_products_of<8>(x, y.data() + s, rows, sums + s);
  add_products_of_rest<8>(x, y.subspan(s), rows, sums + s);
}

/// out[t] = start[t] + Σ_s weight[s]·x[s][t].
inline void combine(const double* start, std::span<const double* const> x, std::span<const double> weight,
                    std::size_t rows, double* out) {
  std::size_t t = 0;
  for (; t + 8 <= rows; t += 8) {
    Pair sum[4];
    for (std::size_t k = 0; k < 4; ++k) sum[k] = load_pair(start + t + 2 * k);
    for (std::size_t s = 0; s < x.size(); ++s) {
      const double* series = x[s] + t;
      const Pair w = {weight[s], weight[s]};
      for (std::size_t k = 0; k < 4; ++k) sum[k] += w * load_pair(series + 2 * k);
    }
    for (std::size_t k = 0; k < 4; ++k) store_pair(out + t + 2 * k, sum[k]);
  }
  for (; t < rows; ++t) {
    double sum = start[t];
    for (std::size_t s = 0; s < x.size(); ++s) sum += weight[s] * x[s][t];
    out[t] = sum;
  }
}

}  // namespace wisp
