#include "sensor/convolution/psf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "sensor/convolution/cubic_weights.h"
#include "sensor/convolution/fourier.h"

namespace hilcam {

PointSpread::PointSpread(const std::function<std::complex<double>(double, double)>& transfer,
                         double fill_factor)
    : fill_factor_(fill_factor) {
    constexpr int n = kField_px * kOversampling;
    constexpr int half = n / 2 + 1;
    std::vector<std::complex<float>> spectrum(std::size_t{n} * half);
    std::vector<float> fine(std::size_t{n} * n);
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < half; ++x) {
            const double u = static_cast<double>(x) / kField_px;
            const double v = static_cast<double>(y < n / 2 ? y : y - n) / kField_px;
            const std::complex<double> value = transfer(u, v) * (fill_factor / (kField_px * kField_px));
            // The table is indexed by the vector from the point to a pixel.
            spectrum[static_cast<std::size_t>(y) * half + static_cast<std::size_t>(x)] =
                std::complex<float>(value);
        }
    real_from_half_spectrum(spectrum, n, fine);

    // fine(x) is the share of a pixel with its centre x/16 px from the point; it is split by phase.
    phases_.resize(std::size_t{n} * n + kField_px);
    std::size_t at = 0;
    for (int py = 0; py < kOversampling; ++py)
        for (int px = 0; px < kOversampling; ++px)
            for (int y = 0; y < kField_px; ++y)
                for (int x = 0; x < kField_px; ++x) {
                    // Pixel (x, y) of the field is x - 32 px from the middle; sample 0 of `fine` is at
                    // distance 0.
                    const int fx = ((x - kField_px / 2) * kOversampling + px + n) % n;
                    const int fy = ((y - kField_px / 2) * kOversampling + py + n) % n;
                    phases_[at++] = fine[static_cast<std::size_t>(fy) * n + static_cast<std::size_t>(fx)];
                }

    sum_up();
}

PointSpread PointSpread::less(const std::function<double(double, double)>& taken_off) const {
    PointSpread out = *this;
    float* value = out.phases_.data();
    const auto place_px = [](int pixel, int phase) {
        return pixel - kField_px / 2 + static_cast<double>(phase) / kOversampling;
    };
    for (int py = 0; py < kOversampling; ++py)
        for (int px = 0; px < kOversampling; ++px)
            for (int y = 0; y < kField_px; ++y)
                for (int x = 0; x < kField_px; ++x)
                    *value++ -=
                        static_cast<float>(fill_factor_ * taken_off(place_px(x, px), place_px(y, py)));
    out.sum_up();
    return out;
}

void PointSpread::sum_up() {
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
    find_linear_errors();
    make_places();
}

namespace {

// A distance in sixteenths of a pixel, as a phase and a shift by whole pixels.
struct Shift {
    int phase, pixels;
};
Shift shift_of(int sixteenths) { return {sixteenths & 15, sixteenths >> 4}; }

}  // namespace

// Returns the value for a pixel relative to the middle one, at that distance of the middle pixel's centre
// from the point.
float PointSpread::value(int x, int y, int px, int py) const {
    const Shift sx = shift_of(x), sy = shift_of(y);
    return phase(sx.phase,
                 sy.phase)[(py + sy.pixels + kField_px / 2) * kField_px + px + sx.pixels + kField_px / 2];
}

// Computes the error of linear interpolation: an eighth of the second difference along each axis.
void PointSpread::find_linear_errors() {
    linear_errors_.assign(kMaxRadius_px + 1, 0.0);
    for (int y = 0; y < kOversampling; ++y)
        for (int x = 0; x < kOversampling; ++x)
            for (int py = -kMaxRadius_px; py <= kMaxRadius_px; ++py)
                for (int px = -kMaxRadius_px; px <= kMaxRadius_px; ++px) {
                    const float here = 2 * value(x, y, px, py);
                    const float across = std::abs(value(x - 1, y, px, py) + value(x + 1, y, px, py) - here),
                                down = std::abs(value(x, y - 1, px, py) + value(x, y + 1, px, py) - here);
                    double& most =
                        linear_errors_[static_cast<std::size_t>(std::max(std::abs(px), std::abs(py)))];
                    most = std::max(most, static_cast<double>(across + down) / 8);
                }
    for (std::size_t r = kMaxRadius_px; r-- > 0;)
        linear_errors_[r] = std::max(linear_errors_[r], linear_errors_[r + 1]);
}

