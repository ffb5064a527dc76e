#include "sensor/point_light.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render/vocabulary/pose.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Points of a trail. Their row has its first harmonic at this frequency, where a full pixel's own transfer
// function is zero along both axes.
constexpr double kPerPixel = 2;

// Drawn together, in so many bands of rows: enough for the threads of a bench machine, and bands that are
// much higher than the images that lie across two of them.
constexpr std::size_t kMostSpots = 4096;
constexpr int kBands = 16;
constexpr std::size_t kFewSpots = 64;  // not worth waking threads for

constexpr int kReach = PointSpread::kMostRadius_px;
constexpr int kAcross = 2 * kReach + 1;

// Around a point: its wings, which are added elsewhere, and those of its copies, one in every field, that the
// table has folded in. Copies outside 25 x 25 fields are an even plane from the radius of that square's area
// on, whose density integrates to 2 pi R^2 D(R) where D falls as r^-3.
std::vector<double> near_wings(const FarWings& wings) {
    constexpr int kCopies = 12;
    constexpr double kField2 = static_cast<double>(PointSpread::kField_px) * PointSpread::kField_px;
    const double radius_px = (2 * kCopies + 1) * PointSpread::kField_px / std::sqrt(kPi);
    const double beyond = 2 * kPi * radius_px * radius_px * wings.density(radius_px) / kField2;
    std::vector<double> out;
    for (int y = -kReach; y <= kReach; ++y)
        for (int x = -kReach; x <= kReach; ++x) {
            double sum = beyond;
            for (int j = -kCopies; j <= kCopies; ++j)
                for (int i = -kCopies; i <= kCopies; ++i)
                    sum += wings.density(
                        std::hypot(x - i * PointSpread::kField_px, y - j * PointSpread::kField_px));
            out.push_back(sum);
        }
    return out;
}

}  // namespace

PointLight::PointLight(const DetectorView& view, std::vector<LightChannel>& channels,
                       const std::vector<FarWings>& wings, int bins)
    : view_(view),
      channels_(channels),
      bins_(bins),
      glare_e_(channels.size()),
      patch_(std::size_t{kAcross} * kAcross) {
    spots_.reserve(kMostSpots);
    for (const FarWings& w : wings) near_wings_.push_back(near_wings(w));
}

void PointLight::begin(const Exposure& exposure) {
    exposure_ = exposure;
    jitter_px_ = std::sqrt(jitter_blur_rad2(view_.camera.jitter, exposure.exposure_s)) *
                 view_.detector.focal_length_px;
    // A hundredth of a pixel is not seen.
    if (jitter_px_ < 0.01) jitter_px_ = 0;
    std::fill(glare_e_.begin(), glare_e_.end(), 0.0);
}

void PointLight::add(const PointSource& point, ElectronImage& light_e) {
    const double m = view_.sampling.oversampling;
    const Vec2d middle_px{static_cast<double>(point.position_px.x) / m,
                          static_cast<double>(point.position_px.y) / m};
    if (!std::isfinite(middle_px.x) || !std::isfinite(middle_px.y)) return;
    const double way = exposure_.exposure_s / m;
    const Vec2d drift_px{way * static_cast<double>(point.drift_px_s.x),
                         way * static_cast<double>(point.drift_px_s.y)};
    const Vec3d turn_rad = -exposure_.exposure_s * exposure_.camera_rate_rad_s;
    for (std::size_t c = 0; c < channels_.size(); ++c) {
        const double all =
            std::min(channels_[c].electrons_of(point.irradiance_w_m2_um, bins_, exposure_.exposure_s), 1e9);
        if (!(all > 0)) continue;
        along_trail(middle_px, drift_px, turn_rad, [&](Vec2d at_px, double part) {
            if (std::abs(at_px.x) > 1e6 || std::abs(at_px.y) > 1e6) return;
            const double electrons = all * part * view_.lens.of_point(at_px.x, at_px.y);
            scatter(at_px, [&](Vec2d px, double share) {
                spots_.push_back(spot_of(static_cast<int>(c), px, electrons * share));
                if (spots_.size() == kMostSpots) draw_spots(light_e);
            });
        });
    }
}

