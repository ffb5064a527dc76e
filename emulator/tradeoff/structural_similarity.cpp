#include "emulator/tradeoff/structural_similarity.h"

#include <array>
#include <cmath>
#include <vector>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr int kWindow_px = 11;

// Returns the weights of the window along one axis; their sum is 1.
std::array<double, kWindow_px> window_weights() {
    constexpr double kSigma_px = 1.5;
    std::array<double, kWindow_px> weights{};
    double sum = 0;
    for (int i = 0; i < kWindow_px; ++i) {
        const double away_px = (i - kWindow_px / 2) / kSigma_px;
        sum += weights[static_cast<std::size_t>(i)] = std::exp(-0.5 * away_px * away_px);
    }
    for (double& weight : weights) weight /= sum;
    return weights;
}

// Values for the pixels of a picture, row by row.
struct Plane {
    int width, height;
    std::vector<double> values;
};

// Returns the product of two pictures, pixel by pixel.
Plane product(const ElectronImage& a, const ElectronImage& b) {
    Plane out{a.width(), a.height(), {}};
    out.values.reserve(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) {
            const auto i = static_cast<std::size_t>(x);
            out.values.push_back(static_cast<double>(a.row(y)[i]) * static_cast<double>(b.row(y)[i]));
        }
    return out;
}

Plane as_doubles(const ElectronImage& image) {
    Plane out{image.width(), image.height(), {}};
    for (int y = 0; y < out.height; ++y)
        for (const float value : image.row(y)) out.values.push_back(static_cast<double>(value));
    return out;
}

// Returns the window's means along each row, where the window fits, with rows and columns exchanged. Applied
// twice, this gives the mean over the whole window.
Plane means_along_rows(const Plane& in) {
    static const std::array<double, kWindow_px> kWeights = window_weights();
    Plane out{in.height, in.width - kWindow_px + 1, {}};
    out.values.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
    for (std::size_t y = 0; y < static_cast<std::size_t>(in.height); ++y)
        for (std::size_t x = 0; x < static_cast<std::size_t>(out.height); ++x) {
            double mean = 0;
            for (std::size_t k = 0; k < kWeights.size(); ++k)
                mean += kWeights[k] * in.values[y * static_cast<std::size_t>(in.width) + x + k];
            out.values[x * static_cast<std::size_t>(out.width) + y] = mean;
        }
    return out;
}

std::vector<double> windowed(const Plane& plane) { return means_along_rows(means_along_rows(plane)).values; }

}  // namespace

std::optional<double> structural_similarity(const ElectronImage& a, const ElectronImage& b, double range_e) {
    HILCAM_CHECK(a.width() == b.width() && a.height() == b.height());
    if (a.width() < kWindow_px || a.height() < kWindow_px) return std::nullopt;
    const double c1 = 1e-4 * range_e * range_e, c2 = 9e-4 * range_e * range_e;
    const std::vector<double> mean_a = windowed(as_doubles(a)), mean_b = windowed(as_doubles(b));
    const std::vector<double> aa = windowed(product(a, a)), bb = windowed(product(b, b)),
                              ab = windowed(product(a, b));
    double sum = 0;
    for (std::size_t i = 0; i < mean_a.size(); ++i) {
        const double m_aa = mean_a[i] * mean_a[i], m_bb = mean_b[i] * mean_b[i], m_ab = mean_a[i] * mean_b[i];
        const double variances = aa[i] - m_aa + bb[i] - m_bb, covariance = ab[i] - m_ab;
        sum += (2 * m_ab + c1) * (2 * covariance + c2) / ((m_aa + m_bb + c1) * (variances + c2));
    }
    return sum / static_cast<double>(mean_a.size());
}

}  // namespace hilcam
