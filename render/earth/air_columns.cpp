#include "render/earth/air_columns.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr float kHalfTurn = static_cast<float>(kPi);
// Heights above the horizon are gridded by the root of their share of 90 degrees, which makes the grid denser
// at the horizon; the Sun's go down to 20 degrees below it.
constexpr float kLowestRoot = -0.4714045f;  // -sqrt(20 / 90)

double cosine_of_root(double root) { return std::sin(0.5 * kPi * std::copysign(root * root, root)); }
float root_of_cosine(float mu) {
    const float share = std::asin(std::clamp(mu, -1.0f, 1.0f)) * (2 / kHalfTurn);
    return std::copysign(std::sqrt(std::abs(share)), share);
}

// Outside the air, even along the horizon.
constexpr double kFarAway_m = 4e6;

// Null if light from below is the same everywhere.
const AirByPlace* lit_by_place(const Atmosphere& air) {
    const auto* found = dynamic_cast<const AirByPlace*>(&air);
    return found && found->lifts_by_place() ? found : nullptr;
}
AirByPlace::Parts look_in_parts(const Atmosphere& air, const AirByPlace* by_place, Vec3d origin_m, Vec3d dir,
                                double distance_m, Vec3d sun_dir) {
    return by_place ? by_place->look_in_parts(origin_m, dir, distance_m, sun_dir)
                    : AirByPlace::Parts{air.look(origin_m, dir, distance_m, sun_dir), {}};
}

// Returns the Sun's direction for one of several rows, towards an azimuth.
Vec3d sun_dir_at(int row, int rows, double azimuth) {
    const double mu0 = cosine_of_root(static_cast<double>(kLowestRoot) +
                                      row * (1 - static_cast<double>(kLowestRoot)) / (rows - 1));
    const double sine0 = std::sqrt(1 - mu0 * mu0);
    return {sine0 * std::cos(azimuth), sine0 * std::sin(azimuth), mu0};
}

}  // namespace

AirColumns::AirColumns(const Atmosphere& air, std::optional<double> high_m)
    : by_place_(lit_by_place(air)), top_m_(static_cast<float>(air.top_m())) {
    transmittance_.resize(2 * kViews);
    radiance_.resize(static_cast<std::size_t>(2) * kAzimuths * kSuns * kViews);
    if (by_place_) lifted_.resize(static_cast<std::size_t>(2) * kSuns * kViews);
    tbb::parallel_for(0, kAzimuths * kSuns, [&](int row) {
        const Vec3d sun_dir = sun_dir_at(row % kSuns, kSuns, kPi * (row / kSuns) / (kAzimuths - 1));
        const auto look_up = [&](double height_m, Vec3d to_viewer) {
            const Vec3d point{0, 0, kEarthEquatorialRadius_m + height_m};
            return look_in_parts(air, by_place_, point + kFarAway_m * to_viewer, -to_viewer, kFarAway_m,
                                 sun_dir);
        };
        // Light from below is tabulated for a view across the Sun's direction.
        constexpr int kAcross = (kAzimuths - 1) / 2;
        for (int i = 0; i < kViews; ++i) {
            const double mu = cosine_of_root(static_cast<double>(i) / (kViews - 1));
            const Vec3d to_viewer{std::sqrt(1 - mu * mu), 0, mu};
            const AirByPlace::Parts low = look_up(1, to_viewer);
            const std::array heights{low, high_m ? look_up(*high_m, to_viewer) : low};
            for (std::size_t k = 0; k < heights.size(); ++k) {
                const AirByPlace::Parts& seen = heights[k];
                radiance_[static_cast<std::size_t>((row * kViews + i) * 2) + k] = seen.over_black.radiance_sr;
                if (row == 0)
                    transmittance_[static_cast<std::size_t>(2 * i) + k] = seen.over_black.transmittance;
                if (!lifted_.empty() && row / kSuns == kAcross)
                    lifted_[static_cast<std::size_t>((row % kSuns * kViews + i) * 2) + k] = seen.per_lift_sr;
            }
        }
    });
    fill_passing(air);
}

