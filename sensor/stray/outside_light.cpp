#include "sensor/stray/outside_light.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {

Fields fields(OutsideGhostConfig& g) {
    return {
        number("from_deg", g.from_rad, kDegree_rad, {0, 90},
               "smallest angle between source and boresight at which this ghost appears"),
        number("to_deg", g.to_rad, kDegree_rad, {0, 90},
               "largest angle between source and boresight at which this ghost appears"),
        required(number("gain", g.gain, 1, {0, 0.5}, "share of the source's light in the ghost")),
        number("scale", g.scale, 1, {-5, 5},
               "the ghost's distance from the principal point over the distance of the source's image; "
               "negative: on the opposite side"),
        number("defocus_mm", g.defocus_m, 1e-3, {0, 1000},
               "distance from the detector to the ghost's focus; the diameter of its disk is this over the "
               "f-number"),
    };
}

void validate(const OutsideGhostConfig& g) {
    if (!(g.from_rad < g.to_rad))
        throw KeyError("to_deg", "is not above from_deg; accepted: from_deg below to_deg");
}

Fields fields(OutsideLightConfig& c) {
    return {
        table("transmittance", c.transmittance, {"angle_deg", "ratio"}, {0, 90}, {0, 1},
              "measured point source transmittance by angle from the boresight: irradiance on the detector "
              "over the source's irradiance at the aperture; logarithmic interpolation, 0 beyond the last "
              "sample. Left out: halo and wings of light inside the field continue beyond it"),
        number("baffle_angle_deg", c.baffle_rad, kDegree_rad, {0, 89},
               "angle from the boresight from which on the baffle shades the whole aperture; 0: no baffle"),
        number("baffle_field_deg", c.baffle_field_rad, kDegree_rad, {0, 89},
               "angle from the boresight up to which the baffle shades none of the aperture"),
        number("baffle_leak", c.baffle_leak, 1, {0, 1},
               "share of the shaded light that still arrives by way of the baffle's wall"),
        sections("ghosts", c.ghosts, "ghosts of sources outside the picture"),
    };
}

void validate(const OutsideLightConfig& c) {
    if (c.baffle_rad > 0 && !(c.baffle_field_rad < c.baffle_rad))
        throw KeyError("baffle_field_deg", "is not below baffle_angle_deg; accepted: a lesser angle");
    if (c.baffle_rad == 0 && (c.baffle_field_rad > 0 || c.baffle_leak > 0))
        throw KeyError(c.baffle_leak > 0 ? "baffle_leak" : "baffle_field_deg",
                       "has no effect without baffle_angle_deg; accepted: both or neither");
    if (!c.transmittance.empty() && c.baffle_rad > 0)
        throw KeyError("baffle_angle_deg",
                       "a measured transmittance has the baffle in it; accepted: one of the two");
}

double lit_share(double angle_rad, double field_rad, double baffle_rad) {
    if (baffle_rad <= 0 || angle_rad <= field_rad) return angle_rad < 0.5 * kPi ? 1 : 0;
    if (angle_rad >= baffle_rad) return 0;
    // Seen along the light, the baffle's rim is a disk of radius R that has moved by L tan theta; the
    // aperture's radius is 1. The whole aperture is lit up to L tan(field) = R - 1, and none of it from L
    // tan(baffle) = R + 1 on.
    const double far = std::tan(baffle_rad), near = std::tan(field_rad);
    const double rim = (far + near) / (far - near), d = 2 / (far - near) * std::tan(angle_rad);
    if (d <= rim - 1) return 1;
    const auto corner = [](double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); };
    const double lens =
        corner((d * d + 1 - rim * rim) / (2 * d)) +
        rim * rim * corner((d * d + rim * rim - 1) / (2 * d * rim)) -
        0.5 * std::sqrt(std::max(0.0, (rim + 1 - d) * (d + 1 - rim) * (d - 1 + rim) * (d + 1 + rim)));
    return std::clamp(lens / kPi, 0.0, 1.0);
}

