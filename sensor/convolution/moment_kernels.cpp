#include "sensor/convolution/moment_kernels.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/clones.h"
#include "render/vocabulary/units.h"
#include "sensor/convolution/cubic_weights.h"
#include "sensor/convolution/fourier.h"
#include "sensor/convolution/moment_rows.h"

namespace hilcam {
namespace {

constexpr double kQuarter_px = 0.25;

// Nodes and weights on -1/2 .. 1/2 (Gauss and Legendre; Abramowitz & Stegun 1964, table 25.4). A smear is a
// mean over them; for lengths up to those of nodes_of(), its modulation is right to 2e-3 up to half a cycle
// per pixel.
struct Node {
    double at, weight;
};
constexpr Node kOne[] = {{0, 1}};
constexpr Node kTwo[] = {{-0.2886751346, 0.5}, {0.2886751346, 0.5}};
constexpr Node kThree[] = {{-0.3872983346, 5.0 / 18}, {0, 8.0 / 18}, {0.3872983346, 5.0 / 18}};
constexpr Node kFive[] = {{-0.4530899230, 0.1184634425},
                          {-0.2692346551, 0.2393143352},
                          {0, 0.2844444444},
                          {0.2692346551, 0.2393143352},
                          {0.4530899230, 0.1184634425}};
constexpr double kMaxSmear_px = 3.1;
std::span<const Node> nodes_of(double smear_px) {
    if (smear_px <= 0.02) return kOne;
    if (smear_px <= 0.5) return kTwo;
    if (smear_px <= 1.2) return kThree;
    return kFive;
}
// The same for a Gaussian with standard deviation 1 (Gauss and Hermite, table 25.10).
constexpr Node kGaussian[] = {{-1.7320508076, 1.0 / 6}, {0, 2.0 / 3}, {1.7320508076, 1.0 / 6}};
constexpr double kMaxSigma_px = 0.7;
std::span<const Node> gaussian_nodes(double sigma_px) {
    return sigma_px > 0 ? std::span<const Node>(kGaussian) : std::span<const Node>(kOne);
}

bool same(const FrameBlur& a, const FrameBlur& b) {
    return a.smear_px.x == b.smear_px.x && a.smear_px.y == b.smear_px.y && a.sigma_px.x == b.sigma_px.x &&
           a.sigma_px.y == b.sigma_px.y;
}

constexpr int kFinePerPx = 8, kField_px = 32, kFine = kField_px * kFinePerPx;

std::vector<float> image_of_point(const Transfer& transfer) {
    constexpr int half = kFine / 2 + 1;
    std::vector<std::complex<float>> spectrum(std::size_t{kFine} * half);
    for (int y = 0; y < kFine; ++y)
        for (int x = 0; x < half; ++x) {
            const double u = static_cast<double>(x) / kField_px;
            const double v = static_cast<double>(y < kFine / 2 ? y : y - kFine) / kField_px;
            if (u > 1 || std::abs(v) > 1) continue;
            spectrum[static_cast<std::size_t>(y * half + x)] =
                std::complex<float>(transfer(u, v) / (1.0 * kField_px * kField_px));
        }
    std::vector<float> image(std::size_t{kFine} * kFine);
    real_from_half_spectrum(spectrum, kFine, image);
    return image;
}

double value_at(const std::vector<float>& image, double x_px, double y_px) {
    const double x = x_px * kFinePerPx, y = y_px * kFinePerPx;
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    const std::array<double, 4> wx = cubic_weights(x - x0), wy = cubic_weights(y - y0);
    const auto wrapped = [](int at) { return static_cast<std::size_t>((at + kFine) % kFine); };
    double sum = 0;
    for (int j = 0; j < 4; ++j) {
        const float* row = &image[wrapped(y0 - 1 + j) * kFine];
        double along = 0;
        for (int i = 0; i < 4; ++i)
            along += wx[static_cast<std::size_t>(i)] * static_cast<double>(row[wrapped(x0 - 1 + i)]);
        sum += wy[static_cast<std::size_t>(j)] * along;
    }
    return sum;
}

constexpr int kRowsAtOnce = 2;
static_assert(MomentKernels::kBlock_px == kSubpixelBlock_px);

HILCAM_CLONES bool any_lit(const float* row, std::size_t count) {
    std::uint32_t lit = 0;
    for (std::size_t x = 0; x < count; ++x) lit |= row[x] != 0 ? 1u : 0u;
    return lit != 0;
}

}  // namespace

std::complex<double> smooth_transfer(const Transfer& fine, double u, double v) {
    // A frequency that others alias to, with the effect on it of the centres of the two halves and of their
    // smooth difference.
    struct Folded {
        std::array<double, 3> frequency, factor;
    };
    const auto folded_to = [](double f) {
        const double slope = 2 * (static_cast<double>(kNextWeight) * std::sin(2 * kPi * f) +
                                  static_cast<double>(kSecondWeight) * std::sin(4 * kPi * f));
        Folded out;
        for (std::size_t i = 0; i < 3; ++i) {
            out.frequency[i] = f + static_cast<double>(i) - 1;
            const double turn_rad = 2 * kPi * kQuarter_px * out.frequency[i];
            out.factor[i] = std::cos(turn_rad) + slope * std::sin(turn_rad);
        }
        return out;
    };
    const Folded across = folded_to(u), down = folded_to(v);
    std::complex<double> sum = 0;
    for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 3; ++i)
            if (std::abs(across.frequency[i]) <= 1 && std::abs(down.frequency[j]) <= 1)
                sum += across.factor[i] * down.factor[j] * fine(across.frequency[i], down.frequency[j]);
    return sum;
}

