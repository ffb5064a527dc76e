#include "sensor/convolution/psf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>

#include "render/vocabulary/clones.h"
#include "sensor/convolution/cubic_weights.h"
#include "sensor/convolution/fourier.h"

namespace hilcam {
namespace {

std::array<double, 4> linear_weights(double u) { return {0, 1 - u, u, 0}; }

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

    copy_core();

    phase_sums_.resize(std::size_t{kOversampling} * kOversampling);
    for (std::size_t p = 0; p < phase_sums_.size(); ++p) {
        const std::span<const float> table =
            std::span(phases_).subspan(p * kField_px * kField_px, std::size_t{kField_px} * kField_px);
        phase_sums_[p] = std::accumulate(table.begin(), table.end(), 0.0);
    }
    outside_.assign(kMaxRadius_px + 1, 0.0);
    const double total = phase_sums_[0];
    const float* centred = phase(0, 0);
    for (int r = 0; r <= kMaxRadius_px; ++r) {
        double inside = 0;
        for (int y = -r; y <= r; ++y)
            for (int x = -r; x <= r; ++x)
                inside += static_cast<double>(centred[(y + kField_px / 2) * kField_px + x + kField_px / 2]);
        outside_[static_cast<std::size_t>(r)] = std::max(0.0, 1 - inside / total);
    }
}

// The middle of each phase, and how far a line between neighbours leaves the curve: an eighth of the second
// difference, along either axis.
void PointSpread::copy_core() {
    constexpr int n = kOversampling;
    core_.resize(std::size_t{n} * n * kCoreSize + 2 * kCoreAcross_px);
    const auto middle = [this](int px, int py, int x, int y) {
        return phase(px, py)[(y + kField_px / 2) * kField_px + x + kField_px / 2];
    };
    const auto fine = [&](int fx, int fy) {  // sixteenths of a pixel from the middle
        return middle((fx + n * n) % n, (fy + n * n) % n, (fx + n * n) / n - n, (fy + n * n) / n - n);
    };
    constexpr int half = kCoreAcross_px / 2;
    for (int py = 0; py < n; ++py)
        for (int px = 0; px < n; ++px)
            for (int y = -half; y < half; ++y)
                for (int x = -half; x < half; ++x) {
                    core_[static_cast<std::size_t>((py * n + px) * kCoreSize + (y + half) * kCoreAcross_px +
                                                   x + half)] = middle(px, py, x, y);
                    const int fx = n * x + px, fy = n * y + py;
                    const float here = 2 * fine(fx, fy);
                    const float across = std::abs(fine(fx - 1, fy) + fine(fx + 1, fy) - here),
                                down = std::abs(fine(fx, fy - 1) + fine(fx, fy + 1) - here);
                    linear_error_ = std::max(linear_error_, static_cast<double>(across + down) / 8);
                }
}

const float* PointSpread::phase(int px, int py) const {
    return phases_.data() + static_cast<std::size_t>(py * kOversampling + px) * kField_px * kField_px;
}

int PointSpread::radius_for(double electrons) const {
    for (int r = kMinRadius_px; r < kMaxRadius_px; ++r)
        if (electrons * outside_[static_cast<std::size_t>(r)] < 0.05) return r;
    return kMaxRadius_px;
}

namespace {

// One of the tables that a point's image is a sum of: where in it the image's corner lies, and its weight.
struct ShiftedTable {
    const float* corner;
    float weight;
};

constexpr std::size_t kMinAcross = 7;  // pixels of the least image; its tables have rows of eight
// Sums the tables, one after the other. Returns the sum over all pixels.
HILCAM_CLONES double sum_least(const ShiftedTable* tables, std::size_t count, float* out) {
    using TwoRows [[gnu::vector_size(64)]] = float;
    std::array<TwoRows, 4> sums{};
    for (std::size_t t = 0; t < count; ++t)
        for (std::size_t i = 0; i < sums.size(); ++i) {
            TwoRows in;
            std::memcpy(&in, tables[t].corner + 16 * i, sizeof(in));
            sums[i] += tables[t].weight * in;
        }
    std::array<float, 64> rows;
    std::memcpy(rows.data(), sums.data(), sizeof(rows));
    std::array<double, 8> columns{};
    for (std::size_t y = 0; y < kMinAcross; ++y) {
        for (std::size_t x = 0; x < columns.size(); ++x) columns[x] += static_cast<double>(rows[8 * y + x]);
        std::memcpy(out + kMinAcross * y, rows.data() + 8 * y, kMinAcross * sizeof(float));
    }
    return std::accumulate(columns.begin(), columns.begin() + kMinAcross, 0.0);
}

double sum_large(std::span<const ShiftedTable> tables, std::size_t pitch, std::size_t size, float* out) {
    std::fill_n(out, size * size, 0.0f);
    for (const ShiftedTable& table : tables)
        for (std::size_t y = 0; y < size; ++y)
            for (std::size_t x = 0; x < size; ++x)
                out[y * size + x] += table.weight * table.corner[y * pitch + x];
    return std::accumulate(out, out + size * size, 0.0);
}

}  // namespace

PointPatch PointSpread::at(double x_px, double y_px, double electrons, Room& room) const {
    const int radius = radius_for(electrons);
    // The pixel that holds the point, and how far that pixel's centre lies from the point, in sixteenths.
    const double cx = std::floor(x_px);
    const double cy = std::floor(y_px);
    const double sx = (cx + 0.5 - x_px) * kOversampling;
    const double sy = (cy + 0.5 - y_px) * kOversampling;
    const int ix = static_cast<int>(std::floor(sx));
    const int iy = static_cast<int>(std::floor(sy));
    const bool least = radius == kMinRadius_px;
    static_assert(kMinAcross == 2 * kMinRadius_px + 1);
    // The cubic's outer samples are lost to sight in faint points.
    const bool linear = least && electrons * linear_error_ < kLinear_e;
    const auto wx = linear ? linear_weights(sx - ix) : cubic_weights(sx - ix);
    const auto wy = linear ? linear_weights(sy - iy) : cubic_weights(sy - iy);
    double whole = 0;  // value of the full field at this place in a pixel

    // All pixels share one sub-pixel phase: the kernel is a sum of shifted tables.
    std::array<ShiftedTable, 16> tables;
    std::size_t count = 0;
    const int from = linear ? 1 : 0, to = linear ? 3 : 4;
    for (int j = from; j < to; ++j)
        for (int i = from; i < to; ++i) {
            const int fx = ix + i - 1;
            const int fy = iy + j - 1;
            // Floor division: a negative sub-pixel distance belongs to the pixel before.
            const int px = (fx % kOversampling + kOversampling) % kOversampling;
            const int py = (fy % kOversampling + kOversampling) % kOversampling;
            const int left = (fx - px) / kOversampling - radius, top = (fy - py) / kOversampling - radius;
            const int number = py * kOversampling + px;
            const auto weight = static_cast<float>(electrons * wx[static_cast<std::size_t>(i)] *
                                                   wy[static_cast<std::size_t>(j)]);
            whole += static_cast<double>(weight) * phase_sums_[static_cast<std::size_t>(number)];
            const float* const corner =
                least ? core_.data() + number * kCoreSize + (top + kCoreAcross_px / 2) * kCoreAcross_px +
                            left + kCoreAcross_px / 2
                      : phase(px, py) + (top + kField_px / 2) * kField_px + left + kField_px / 2;
            tables[count++] = {corner, weight};
        }
    const auto size = static_cast<std::size_t>(2 * radius + 1);
    const double inside = least ? sum_least(tables.data(), count, room.data())
                                : sum_large(tables, kField_px, size, room.data());
    const auto scale = static_cast<float>(inside > 0 ? whole / inside : 0);
    for (float& value : std::span<float>(room).first(size * size)) value *= scale;
    return {static_cast<int>(cx) - radius, static_cast<int>(cy) - radius, static_cast<int>(size),
            room.data()};
}

}  // namespace hilcam