void AirColumns::fill_passing(const Atmosphere& air) {
    passed_.resize(kPassHeights);
    passing_.resize(static_cast<std::size_t>(kPassAzimuths) * kPassSuns * kPassHeights);
    if (by_place_) passing_lifted_.resize(static_cast<std::size_t>(kPassSuns) * kPassHeights);
    const auto look_past = [&](int height, Vec3d sun_dir) {
        const double root = static_cast<double>(height) / (kPassHeights - 1);
        const Vec3d lowest{0, 0, kEarthEquatorialRadius_m + 1 + root * root * (air.top_m() - 1)},
            ahead{1, 0, 0};
        return look_in_parts(air, by_place_, lowest - kFarAway_m * ahead, ahead,
                             std::numeric_limits<double>::infinity(), sun_dir);
    };
    tbb::parallel_for(0, kPassAzimuths * kPassSuns, [&](int row) {
        const double share = static_cast<double>(row / kPassSuns) / (kPassAzimuths - 1);
        const Vec3d sun_dir = sun_dir_at(row % kPassSuns, kPassSuns, kPi * share * share);
        for (int i = 0; i < kPassHeights; ++i) {
            const Atmosphere::Sight sight = look_past(i, sun_dir).over_black;
            passing_[static_cast<std::size_t>(row * kPassHeights + i)] = sight.radiance_sr;
            if (row == 0) passed_[static_cast<std::size_t>(i)] = sight.transmittance;
        }
    });
    if (passing_lifted_.empty()) return;
    tbb::parallel_for(0, kPassSuns, [&](int row) {
        const Vec3d across_dir = sun_dir_at(row, kPassSuns, 0.5 * kPi);
        for (int i = 0; i < kPassHeights; ++i)
            passing_lifted_[static_cast<std::size_t>(row * kPassHeights + i)] =
                look_past(i, across_dir).per_lift_sr;
    });
}

Atmosphere::Sight AirColumns::look_past(float height_m, float mu0, float ahead_dot_sun,
                                        const Spectrum& lift) const {
    const float height = std::sqrt(std::clamp(height_m / top_m_, 0.0f, 1.0f)) * (kPassHeights - 1);
    const float sun =
        (std::max(kLowestRoot, root_of_cosine(mu0)) - kLowestRoot) / (1 - kLowestRoot) * (kPassSuns - 1);
    const float sine0 = std::sqrt(std::max(1e-12f, 1 - mu0 * mu0));
    const float azimuth = std::sqrt(std::acos(std::clamp(ahead_dot_sun / sine0, -1.0f, 1.0f)) / kHalfTurn) *
                          (kPassAzimuths - 1);
    const int h = std::min(static_cast<int>(height), kPassHeights - 2),
              s = std::min(static_cast<int>(sun), kPassSuns - 2),
              a = std::min(static_cast<int>(azimuth), kPassAzimuths - 2);
    const float fh = height - static_cast<float>(h), fs = sun - static_cast<float>(s),
                fa = azimuth - static_cast<float>(a);
    Atmosphere::Sight out;
    out.transmittance =
        (1 - fh) * passed_[static_cast<std::size_t>(h)] + fh * passed_[static_cast<std::size_t>(h) + 1];
    for (int i = 0; i < 4; ++i) {
        const int da = i >> 1, ds = i & 1;
        const float w = (da ? fa : 1 - fa) * (ds ? fs : 1 - fs);
        const Spectrum* row = passing_.data() + ((a + da) * kPassSuns + s + ds) * kPassHeights + h;
        out.radiance_sr += (w * (1 - fh)) * row[0];
        out.radiance_sr += (w * fh) * row[1];
    }
    if (passing_lifted_.empty()) return out;
    Spectrum lifted_sr;
    for (int ds = 0; ds < 2; ++ds) {
        const float w = ds ? fs : 1 - fs;
        const Spectrum* row = passing_lifted_.data() + (s + ds) * kPassHeights + h;
        lifted_sr += (w * (1 - fh)) * row[0];
        lifted_sr += (w * fh) * row[1];
    }
    out.radiance_sr += lift * lifted_sr;
    return out;
}

