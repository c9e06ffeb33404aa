#pragma once
// How a channel moves: its power over frequency, its memory over time, and how far two of them are apart.
//
// Source: P. D. Welch, "The use of fast Fourier transform for the estimation of power spectra", IEEE Trans. Audio
// Electroacoust. 15 (1967); A. V. Oppenheim & R. W. Schafer, Discrete-Time Signal Processing, section 10.6.

#include <cstddef>
#include <span>
#include <vector>

namespace wisp {

/// Stretches of consecutive samples of one channel.
using Samples = std::span<const std::vector<double>>;

/// Power spectral density.
struct Spectrum {
  std::vector<double> frequency_hz;  ///< 0 … rate/2
  std::vector<double> power;         ///< one-sided, squared unit per hertz; sums over frequency to the variance
  std::size_t segments = 0;          ///< periodograms averaged
};

/// Welch's estimate: segments of `length` samples that overlap by half, each without its mean and under a Hann window,
/// their periodograms averaged. Segments never cross from one stretch to the next.
/// Returns the spectrum; without power where no stretch has `length` samples.
///
/// Precondition: length is even and >= 2; rate_hz > 0.
Spectrum welch(Samples stretches, double rate_hz, std::size_t length);

/// How two series of one rate move together at a frequency.
struct CrossSpectrum {
  double phase = 0;          ///< of the second after the first, −π to π
  double coherence = 0;      ///< 0 to 1
  std::size_t segments = 0;  ///< averaged: windowed as welch() has them, those with a missing sample left out
};
CrossSpectrum cross_spectrum(std::span<const double> a, std::span<const double> b, double rate_hz, std::size_t length,
                             double frequency_hz);

/// Root mean square over frequency of 10 log10(P/Q), in decibels; the frequency 0 is left out, because segments have
/// had their means removed. Power more than 100 dB below the larger spectrum's peak counts as that, so that a still
/// channel against a still one is 0. NaN where a spectrum has no power estimates.
///
/// Precondition: both have the same frequencies.
double log_spectral_distance(const Spectrum& p, const Spectrum& q);

}  // namespace wisp