// It is part of the picture and moves with it.
void PointLight::add(const BrightPixel& pixel, ElectronImage& light_e) {
    const Vec2d way_px{exposure_.image_rate_px_s.x * exposure_.exposure_s,
                       exposure_.image_rate_px_s.y * exposure_.exposure_s};
    along_trail(pixel.position_px, way_px, {}, [&](Vec2d at_px, double part) {
        scatter(at_px, [&](Vec2d px, double share) {
            // Its electrons count the fill factor already.
            draw(spot_of(pixel.channel, px, pixel.electrons * part * share / view_.camera.fill_factor),
                 all_rows(), light_e);
            take_off_wings(px, pixel.channel, pixel.electrons * part * share, light_e);
        });
    });
}

// drift_px: the point's own way, over that of a sky which turns by turn_rad.
template <class Draw>
void PointLight::along_trail(Vec2d middle_px, Vec2d drift_px, const Vec3d& turn_rad, const Draw& draw) const {
    const bool turns = turn_rad.x != 0 || turn_rad.y != 0 || turn_rad.z != 0;
    if (!turns && drift_px.x == 0 && drift_px.y == 0) return draw(middle_px, 1.0);
    const Vec3d dir = view_.detector.direction_camera(middle_px.x, middle_px.y);
    const auto at = [&](double time) {
        Vec2d px = middle_px;
        if (turns) {
            const Vec3d moved = to_matrix(from_rotation_vector(time * turn_rad)) * dir;
            px = moved.z > 0 ? view_.detector.project_px(moved) : Vec2d{-1e9, -1e9};
        }
        return Vec2d{px.x + time * drift_px.x, px.y + time * drift_px.y};
    };
    const Vec2d from = at(-0.5), to = at(0.5);
    const double length_px = std::hypot(to.x - from.x, to.y - from.y);
    const double parts = std::clamp(std::ceil(length_px * kPerPixel), 1.0, 4096.0);
    for (double i = 0.5; i < parts; i += 1) draw(at(i / parts - 0.5), 1 / parts);
}

template <class Draw>
void PointLight::scatter(Vec2d at_px, const Draw& draw) const {
    if (jitter_px_ <= 0) return draw(at_px, 1.0);
    constexpr int kSteps = 6;
    std::array<double, 2 * kSteps + 1> weights;
    double sum = 0;
    for (int i = -kSteps; i <= kSteps; ++i)
        sum += weights[static_cast<std::size_t>(i + kSteps)] = std::exp(-0.125 * i * i);
    for (int j = -kSteps; j <= kSteps; ++j)
        for (int i = -kSteps; i <= kSteps; ++i)
            draw({at_px.x + 0.5 * i * jitter_px_, at_px.y + 0.5 * j * jitter_px_},
                 weights[static_cast<std::size_t>(i + kSteps)] *
                     weights[static_cast<std::size_t>(j + kSteps)] / (sum * sum));
}

// Counts those of its electrons that glare takes.
PointLight::Spot PointLight::spot_of(int c, Vec2d at_px, double electrons) {
    const StrayLightConfig& stray = view_.camera.stray_light;
    if (stray.glare_radius_px <= 0) {
        glare_e_[static_cast<std::size_t>(c)] +=
            electrons * view_.camera.fill_factor * stray.veiling_glare_fraction;
        electrons *= 1 - stray.veiling_glare_fraction;
    }
    int radius_px = 0;
    for (const PointSpread& spread : channels_[static_cast<std::size_t>(c)].spreads)
        radius_px = std::max(radius_px, spread.radius_for(electrons));
    return {at_px, electrons, c, radius_px};
}