MomentKernels::MomentKernels(const Transfer& fine) : point_(image_of_point(fine)) {
    reach_px_ = kMaxReach_px;
    make_weights({});
    still_reach_px_ = 1;
    while (still_reach_px_ < kMaxReach_px && rest_beyond(still_reach_px_) > kMaxRest) ++still_reach_px_;
    reach_px_ = still_reach_px_;
    make_weights({});
}

bool MomentKernels::prepare(const FrameBlur& blur) {
    const double smear_px = std::hypot(blur.smear_px.x, blur.smear_px.y);
    const int more_px = static_cast<int>(std::ceil(smear_px / 2 - 0.1));
    if (smear_px > kMaxSmear_px || std::max(blur.sigma_px.x, blur.sigma_px.y) > kMaxSigma_px) return false;
    if (same(blur, prepared_)) return true;
    reach_px_ = std::min(still_reach_px_ + more_px, kMaxReach_px);
    make_weights(blur);
    return true;
}

void MomentKernels::make_weights(const FrameBlur& blur) {
    prepared_.smear_px = blur.smear_px, prepared_.sigma_px = blur.sigma_px;
    const std::span<const Node> smears = nodes_of(std::hypot(blur.smear_px.x, blur.smear_px.y)),
                                across = gaussian_nodes(blur.sigma_px.x),
                                down = gaussian_nodes(blur.sigma_px.y);
    const auto blurred = [&](double x, double y) {
        double sum = 0;
        for (const Node& smear : smears)
            for (const Node& gx : across)
                for (const Node& gy : down)
                    sum += smear.weight * gx.weight * gy.weight *
                           value_at(point_, x - smear.at * blur.smear_px.x - gx.at * blur.sigma_px.x,
                                    y - smear.at * blur.smear_px.y - gy.at * blur.sigma_px.y);
        return sum;
    };
    std::array<double, kParts> sums{};
    for (int y = -reach_px_; y <= reach_px_; ++y)
        for (int x = -reach_px_; x <= reach_px_; ++x) {
            const double upper_left = blurred(x + kQuarter_px, y + kQuarter_px),
                         upper_right = blurred(x - kQuarter_px, y + kQuarter_px),
                         lower_left = blurred(x + kQuarter_px, y - kQuarter_px),
                         lower_right = blurred(x - kQuarter_px, y - kQuarter_px);
            const std::array<double, kParts> of{(upper_right + lower_right - upper_left - lower_left) / 4,
                                                (lower_left + lower_right - upper_left - upper_right) / 4,
                                                (upper_left + lower_right - upper_right - lower_left) / 4};
            for (std::size_t part = 0; part < kParts; ++part) {
                weights_[part][index_of(x, y)] = static_cast<float>(of[part]);
                sums[part] += of[part];
            }
        }
    // The weights of each kernel add up to zero, because light only moves.
    for (std::size_t part = 0; part < kParts; ++part)
        weights_[part][index_of(0, 0)] -= static_cast<float>(sums[part]);
}

float MomentKernels::weight(std::size_t part, int x, int y) const { return weights_[part][index_of(x, y)]; }

// Returns the largest sum, over the kernels, of absolute weights beyond that reach.
double MomentKernels::rest_beyond(int reach_px) const {
    double most = 0;
    for (std::size_t part = 0; part < kParts; ++part) {
        double sum = 0;
        for (int y = -kMaxReach_px; y <= kMaxReach_px; ++y)
            for (int x = -kMaxReach_px; x <= kMaxReach_px; ++x)
                if (std::max(std::abs(x), std::abs(y)) > reach_px)
                    sum += std::abs(static_cast<double>(weight(part, x, y)));
        most = std::max(most, sum);
    }
    return most;
}

void MomentKernels::add(const Parts& parts, int columns, int rows, float* out, std::size_t stride) const {
    const int taps = 2 * reach_px_ + 1, skipped = kMaxReach_px - reach_px_;
    std::array<std::uint8_t, kSide_px> lit;
    std::array<std::array<float, kBlock_px>, kRowsAtOnce> sums;
    for (std::size_t part = 0; part < kParts; ++part) {
        const float* const all = parts[part].data();
        for (std::size_t j = 0; j < kSide_px; ++j) lit[j] = any_lit(all + j * kSide_px, kSide_px);
        // A pixel receives light from (i, j) relative to it by the weight at (-i, -j).
        const float* const last = &weights_[part][index_of(reach_px_, reach_px_)];
        for (int y = 0; y < rows; y += kRowsAtOnce) {
            const int first = y + skipped;
            sum_moment_rows(
                {all + first * kSide_px + skipped, kSide_px, lit.data() + first, last, kAcross, taps},
                sums[0].data());
            for (int row = y; row < std::min(y + kRowsAtOnce, rows); ++row) {
                float* const to = out + static_cast<std::size_t>(row) * stride;
                for (int x = 0; x < columns; ++x)
                    to[x] += sums[static_cast<std::size_t>(row - y)][static_cast<std::size_t>(x)];
            }
        }
    }
}

}  // namespace hilcam
