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
    phases_.resize(std::size_t{n} * n + kField_px);
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
    make_least();
}

namespace {

// A distance in sixteenths of a pixel: the phase that has it, and by how many pixels that is shifted.
struct Shift {
    int phase, pixels;
};
Shift shift_of(int sixteenths) { return {sixteenths & 15, sixteenths >> 4}; }

}  // namespace

// The least image at each place, and how far a line between neighbours leaves the curve: an eighth of the second
// difference, along either axis.
void PointSpread::make_least() {
    const auto value = [this](int x, int y, int px, int py) {  // place; pixel from the middle one
        const Shift sx = shift_of(x), sy = shift_of(y);
        return phase(sx.phase,
                     sy.phase)[(py + sy.pixels + kField_px / 2) * kField_px + px + sx.pixels + kField_px / 2];
    };
    least_.resize(std::size_t{kPlacesAcross} * kPlacesAcross * kLeastSize);
    float* out = least_.data();
    for (int y = -kPlaces; y <= kPlaces; ++y)
        for (int x = -kPlaces; x <= kPlaces; ++x, out += kLeastSize) {
            double inside = 0;
            for (int py = -kMinRadius_px; py <= kMinRadius_px; ++py)
                for (int px = -kMinRadius_px; px <= kMinRadius_px; ++px) {
                    const float here = value(x, y, px, py);
                    inside += static_cast<double>(here);
                    out[(py + kMinRadius_px) * kLeastPitch_px + px + kMinRadius_px] = here;
                    const float across = value(x - 1, y, px, py) + value(x + 1, y, px, py) - 2 * here,
                                down = value(x, y - 1, px, py) + value(x, y + 1, px, py) - 2 * here;
                    linear_error_ =
                        std::max(linear_error_, static_cast<double>(std::abs(across) + std::abs(down)) / 8);
                }
            const Shift sx = shift_of(x), sy = shift_of(y);
            const double whole = phase_sums_[static_cast<std::size_t>(sy.phase * kOversampling + sx.phase)];
            const auto scale = static_cast<float>(inside > 0 ? whole / inside : 0);
            for (float& pixel : std::span(out, kLeastSize)) pixel *= scale;
        }
}

const float* PointSpread::least_table(int x, int y) const {
    return least_.data() + ((y + kPlaces) * kPlacesAcross + x + kPlaces) * kLeastSize;
}

const float* PointSpread::phase(int px, int py) const {
    return phases_.data() + static_cast<std::size_t>(py * kOversampling + px) * kField_px * kField_px;
}

int PointSpread::radius_for(double electrons) const {
    for (int r = kMinRadius_px; r < kMaxRadius_px; ++r)
        if (electrons * outside_[static_cast<std::size_t>(r)] < kOutside_e) return r;
    return kMaxRadius_px;
}

namespace {

// One of the tables that a point's image is a sum of: where in it the image's corner lies, and its weight.
struct ShiftedTable {
    const float* corner;
    float weight;
};

constexpr std::size_t kTogether = 8;

using TwoRows [[gnu::vector_size(64)]] = float;  // of a least image's table
using LeastImage = std::array<TwoRows, 4>;

[[gnu::always_inline]] inline void sum_least(const ShiftedTable* tables, std::size_t count,
                                             LeastImage& sums) {
    sums = {};
    for (std::size_t t = 0; t < count; ++t)
        for (std::size_t i = 0; i < sums.size(); ++i) {
            TwoRows in;
            std::memcpy(&in, tables[t].corner + 16 * i, sizeof(in));
            sums[i] += tables[t].weight * in;
        }
}

HILCAM_CLONES void copy_least(const ShiftedTable* tables, std::size_t count, float* out) {
    LeastImage sums;
    sum_least(tables, count, sums);
    std::memcpy(out, sums.data(), sizeof(sums));
}

// Adds rows of eight pixels, first to end of the image's; out: where its first pixel is, or would be.
HILCAM_CLONES void add_least(const ShiftedTable* tables, std::size_t count, std::ptrdiff_t first,
                             std::ptrdiff_t end, float* out, std::ptrdiff_t pitch) {
    LeastImage sums;
    sum_least(tables, count, sums);
    std::array<float, 64> rows;
    std::memcpy(rows.data(), sums.data(), sizeof(rows));
    for (std::ptrdiff_t y = first; y < end; ++y)
        for (std::ptrdiff_t x = 0; x < 8; ++x)
            out[y * pitch + x] += rows[static_cast<std::size_t>(8 * y + x)];
}

// Rows of a table are pitch_in apart, those of the image pitch.
struct Rows {
    std::size_t pitch_in, size, pitch;
};
// Sums the tables to a larger image. Returns the sum over all its pixels.
HILCAM_CLONES double sum_large(const ShiftedTable* tables, std::size_t count, Rows rows, float* out) {
    const auto [pitch_in, size, pitch] = rows;
    using Eight [[gnu::vector_size(32)]] = float;
    std::array<double, kTogether> columns{};
    for (std::size_t y = 0; y < size; ++y, out += pitch) {
        for (std::size_t x = 0; x < pitch; x += kTogether) {
            Eight sum{};
            for (std::size_t t = 0; t < count; ++t) {
                Eight in;
                std::memcpy(&in, tables[t].corner + y * pitch_in + x, sizeof(in));
                sum += tables[t].weight * in;
            }
            std::memcpy(out + x, &sum, sizeof(sum));
        }
        std::fill(out + size, out + pitch, 0.0f);
        for (std::size_t x = 0; x < pitch; x += kTogether)
            for (std::size_t i = 0; i < kTogether; ++i) columns[i] += static_cast<double>(out[x + i]);
    }
    return std::accumulate(columns.begin(), columns.end(), 0.0);
}

}  // namespace