OutsideLight::OutsideLight(const OutsideLightConfig& c, const OutsideLens& lens,
                           const ImageGeometry& detector, const Spectrum& per_irradiance, int bins,
                           const FarWings& wings)
    : wings_(wings),
      geometry_(detector),
      curve_(c.transmittance),
      baffle_rad_(c.baffle_rad),
      field_rad_(c.baffle_field_rad),
      leak_(c.baffle_leak),
      ghost_kinds_(c.ghosts),
      lens_(lens),
      area_px_(lens.aperture_area_m2 / (lens.pitch_m * lens.pitch_m)),
      measured_px_(lens.best_transmission > 0 ? 1 / (area_px_ * lens.best_transmission) : 0),
      per_irradiance_(per_irradiance),
      bins_(bins),
      veil_(static_cast<std::size_t>(kNodes) * kNodes) {
    ghosts_.reserve(ghost_kinds_.size() * kMaxSideLights);
    for (int j = 0; j < kNodes; ++j)
        for (int i = 0; i < kNodes; ++i) {
            const Vec3d dir = normalized(geometry_.direction_camera(
                i * geometry_.width_px / (kNodes - 1.0), j * geometry_.height_px / (kNodes - 1.0)));
            node_across_.push_back({dir.x, dir.y});
        }
}

double OutsideLight::electrons_of(const SideLight& light, double exposure_s) const {
    double sum = 0;
    for (int b = 0; b < bins_; ++b)
        sum += static_cast<double>(per_irradiance_[b]) * static_cast<double>(light.irradiance_w_m2_um[b]);
    return sum * exposure_s * lens_.fill_factor;
}

namespace {

// Interpolates a curve that falls by decades: linear in its logarithm where it is above zero.
double by_logarithm(const Table& curve, double x) {
    if (x > curve.x.back()) return 0;
    if (x <= curve.x.front()) return curve.y.front();
    const auto after =
        static_cast<std::size_t>(std::lower_bound(curve.x.begin(), curve.x.end(), x) - curve.x.begin());
    const double a = curve.y[after - 1], b = curve.y[after];
    if (x == curve.x[after]) return b;
    if (!(a > 0 && b > 0)) return curve.at(x);
    const double u = (x - curve.x[after - 1]) / (curve.x[after] - curve.x[after - 1]);
    return a * std::pow(b / a, u);
}

}  // namespace

// Returns the veil in a pixel relative to the light that the whole aperture receives from a source in front
// of it.
double OutsideLight::veil_px(Vec3f source, double cosine, Vec2d across) const {
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
    if (!curve_.empty()) return measured_px_ * by_logarithm(curve_, angle / kDegree_rad);
    if (cosine <= 0) return 0;
    const double lit = lit_share(angle, field_rad_, baffle_rad_);
    const double share = lit + leak_ * (1 - lit);
    if (!(share > 0)) return 0;
    const double distance_px =
        geometry_.focal_length_px *
        std::hypot(static_cast<double>(source.x) - across.x, static_cast<double>(source.y) - across.y);
    return cosine * share * wings_.density(distance_px);
}

double OutsideLight::transmittance(double angle_rad) const {
    const Vec3f source{static_cast<float>(std::sin(angle_rad)), 0, static_cast<float>(std::cos(angle_rad))};
    return veil_px(source, std::cos(angle_rad), {}) * area_px_ * lens_.best_transmission;
}

