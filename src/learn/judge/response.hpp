#pragma once
// Responses of an ARX model: poles, zeros, step and frequency response, with confidence bands.
//
// Source: L. Ljung, System Identification (2nd ed.), sections 2.1–2.3 (impulse and frequency response) and 9.4 (Gauss'
// approximation formula: covariance of a function of the coefficients from theirs and from the function's gradient).

#include <complex>
#include <span>
#include <vector>

#include "wisp/model/arx.hpp"

namespace wisp {

/// Poles in the z plane: eigenvalues of the companion matrix, largest magnitude first. Their number follows from the
/// orders; poles at 0 come last.
std::vector<std::complex<double>> poles(const ArxModel& model);

/// Zeros in the z plane of the transfer function from `input` to `output`, largest first; a delay adds none.
///
/// Preconditions: 0 <= input < inputs; 0 <= output < outputs.
std::vector<std::complex<double>> zeros(const ArxModel& model, int output, int input);

/// A step response with its standard deviation. The 95 % band is ±1.96 sd.
struct StepResponse {
  std::vector<double> value;  ///< output after 0, 1, 2, … samples, for an input that steps from 0 to 1 at 0
  std::vector<double> sd;     ///< standard deviation; empty without a covariance
};

/// Response of `output` to a unit step of `input` over `samples` samples. `covariance` is ArxFit's, or empty.
///
/// Preconditions: indices in range; samples >= 0; covariance empty or d_total × d_total.
StepResponse step_response(const ArxModel& model, int output, int input, int samples,
                           std::span<const double> covariance = {});

struct FrequencyResponse {
  std::vector<std::complex<double>> value;  ///< G(e^{iω})
  std::vector<double> amplitude_sd;         ///< standard deviation of |G|; empty without a covariance
  std::vector<double> phase_sd;             ///< standard deviation of arg G, radians; empty without a covariance
};

/// G(e^{iω}) from `input` to `output` at angular frequencies ω in radians per sample (0 … π; multiplied by the rate:
/// radians per second). Preconditions: as step_response.
FrequencyResponse frequency_response(const ArxModel& model, int output, int input, std::span<const double> omega,
                                     std::span<const double> covariance = {});

}  // namespace wisp