std::optional<Atmosphere::Sight> AirColumns::from_space(Vec3d origin_m, Vec3d dir, double distance_m,
                                                        Vec3d sun_dir) const {
    constexpr double kOnGround_m = 10;  // rounding of the figure and the ray
    const double top_m = kEarthEquatorialRadius_m + static_cast<double>(top_m_);
    if (dot(origin_m, origin_m) < top_m * top_m) return {};
    const double to_lowest_m = -dot(origin_m, dir);
    const Vec3d lowest = origin_m + to_lowest_m * dir;
    const double lowest_m = length(lowest);
    if (to_lowest_m <= 0 || lowest_m >= top_m) {
        Atmosphere::Sight clear;
        clear.transmittance.bin.fill(1);
        return clear;
    }
    if (distance_m == std::numeric_limits<double>::infinity())
        return look_past(static_cast<float>(lowest_m - kEarthEquatorialRadius_m),
                         static_cast<float>(dot(lowest, sun_dir) / lowest_m),
                         static_cast<float>(dot(dir, sun_dir)), lift(lowest));
    const Vec3d end = origin_m + distance_m * dir;
    const double end_m = length(end);
    if (std::abs(end_m - kEarthEquatorialRadius_m) > kOnGround_m || distance_m > to_lowest_m) return {};
    return look(static_cast<float>(-dot(end, dir) / end_m), static_cast<float>(dot(end, sun_dir) / end_m),
                static_cast<float>(-dot(dir, sun_dir)), lift(end))
        .low;
}

AirColumns::Looks AirColumns::look(float mu, float mu0, float cos_phase, const Spectrum& lift) const {
    const float view = std::max(0.0f, root_of_cosine(mu)) * (kViews - 1);
    const float root = std::max(kLowestRoot, root_of_cosine(mu0));
    const float sun = (root - kLowestRoot) / (1 - kLowestRoot) * (kSuns - 1);
    const float sines = std::sqrt(std::max(1e-12f, (1 - mu0 * mu0) * (1 - mu * mu)));
    const float azimuth =
        std::acos(std::clamp((cos_phase - mu0 * mu) / sines, -1.0f, 1.0f)) * ((kAzimuths - 1) / kHalfTurn);
    const int v = std::min(static_cast<int>(view), kViews - 2),
              s = std::min(static_cast<int>(sun), kSuns - 2),
              a = std::min(static_cast<int>(azimuth), kAzimuths - 2);
    const float fv = view - static_cast<float>(v), fs = sun - static_cast<float>(s),
                fa = azimuth - static_cast<float>(a);
    Looks out;
    const Spectrum* clear = transmittance_.data() + 2 * v;
    out.low.transmittance = (1 - fv) * clear[0] + fv * clear[2];
    out.high.transmittance = (1 - fv) * clear[1] + fv * clear[3];
    for (int i = 0; i < 4; ++i) {
        const int da = i >> 1, ds = i & 1;
        const float w = (da ? fa : 1 - fa) * (ds ? fs : 1 - fs);
        const Spectrum* row = radiance_.data() + (((a + da) * kSuns + s + ds) * kViews + v) * 2;
        out.low.radiance_sr += (w * (1 - fv)) * row[0];
        out.high.radiance_sr += (w * (1 - fv)) * row[1];
        out.low.radiance_sr += (w * fv) * row[2];
        out.high.radiance_sr += (w * fv) * row[3];
    }
    if (lifted_.empty()) return out;
    Spectrum low_sr, high_sr;
    for (int ds = 0; ds < 2; ++ds) {
        const float w = ds ? fs : 1 - fs;
        const Spectrum* row = lifted_.data() + ((s + ds) * kViews + v) * 2;
        low_sr += (w * (1 - fv)) * row[0];
        high_sr += (w * (1 - fv)) * row[1];
        low_sr += (w * fv) * row[2];
        high_sr += (w * fv) * row[3];
    }
    out.low.radiance_sr += lift * low_sr;
    out.high.radiance_sr += lift * high_sr;
    return out;
}

}  // namespace hilcam