// A point's place: the pixel that holds it, and how far that pixel's centre lies from the point, in sixteenths.
struct PointSpread::Place {
    int x_px, y_px, x, y;
    double beyond_x, beyond_y;  // the rest

    Place(double at_x_px, double at_y_px) {
        const double cx = std::floor(at_x_px), cy = std::floor(at_y_px);
        const double sx = (cx + 0.5 - at_x_px) * kOversampling, sy = (cy + 0.5 - at_y_px) * kOversampling;
        x = static_cast<int>(std::floor(sx)), y = static_cast<int>(std::floor(sy));
        x_px = static_cast<int>(cx), y_px = static_cast<int>(cy);
        beyond_x = sx - x, beyond_y = sy - y;
    }
};

PointPatch PointSpread::at(double x_px, double y_px, double electrons, Room& room) const {
    static_assert(kOversampling == 16);
    const int radius = radius_for(electrons);
    const Place place(x_px, y_px);
    if (radius > kMinRadius_px) return large(place, radius, electrons, room);
    // The cubic's outer samples are lost to sight in faint points.
    if (electrons * linear_error_ < kLinear_e) {
        const double u = place.beyond_x, v = place.beyond_y;
        return least(place, std::array{1 - u, u}, std::array{1 - v, v}, electrons, room);
    }
    return least(place, cubic_weights(place.beyond_x), cubic_weights(place.beyond_y), electrons, room);
}

bool PointSpread::add_faint(double x_px, double y_px, double electrons, const PictureWindow& window) const {
    if (!(electrons * outside_[kMinRadius_px] < kOutside_e && electrons * linear_error_ < kLinear_e))
        return false;
    const Place place(x_px, y_px);
    const int left = place.x_px - kMinRadius_px, top = place.y_px - kMinRadius_px;
    if (left < window.first_x || left + kLeastPitch_px > window.end_x) return false;
    const int first = std::max(0, window.first_y - top), end = std::min(kLeastAcross_px, window.end_y - top);
    if (first >= end) return true;
    const double u = place.beyond_x, v = place.beyond_y;
    const auto weight = [&](double across, double down) {
        return static_cast<float>(electrons * across * down);
    };
    const float* table = least_table(place.x, place.y);
    constexpr int kBelow = kPlacesAcross * kLeastSize;
    const std::array<ShiftedTable, 4> tables{{{table, weight(1 - u, 1 - v)},
                                              {table + kLeastSize, weight(u, 1 - v)},
                                              {table + kBelow, weight(1 - u, v)},
                                              {table + kBelow + kLeastSize, weight(u, v)}}};
    add_least(tables.data(), tables.size(), first, end, window.origin + top * window.pitch + left,
              window.pitch);
    return true;
}

// The image is a sum of those at the places around. weights: of two, or of four about those.
template <std::size_t kSamples>
PointPatch PointSpread::least(const Place& place, const std::array<double, kSamples>& x_weights,
                              const std::array<double, kSamples>& y_weights, double electrons,
                              Room& room) const {
    constexpr int first = 1 - static_cast<int>(kSamples) / 2;
    std::array<ShiftedTable, kSamples * kSamples> tables;
    for (std::size_t j = 0; j < kSamples; ++j)
        for (std::size_t i = 0; i < kSamples; ++i)
            tables[kSamples * j + i] = {
                least_table(place.x + first + static_cast<int>(i), place.y + first + static_cast<int>(j)),
                static_cast<float>(electrons * x_weights[i] * y_weights[j])};
    copy_least(tables.data(), tables.size(), room.data());
    return {place.x_px - kMinRadius_px, place.y_px - kMinRadius_px, kLeastAcross_px, kLeastPitch_px,
            room.data()};
}

PointPatch PointSpread::large(const Place& place, int radius, double electrons, Room& room) const {
    const std::array<double, 4> x_weights = cubic_weights(place.beyond_x),
                                y_weights = cubic_weights(place.beyond_y);
    std::array<ShiftedTable, 16> tables;
    double whole = 0;
    for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t i = 0; i < 4; ++i) {
            const Shift x = shift_of(place.x - 1 + static_cast<int>(i)),
                        y = shift_of(place.y - 1 + static_cast<int>(j));
            const double weight = electrons * x_weights[i] * y_weights[j];
            whole += weight * phase_sums_[static_cast<std::size_t>(y.phase * kOversampling + x.phase)];
            const int middle = kField_px / 2 - radius;
            tables[4 * j + i] = {
                phase(x.phase, y.phase) + (y.pixels + middle) * kField_px + x.pixels + middle,
                static_cast<float>(weight)};
        }
    const auto size = static_cast<std::size_t>(2 * radius + 1),
               pitch = (size + kTogether - 1) / kTogether * kTogether;
    const double inside = sum_large(tables.data(), tables.size(), {kField_px, size, pitch}, room.data());
    const auto scale = static_cast<float>(inside > 0 ? whole / inside : 0);
    for (float& value : std::span<float>(room).first(size * pitch)) value *= scale;
    return {place.x_px - radius, place.y_px - radius, static_cast<int>(size), static_cast<int>(pitch),
            room.data()};
}

}  // namespace hilcam