void OutsideLight::add_ghosts(const SideLight& light, double angle_rad, double electrons) {
    const double cosine = static_cast<double>(light.camera_dir.z);
    for (const OutsideGhostConfig& kind : ghost_kinds_) {
        const double in = (angle_rad - kind.from_rad) / (kind.to_rad - kind.from_rad);
        const double fade = std::min({1.0, 10 * in, 10 * (1 - in)});
        if (!(fade > 0) || !(cosine > 1e-3) || ghosts_.size() == ghosts_.capacity()) continue;
        const Vec2d center = geometry_.center_px();
        const double reach = kind.scale * geometry_.focal_length_px / cosine;
        // A sharp ghost is at least a pixel wide.
        const double radius = std::max(0.6, kind.defocus_m / (2 * lens_.f_number) / lens_.pitch_m);
        const double hole = radius > 2 ? lens_.obscuration_ratio * radius : 0;
        ghosts_.push_back({{center.x + reach * static_cast<double>(light.camera_dir.x),
                            center.y + reach * static_cast<double>(light.camera_dir.y)},
                           radius,
                           hole,
                           static_cast<float>(electrons * cosine * kind.gain * fade /
                                              (kPi * (radius * radius - hole * hole)))});
    }
}

bool OutsideLight::collect(std::span<const SideLight> lights, double exposure_s) {
    ghosts_.clear();
    if (lights.empty()) return false;
    tbb::parallel_for(tbb::blocked_range<int>(0, kNodes, 4), [&](const tbb::blocked_range<int>& range) {
        for (int j = range.begin(); j < range.end(); ++j)
            for (int i = 0; i < kNodes; ++i) {
                const auto node = static_cast<std::size_t>(j * kNodes + i);
                double sum = 0;
                for (const SideLight& light : lights)
                    sum += electrons_of(light, exposure_s) * veil_px(light.camera_dir,
                                                                     static_cast<double>(light.camera_dir.z),
                                                                     node_across_[node]);
                veil_[node] = static_cast<float>(sum);
            }
    });
    for (const SideLight& light : lights)
        add_ghosts(light, std::acos(std::clamp(static_cast<double>(light.camera_dir.z), -1.0, 1.0)),
                   electrons_of(light, exposure_s));
    return true;
}

void OutsideLight::add_to_row(int y, std::size_t first, std::size_t step, std::span<float> row) const {
    const double v = (y + 0.5) / geometry_.height_px * (kNodes - 1);
    const int j = std::min(static_cast<int>(v), kNodes - 2);
    const auto below = static_cast<float>(v - j);
    const float* top = veil_.data() + j * kNodes;
    const float per_px = static_cast<float>(kNodes - 1) / static_cast<float>(geometry_.width_px);
    for (std::size_t x = first; x < row.size(); x += step) {
        const float u = (static_cast<float>(x) + 0.5f) * per_px;
        const int i = std::min(static_cast<int>(u), kNodes - 2);
        const float right = u - static_cast<float>(i);
        const float* a = top + i;
        row[x] += (1 - below) * ((1 - right) * a[0] + right * a[1]) +
                  below * ((1 - right) * a[kNodes] + right * a[kNodes + 1]);
    }
    // A pixel is half lit where a disk\'s rim passes through its centre, and fully lit half a pixel inside.
    for (const Ghost& g : ghosts_) {
        const double dy = y + 0.5 - g.at_px.y, outer = g.radius_px + 0.5;
        if (std::abs(dy) >= outer) continue;
        const double half = std::sqrt(outer * outer - dy * dy);
        const double from = std::ceil(g.at_px.x - half - 0.5), to = std::floor(g.at_px.x + half - 0.5);
        for (double at = std::max(from, 0.0); at <= std::min(to, static_cast<double>(row.size()) - 1); ++at) {
            const auto x = static_cast<std::size_t>(at);
            if (x < first || (x - first) % step != 0) continue;
            const double r = std::hypot(at + 0.5 - g.at_px.x, dy);
            const double lit = std::clamp(g.radius_px - r + 0.5, 0.0, 1.0) -
                               (g.hole_px > 0 ? std::clamp(g.hole_px - r + 0.5, 0.0, 1.0) : 0.0);
            row[x] += static_cast<float>(lit) * g.electrons_px;
        }
    }
}

}  // namespace hilcam