// Computes, for each place, the sums over squares about the middle pixel, and the smallest image, which
// contains the light of the whole field.
void PointSpread::make_places() {
    constexpr std::size_t kCount = std::size_t{kPlacesAcross} * kPlacesAcross;
    least_.resize(kCount * kMinSize);
    inside_.resize(kCount * kRadii);
    float* least = least_.data();
    double* inside = inside_.data();
    for (int y = -kPlaces; y <= kPlaces; ++y)
        for (int x = -kPlaces; x <= kPlaces; ++x, least += kMinSize, inside += kRadii) {
            for (int r = 0; r < kRadii; ++r) {
                double ring = r > 0 ? inside[r - 1] : 0;
                for (int py = -r; py <= r; ++py)
                    for (int px = -r; px <= r; px += std::abs(py) == r ? 1 : std::max(1, 2 * r))
                        ring += static_cast<double>(value(x, y, px, py));
                inside[r] = ring;
            }
            const double whole = whole_at(x, y), kept = inside[kMinRadius_px];
            const auto scale = static_cast<float>(kept > 0 ? whole / kept : 0);
            for (int py = 0; py < kMinAcross_px; ++py)
                for (int px = 0; px < kMinAcross_px; ++px)
                    least[py * kMinPitch_px + px] =
                        scale * value(x, y, px - kMinRadius_px, py - kMinRadius_px);
        }
}

double PointSpread::whole_at(int x, int y) const {
    return phase_sums_[static_cast<std::size_t>(shift_of(y).phase * kOversampling + shift_of(x).phase)];
}
double PointSpread::inside_at(int x, int y, int radius) const {
    return inside_[static_cast<std::size_t>(((y + kPlaces) * kPlacesAcross + x + kPlaces) * kRadii + radius)];
}

const float* PointSpread::least_table(int x, int y) const {
    return least_.data() + ((y + kPlaces) * kPlacesAcross + x + kPlaces) * kMinSize;
}

const float* PointSpread::phase(int px, int py) const {
    return phases_.data() + static_cast<std::size_t>(py * kOversampling + px) * kField_px * kField_px;
}

int PointSpread::radius_for(double electrons) const {
    for (int r = kMinRadius_px; r < kMaxRadius_px; ++r)
        if (electrons * outside_[static_cast<std::size_t>(r)] < kOutside_e) return r;
    return kMaxRadius_px;
}

// A point's place: the pixel that contains it, and the vector from it to that pixel's centre in sixteenths of
// a pixel.
struct PointSpread::Place {
    int x_px, y_px, x, y;
    double beyond_x, beyond_y;  // fractions of the steps

    Place(double at_x_px, double at_y_px) {
        const double cx = std::floor(at_x_px), cy = std::floor(at_y_px);
        const double sx = (cx + 0.5 - at_x_px) * kOversampling, sy = (cy + 0.5 - at_y_px) * kOversampling;
        // A point on a pixel's edge is at the end of the last step, because the cubic needs one more sample,
        // for which there is no further table.
        constexpr int kLast = kOversampling / 2 - 1;
        x = std::min(static_cast<int>(std::floor(sx)), kLast);
        y = std::min(static_cast<int>(std::floor(sy)), kLast);
        x_px = static_cast<int>(cx), y_px = static_cast<int>(cy);
        beyond_x = sx - x, beyond_y = sy - y;
    }
};

namespace {

int pitch_of(int size) {
    constexpr auto kTogether = static_cast<int>(kColumnsTogether);
    return (size + kTogether - 1) / kTogether * kTogether;
}

}  // namespace

PointPatch PointSpread::at(double x_px, double y_px, double electrons, Room& room) const {
    static_assert(kOversampling == 16);
    const int radius = radius_for(electrons);
    const Place place(x_px, y_px);
    if (radius > kMinRadius_px) {
        const int size = 2 * radius + 1, pitch = pitch_of(size);
        std::fill_n(room.data(), size * pitch, 0.0f);
        add_large(large(place, radius, electrons), 0, size, room.data(), pitch);
        return {place.x_px - radius, place.y_px - radius, size, pitch, room.data()};
    }
    if (is_linear(electrons, 0)) {
        const double u = place.beyond_x, v = place.beyond_y;
        return least(place, std::array{1 - u, u}, std::array{1 - v, v}, electrons, room);
    }
    return least(place, cubic_weights(place.beyond_x), cubic_weights(place.beyond_y), electrons, room);
}

