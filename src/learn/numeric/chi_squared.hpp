#pragma once
// The chi-squared distribution, for tests and intervals of variances.
//
// Source: W. Press et al., Numerical Recipes (3rd ed.), section 6.2: the incomplete gamma function by its series below
// the mean and by Lentz's continued fraction above.

namespace wisp {

/// Probability that a chi-squared variable with `freedom` degrees of freedom is above `value`. Absolute error: about
/// 1e-13 up to a thousand degrees of freedom, above in proportion to them (1e-8 for 1e8). Precondition: freedom > 0.
double chi_squared_tail(double value, double freedom);

/// Value below which a chi-squared variable lies with probability `p`. Preconditions: freedom > 0; 0 < p < 1.
double chi_squared_quantile(double p, double freedom);

}  // namespace wisp
