#include "sensor/measure/least_squares.h"

#include <cmath>
#include <cstddef>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// Inverts a symmetric positive definite matrix by Cholesky's method, after scaling it to a unit diagonal.
std::vector<double> inverse(std::vector<double> a, std::size_t n) {
    std::vector<double> scale(n), lower(n * n, 0.0), out(n * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) scale[i] = a[i * n + i] > 0 ? 1 / std::sqrt(a[i * n + i]) : 0;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = a[i * n + j] * scale[i] * scale[j];
            for (std::size_t k = 0; k < j; ++k) sum -= lower[i * n + k] * lower[j * n + k];
            if (i == j && !(sum > 1e-13)) throw InputError("a fit has fewer data than coefficients");
            lower[i * n + j] = i == j ? std::sqrt(sum) : sum / lower[j * n + j];
        }
    // Solves L L^T x = e column by column.
    for (std::size_t column = 0; column < n; ++column) {
        std::vector<double> x(n, 0.0);
        for (std::size_t i = 0; i < n; ++i) {
            double sum = i == column ? 1 : 0;
            for (std::size_t k = 0; k < i; ++k) sum -= lower[i * n + k] * x[k];
            x[i] = sum / lower[i * n + i];
        }
        for (std::size_t i = n; i-- > 0;) {
            for (std::size_t k = i + 1; k < n; ++k) x[i] -= lower[k * n + i] * x[k];
            x[i] /= lower[i * n + i];
        }
        for (std::size_t i = 0; i < n; ++i) out[i * n + column] = x[i] * scale[i] * scale[column];
    }
    return out;
}

}  // namespace

Fitted fit_linear(std::span<const double> basis, std::span<const double> y, std::span<const double> weight,
                  std::span<const double> variance) {
    const std::size_t rows = y.size();
    if (rows == 0) throw InputError("a fit has fewer data than coefficients");
    const std::size_t n = basis.size() / rows;
    HILCAM_CHECK(basis.size() == rows * n && weight.size() == rows && variance.size() == rows);
    std::vector<double> normal(n * n, 0.0), right(n, 0.0), spread(n * n, 0.0);
    for (std::size_t r = 0; r < rows; ++r)
        for (std::size_t i = 0; i < n; ++i) {
            const double wb = weight[r] * basis[r * n + i];
            right[i] += wb * y[r];
            for (std::size_t j = 0; j < n; ++j) {
                normal[i * n + j] += wb * basis[r * n + j];
                spread[i * n + j] += wb * weight[r] * basis[r * n + j] * variance[r];
            }
        }
    const std::vector<double> inverted = inverse(normal, n);
    Fitted out;
    out.coefficient.assign(n, 0.0);
    out.covariance.assign(n * n, 0.0);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) {
            out.coefficient[i] += inverted[i * n + j] * right[j];
            for (std::size_t k = 0; k < n; ++k)
                for (std::size_t l = 0; l < n; ++l)
                    out.covariance[i * n + j] +=
                        inverted[i * n + k] * spread[k * n + l] * inverted[l * n + j];
        }
    return out;
}

Fitted fit_polynomial(std::span<const double> x, std::span<const double> y, std::span<const double> weight,
                      std::span<const double> variance, int degree, bool without_constant) {
    std::vector<double> basis;
    for (const double value : x)
        for (int power = without_constant ? 1 : 0; power <= degree; ++power)
            basis.push_back(std::pow(value, power));
    return fit_linear(basis, y, weight, variance);
}

}  // namespace hilcam