void PointLight::draw_spots(ElectronImage& light_e) {
    const int bands = spots_.size() < kFewSpots ? 1 : kBands;
    const int height = view_.detector.height_px;
    tbb::parallel_for(0, bands, [&](int band) {
        const Rows rows{height * band / bands, height * (band + 1) / bands};
        for (const Spot& spot : spots_) {
            // Charge may cross over to the row before and after.
            const double reach = spot.radius_px + 2;
            if (spot.at_px.y + reach >= rows.begin && spot.at_px.y - reach <= rows.end)
                draw(spot, rows, light_e);
        }
    });
    spots_.clear();
}

void PointLight::draw(const Spot& spot, Rows rows, ElectronImage& light_e) const {
    PointSpread::Room room;
    const Vec2d at_px = spot.at_px;
    const double field = view_.lens.field_fraction(at_px.x, at_px.y);
    const LightChannel& channel = channels_[static_cast<std::size_t>(spot.channel)];
    for (std::size_t z = 0; z < channel.spreads.size(); ++z) {
        const double weight = zone_weight(view_.camera.field_zones, z, field);
        if (weight > 0)
            add_patch(channel.spreads[z].at(at_px.x, at_px.y, spot.electrons * weight, room), spot.channel,
                      rows, light_e);
    }
}

void PointLight::take_off_wings(Vec2d at_px, int c, double electrons, ElectronImage& light_e) {
    const std::vector<double>& wings = near_wings_[static_cast<std::size_t>(c)];
    std::transform(wings.begin(), wings.end(), patch_.begin(),
                   [&](double share) { return static_cast<float>(-electrons * share); });
    add_patch({static_cast<int>(std::floor(at_px.x)) - kReach, static_cast<int>(std::floor(at_px.y)) - kReach,
               kAcross, patch_.data()},
              c, all_rows(), light_e);
}

// Of a mosaic's channel only its own pixels have the light; some of their charge crosses over to the
// neighbours.
void PointLight::add_patch(const PointPatch& patch, int c, Rows rows, ElectronImage& light_e) const {
    const int width = view_.detector.width_px;
    const auto left = static_cast<int>(view_.camera.black_columns),
               top = static_cast<int>(view_.camera.black_rows);
    const auto crosstalk = static_cast<float>(view_.mosaic.one_color() ? 0 : view_.camera.crosstalk_fraction);
    const auto add = [&](int x, int y, float electrons) {
        if (x < 0 || y < rows.begin || x >= width || y >= rows.end) return;
        light_e.row(y + top)[static_cast<std::size_t>(x + left)] += electrons;
    };
    // One pixel beyond the rows, or the window, can still cross over.
    for (int j = std::max(0, rows.begin - 1 - patch.top); j < std::min(patch.size, rows.end + 1 - patch.top);
         ++j)
        for (int i = std::max(0, -patch.left - 1); i < std::min(patch.size, width + 1 - patch.left); ++i) {
            const int x = patch.left + i, y = patch.top + j;
            if (view_.mosaic.channel(x, y) != c) continue;
            const float electrons = patch.electrons[j * patch.size + i];
            add(x, y, (1 - 4 * crosstalk) * electrons);
            if (crosstalk == 0) continue;
            add(x - 1, y, crosstalk * electrons), add(x + 1, y, crosstalk * electrons);
            add(x, y - 1, crosstalk * electrons), add(x, y + 1, crosstalk * electrons);
        }
}

void PointLight::finish(ElectronImage& light_e) {
    draw_spots(light_e);
    add_glare(light_e);
}

void PointLight::add_glare(ElectronImage& light_e) const {
    if (std::all_of(glare_e_.begin(), glare_e_.end(), [](double e) { return e == 0; })) return;
    const double pixels = static_cast<double>(view_.detector.padded_width()) * view_.detector.padded_height();
    for (int y = 0; y < view_.detector.height_px; ++y) {
        float* row =
            light_e.row(y + static_cast<int>(view_.camera.black_rows)).data() + view_.camera.black_columns;
        for (int x = 0; x < view_.detector.width_px; ++x)
            row[x] +=
                static_cast<float>(glare_e_[static_cast<std::size_t>(view_.mosaic.channel(x, y))] / pixels);
    }
}

}  // namespace hilcam