bool PointSpread::is_linear(double electrons, int ring_px) const {
    return electrons * linear_errors_[static_cast<std::size_t>(ring_px)] < kLinear_e;
}

bool PointSpread::add(double x_px, double y_px, double electrons, const PictureWindow& window) const {
    const int radius = radius_for(electrons);
    const bool least = radius == kMinRadius_px;
    // For faint points the cubic's outer samples do not matter.
    if (least && !is_linear(electrons, 0)) return false;
    const Place place(x_px, y_px);
    const int left = place.x_px - radius, top = place.y_px - radius, size = 2 * radius + 1;
    if (left < window.first_x || left + pitch_of(size) > window.end_x) return false;
    const int first = std::max(0, window.first_y - top), end = std::min(size, window.end_y - top);
    if (first >= end) return true;
    float* const out = window.origin + top * window.pitch + left;
    if (!least) {
        add_large(large(place, radius, electrons), first, end, out, window.pitch);
        return true;
    }
    const double u = place.beyond_x, v = place.beyond_y;
    const auto weight = [&](double across, double down) {
        return static_cast<float>(electrons * across * down);
    };
    const float* table = least_table(place.x, place.y);
    constexpr int kBelow = kPlacesAcross * kMinSize;
    const std::array<ShiftedTable, 4> tables{{{table, weight(1 - u, 1 - v)},
                                              {table + kMinSize, weight(u, 1 - v)},
                                              {table + kBelow, weight(1 - u, v)},
                                              {table + kBelow + kMinSize, weight(u, v)}}};
    add_least(tables.data(), tables.size(), first, end, out, window.pitch);
    return true;
}

// The image is a weighted sum of the images at surrounding places. weights: for two places along each axis,
// or four.
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
    return {place.x_px - kMinRadius_px, place.y_px - kMinRadius_px, kMinAcross_px, kMinPitch_px, room.data()};
}

// All pixels share one sub-pixel phase, so the image is a sum of shifted tables.
LargeImage PointSpread::large(const Place& place, int radius, double electrons) const {
    const std::array<double, 4> x_weights = cubic_weights(place.beyond_x),
                                y_weights = cubic_weights(place.beyond_y);
    double whole = 0, inside = 0;  // sums over the full field, and over the image
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
            const double weight =
                x_weights[static_cast<std::size_t>(i)] * y_weights[static_cast<std::size_t>(j)];
            whole += weight * whole_at(place.x + i - 1, place.y + j - 1);
            inside += weight * inside_at(place.x + i - 1, place.y + j - 1, radius);
        }
    const double all = inside > 0 ? electrons * whole / inside : 0;
    const auto table = [&](int i, int j, double weight) {
        const Shift x = shift_of(place.x + i), y = shift_of(place.y + j);
        const int middle = kField_px / 2 - radius;
        return ShiftedTable{phase(x.phase, y.phase) + (y.pixels + middle) * kField_px + x.pixels + middle,
                            static_cast<float>(all * weight)};
    };
    LargeImage out;
    for (std::size_t k = 0; k < 16; ++k)
        out.cubic[k] = table(static_cast<int>(k % 4) - 1, static_cast<int>(k / 4) - 1,
                             x_weights[k % 4] * y_weights[k / 4]);
    const std::array<double, 2> across{1 - place.beyond_x, place.beyond_x},
        down{1 - place.beyond_y, place.beyond_y};
    for (std::size_t k = 0; k < 4; ++k)
        out.linear[k] = table(static_cast<int>(k % 2), static_cast<int>(k / 2), across[k % 2] * down[k / 2]);
    int near = 0;  // number of rings, including the middle pixel
    while (near <= radius && !is_linear(electrons, near)) ++near;
    out.pitch = kField_px;
    out.size = 2 * radius + 1;
    out.first_near = radius + 1 - near, out.end_near = radius + near;
    return out;
}

}  // namespace hilcam
