#pragma once
// Linear least squares with a few coefficients and known variances of the data.

#include <span>
#include <vector>

namespace hilcam {

struct Fitted {
    std::vector<double> coefficient;
    std::vector<double> covariance;  // size x size, from the data's variances

    double variance(std::size_t i) const { return covariance[i * coefficient.size() + i]; }
};

// Minimises sum w_i (y_i - sum_j c_j b_ij)^2. basis: a row of `coefficients` values b_ij for each y_i.
// variance: that of each y_i, used for the covariance alone; weights need not be its inverse. HILCAM_CHECK:
// sizes must agree. Throws InputError when the data do not determine the coefficients.
Fitted fit_linear(std::span<const double> basis, std::span<const double> y, std::span<const double> weight,
                  std::span<const double> variance);

// Fits c0 + c1 x + ... + c_degree x^degree; without_constant leaves out c0 (coefficient[0] is then c1).
Fitted fit_polynomial(std::span<const double> x, std::span<const double> y, std::span<const double> weight,
                      std::span<const double> variance, int degree, bool without_constant = false);

}  // namespace hilcam
