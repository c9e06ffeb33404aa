#pragma once
// Spectra of channels: power density, coherence and phase, and log-spectral distance.
//
// Source: P. D. Welch, "The use of fast Fourier transform for the estimation of power spectra", IEEE Trans. Audio
// Electroacoust. 15 (1967); A. V. Oppenheim & R. W. Schafer, Discrete-Time Signal Processing, section 10.6.

#include <cstddef>
#include <span>
#include <vector>

namespace wisp {

using Samples = std::span<const std::vector<double>>;

/// All samples, stretch after stretch.
std::vector<double> joined(Samples stretches);

/// Runs of consecutive values that are not NaN.
std::vector<std::vector<double>> whole_stretches(std::span<const double> values);

struct Spectrum {
  std::vector<double> frequency_hz;  ///< 0 … rate/2
  std::vector<double> power;         ///< one-sided, squared unit per hertz; integrates over frequency to the variance
  std::size_t segments = 0;          ///< number of averaged periodograms
};

/// Welch's estimate: the average of periodograms of segments of `length` samples with 50 % overlap, each without its
/// mean and under a Hann window. Segments never cross stretches. Returns the spectrum; without power where no stretch
/// has `length` samples. Precondition: length is even and >= 2; rate_hz > 0.
Spectrum welch(Samples stretches, double rate_hz, std::size_t length);

/// Phase and coherence of two series of equal rate at one frequency.
struct CrossSpectrum {
  double phase = 0;          ///< lag of the second series behind the first, −π to π radians
  double coherence = 0;      ///< magnitude squared, 0 to 1; 1 for a single segment
  std::size_t segments = 0;  ///< number of averaged segments, cut as in welch(); one with a missing sample is skipped
};
CrossSpectrum cross_spectrum(std::span<const double> a, std::span<const double> b, double rate_hz, std::size_t length,
                             double frequency_hz);

/// Root mean square over frequency of 10 log10(P/Q), in decibels, without frequency 0, since segments have their means
/// removed. Power is floored at 100 dB below the larger spectrum's peak, so two constant channels have distance 0. NaN
/// where a spectrum has no power estimates. Precondition: both have the same frequencies.
double log_spectral_distance(const Spectrum& p, const Spectrum& q);

}  // namespace wisp
