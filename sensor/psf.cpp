#include "sensor/psf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "sensor/convolution/fourier.h"

namespace hilcam {
namespace {

// Keys' cubic convolution weights (a = -1/2) for samples at -1, 0, 1, 2 and position u in [0, 1).
std::array<double, 4> cubic_weights(double u) {
    return {((-0.5 * u + 1.0) * u - 0.5) * u, (1.5 * u - 2.5) * u * u + 1.0, ((-1.5 * u + 2.0) * u + 0.5) * u,
            (0.5 * u - 0.5) * u * u};
}

}  // namespace

PointSpread::PointSpread(const std::function<std::complex<double>(double, double)>& transfer,
                         double fill_factor) {
    constexpr int n = kField_px * kOversampling;
    constexpr int half = n / 2 + 1;
    std::vector<std::complex<float>> spectrum(std::size_t{n} * half);
    std::vector<float> fine(std::size_t{n} * n);
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < half; ++x) {
            const double u = static_cast<double>(x) / kField_px;
            const double v = static_cast<double>(y < n / 2 ? y : y - n) / kField_px;
            const std::complex<double> value = transfer(u, v) * (fill_factor / (kField_px * kField_px));
            // The table runs over where a pixel lies from the point.
            spectrum[static_cast<std::size_t>(y) * half + static_cast<std::size_t>(x)] =
                std::complex<float>(value);
        }
    real_from_half_spectrum(spectrum, n, fine);

    // fine(x) is the share that a pixel takes whose centre lies x/16 px from the point; split by phase.
    phases_.resize(std::size_t{n} * n);
    std::size_t at = 0;
    for (int py = 0; py < kOversampling; ++py)
        for (int px = 0; px < kOversampling; ++px)
            for (int y = 0; y < kField_px; ++y)
                for (int x = 0; x < kField_px; ++x) {
                    // Pixel (x, y) of the field is x - 32 px from the middle; sample 0 of `fine` is distance
                    // 0.
                    const int fx = ((x - kField_px / 2) * kOversampling + px + n) % n;
                    const int fy = ((y - kField_px / 2) * kOversampling + py + n) % n;
                    phases_[at++] = fine[static_cast<std::size_t>(fy) * n + static_cast<std::size_t>(fx)];
                }

    phase_sums_.resize(std::size_t{kOversampling} * kOversampling);
    for (std::size_t p = 0; p < phase_sums_.size(); ++p) {
        const std::span<const float> table =
            std::span(phases_).subspan(p * kField_px * kField_px, std::size_t{kField_px} * kField_px);
        phase_sums_[p] = std::accumulate(table.begin(), table.end(), 0.0);
    }
    outside_.assign(kMostRadius_px + 1, 0.0);
    const double total = phase_sums_[0];
    const float* centred = phase(0, 0);
    for (int r = 0; r <= kMostRadius_px; ++r) {
        double inside = 0;
        for (int y = -r; y <= r; ++y)
            for (int x = -r; x <= r; ++x)
                inside += static_cast<double>(centred[(y + kField_px / 2) * kField_px + x + kField_px / 2]);
        outside_[static_cast<std::size_t>(r)] = std::max(0.0, 1 - inside / total);
    }
}

const float* PointSpread::phase(int px, int py) const {
    return phases_.data() + static_cast<std::size_t>(py * kOversampling + px) * kField_px * kField_px;
}

int PointSpread::radius_for(double electrons) const {
    for (int r = 3; r < kMostRadius_px; ++r)
        if (electrons * outside_[static_cast<std::size_t>(r)] < 0.05) return r;
    return kMostRadius_px;
}

PointPatch PointSpread::at(double x_px, double y_px, double electrons, Room& room) const {
    const int radius = radius_for(electrons);
    // The pixel that holds the point, and how far that pixel's centre lies from the point, in sixteenths.
    const double cx = std::floor(x_px);
    const double cy = std::floor(y_px);
    const double sx = (cx + 0.5 - x_px) * kOversampling;
    const double sy = (cy + 0.5 - y_px) * kOversampling;
    const int ix = static_cast<int>(std::floor(sx));
    const int iy = static_cast<int>(std::floor(sy));
    const auto wx = cubic_weights(sx - ix);
    const auto wy = cubic_weights(sy - iy);
    double whole = 0;  // what the full field would take, at this place in a pixel

    // All pixels share one sub-pixel phase: the kernel is a sum of sixteen shifted tables.
    const int size = 2 * radius + 1;
    std::fill_n(room.begin(), size * size, 0.0f);
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
            const int fx = ix + i - 1;
            const int fy = iy + j - 1;
            // Floor division: a negative sub-pixel distance belongs to the pixel before.
            const int px = (fx % kOversampling + kOversampling) % kOversampling;
            const int py = (fy % kOversampling + kOversampling) % kOversampling;
            const int shift_x = (fx - px) / kOversampling + kField_px / 2 - radius;
            const int shift_y = (fy - py) / kOversampling + kField_px / 2 - radius;
            const auto weight = static_cast<float>(electrons * wx[static_cast<std::size_t>(i)] *
                                                   wy[static_cast<std::size_t>(j)]);
            whole +=
                static_cast<double>(weight) * phase_sums_[static_cast<std::size_t>(py * kOversampling + px)];
            const float* table = phase(px, py);
            for (int y = 0; y < size; ++y) {
                const float* in = table + (y + shift_y) * kField_px + shift_x;
                float* out = room.data() + y * size;
                for (int x = 0; x < size; ++x) out[x] += weight * in[x];
            }
        }
    const std::span<float> used = std::span(room).first(static_cast<std::size_t>(size * size));
    const double inside = std::accumulate(used.begin(), used.end(), 0.0);
    const auto scale = static_cast<float>(inside > 0 ? whole / inside : 0);
    for (float& value : used) value *= scale;
    return {static_cast<int>(cx) - radius, static_cast<int>(cy) - radius, size, room.data()};
}

}  // namespace hilcam
