#pragma once
// The filters that sound passes on its way to the wind level, and their design.

#include <vector>

namespace wisp::wind {

/// Coefficients of one second-order section without its gain: H(z) = gain · (1 + n1 z⁻¹ + n2 z⁻²)/(1 + a1 z⁻¹ + a2
/// z⁻²). The gain is applied once to what comes of the band (a power), not to every sample.
struct Section {
  float n1 = 0;
  float a1 = 0;
  float a2 = 0;
  double gain = 1;
};

/// Sections by the bilinear transform (R. Bristow-Johnson, Cookbook formulae for audio equalizer biquad filters).
/// All numbers come from + − × ÷ and square root, so that designs are the same bits everywhere.
///
/// Precondition: 0 < frequency_hz < rate_hz / 2, q > 0.
Section high_pass(double frequency_hz, double q, double rate_hz);
Section low_pass(double frequency_hz, double q, double rate_hz);
Section band_pass(double frequency_hz, double q, double rate_hz);

/// A low-pass of odd symmetry about its middle tap: windowed sinc (Hamming) with gain 1 at 0 Hz.
///
/// Precondition: taps >= 1, 0 < cutoff < 0.5 (share of the sample rate).
std::vector<float> windowed_sinc(int taps, double cutoff);

/// 1 − e^(−steps / time constant): how far an exponential average moves in one step.
double approach(double step_seconds, double constant_seconds);

/// Two delays of a section (direct form II).
template <class T>
struct SectionState {
  T d1 = T(0.0F);
  T d2 = T(0.0F);
};

/// The section's recursion; what follows takes the wanted zeros from it.
template <class T>
inline T recurse(const Section& s, const SectionState<T>& state, T x) {
  return x - T(s.a1) * state.d1 - T(s.a2) * state.d2;
}

template <class T>
inline void shift(SectionState<T>& state, T w) {
  state.d2 = state.d1;
  state.d1 = w;
}

/// High-pass: zeros 1 − 2 z⁻¹ + z⁻².
template <class T>
inline T pass_high(const Section& s, SectionState<T>& state, T x) {
  const T w = recurse(s, state, x);
  const T y = (w - state.d1) - (state.d1 - state.d2);
  shift(state, w);
  return y;
}

/// Low-pass: zeros 1 + 2 z⁻¹ + z⁻².
template <class T>
inline T pass_low(const Section& s, SectionState<T>& state, T x) {
  const T w = recurse(s, state, x);
  const T y = (w + state.d1) + (state.d1 + state.d2);
  shift(state, w);
  return y;
}

/// Band-pass: zeros 1 − z⁻².
template <class T>
inline T pass_band(const Section& s, SectionState<T>& state, T x) {
  const T w = recurse(s, state, x);
  const T y = w - state.d2;
  shift(state, w);
  return y;
}

}  // namespace wisp::wind
