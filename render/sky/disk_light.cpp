#include "render/sky/disk_light.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/sky/saturn_rings.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// The range of the law for Saturn with its rings (Mallama & Hilton 2018, eq. 10); from the third on it is not
// applied.
constexpr double kLawPhase_deg = 6.5, kLawTilt_deg = 27, kFadedPhase_deg = 15;

const Figure& saturn() { return kFigures[index_of(BodyId::kSaturn)]; }

// The normals of an ellipsoid are a sphere's directions n with z stretched inversely: N = (x/a, y/a, z/b),
// and dA = a^2 b |N| do. So the integral goes over the lune of n that is lit and visible, along meridians
// with common poles. share(point): weight of the light there.
template <class Share>
double over_lune_m2(const Figure& figure, SurfaceLaw law, const DiskView& view, int rows, int columns,
                    const Share& share) {
    const double a = figure.equatorial_radius_m, b = figure.polar_radius_m;
    const auto unstretched = [&](Vec3d v) { return normalized(Vec3d{v.x / a, v.y / a, v.z / b}); };
    const Vec3d seen = unstretched(view.to_viewer), lit = unstretched(view.to_sun);
    const Vec3d across = lit - dot(lit, seen) * seen;
    const Vec3d other = std::abs(seen.z) < 0.7 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0};
    const Vec3d side = dot(across, across) > 1e-24 ? normalized(across) : normalized(cross(seen, other));
    const Vec3d pole = cross(seen, side);
    const double angle = std::atan2(dot(lit, side), dot(lit, seen));
    const double first = angle - 0.5 * kPi, width = kPi - angle;
    double sum = 0;
    for (int j = 0; j < rows; ++j) {
        const double latitude = kPi * ((j + 0.5) / rows - 0.5), cosine = std::cos(latitude);
        const double cell = kPi / rows * cosine * width / columns * a * a * b;
        for (int i = 0; i < columns; ++i) {
            const double longitude = first + width * (i + 0.5) / columns;
            const Vec3d n = (cosine * std::cos(longitude)) * seen + (cosine * std::sin(longitude)) * side +
                            std::sin(latitude) * pole;
            const Vec3d normal{n.x / a, n.y / a, n.z / b};
            const double per_length = 1 / length(normal);
            const double mu = per_length * dot(normal, view.to_viewer),
                         mu0 = per_length * dot(normal, view.to_sun);
            if (!(mu > 0 && mu0 > 0)) continue;
            const double reflected = law == SurfaceLaw::kLambert ? mu0 / kPi : mu0 / (4 * kPi * (mu0 + mu));
            sum += cell / per_length * reflected * mu * share(Vec3d{n.x * a, n.y * a, n.z * b});
        }
    }
    return sum;
}

// Returns the globe's light between its rings.
double ringed_globe_m2(SurfaceLaw law, const DiskView& view) {
    return over_lune_m2(saturn(), law, view, 32, 48, [&](Vec3d point_m) {
        return SaturnRings::transmittance(point_m, view.to_viewer) *
               SaturnRings::transmittance(point_m, view.to_sun);
    });
}

// Returns the light of the rings that the globe neither hides nor shadows.
double rings_m2(const DiskView& view) {
    constexpr int kRadii = 64, kSpokes = 48;
    constexpr double kWidth_m = (SaturnRings::kOuter_m - SaturnRings::kInner_m) / kRadii;
    double sum = 0;
    for (int i = 0; i < kRadii; ++i) {
        const double radius_m = SaturnRings::kInner_m + (i + 0.5) * kWidth_m;
        const double light = SaturnRings::radiance_sr(radius_m, view.to_viewer, view.to_sun) * radius_m *
                             kWidth_m * 2 * kPi / kSpokes;
        for (int k = 0; k < kSpokes; ++k) {
            const double spoke = 2 * kPi * (k + 0.5) / kSpokes;
            const Vec3d point_m{radius_m * std::cos(spoke), radius_m * std::sin(spoke), 0};
            if (intersect_ellipsoid(saturn(), point_m, view.to_viewer) < 0 &&
                intersect_ellipsoid(saturn(), point_m, view.to_sun) < 0)
                sum += light;
        }
    }
    return sum * std::abs(view.to_viewer.z);
}

// The grid of the factor's table; it is denser at the rings' surge.
constexpr std::array kPhases_deg{0.0, 0.1, 0.25, 0.5, 1.0, 1.7, 3.0, 4.7, 6.5};
constexpr std::array kTilts_deg{0.0, 1.0, 2.0, 4.0, 7.0, 11.0, 15.0, 19.0, 23.0, 27.0};

// Sun and viewer at one latitude, separated by the phase, or near the poles by as much as possible.
DiskView level_view(double tilt_rad, double phase_rad) {
    const double cosine = std::cos(tilt_rad), half = std::min(1.0, std::sin(0.5 * phase_rad) / cosine);
    const double longitude = 2 * std::asin(half);
    return {{cosine, 0, std::sin(tilt_rad)},
            {cosine * std::cos(longitude), cosine * std::sin(longitude), std::sin(tilt_rad)}};
}

// Returns the sine of the law's ring tilt.
double tilt_sine(const DiskView& view) {
    return std::sqrt(std::clamp(view.to_viewer.z * view.to_sun.z, 0.0, 1.0));
}

double law_m2(const DiskView& view) {
    return disk_m2_of_magnitude(saturn_magnitude_v_1au(view.phase_rad(), tilt_sine(view)));
}

template <std::size_t kCount>
std::size_t before(const std::array<double, kCount>& places, double value) {
    const auto after =
        static_cast<std::size_t>(std::upper_bound(places.begin(), places.end(), value) - places.begin());
    return std::clamp<std::size_t>(after, 1, kCount - 1) - 1;
}

}  // namespace

double DiskView::phase_rad() const { return std::acos(std::clamp(dot(to_viewer, to_sun), -1.0, 1.0)); }

double lit_disk_m2(const Figure& figure, SurfaceLaw law, const DiskView& view) {
    return over_lune_m2(figure, law, view, 24, 48, [](Vec3d) { return 1.0; });
}

double outline_disk_m2(const Figure& figure, SurfaceLaw law, const DiskView& view) {
    // Semi-axes of the ellipse that it shows: a and sqrt(a^2 sin^2 + b^2 cos^2) of the viewer's latitude.
    const double a = figure.equatorial_radius_m, b = figure.polar_radius_m, sine = view.to_viewer.z;
    return a * std::sqrt(a * a * sine * sine + b * b * (1 - sine * sine)) *
           sphere_brightness(law, view.phase_rad());
}

double shape_factor(const Figure& figure, SurfaceLaw law, const DiskView& view) {
    const double a = figure.equatorial_radius_m;
    if (a == figure.polar_radius_m) return 1;
    const double lit_m2 = lit_disk_m2(figure, law, view);
    if (!(lit_m2 > 1e-5 * a * a)) return 1;
    // For a narrow crescent its orientation matters more, and the factor does not apply.
    return std::clamp(outline_disk_m2(figure, law, view) / lit_m2, 0.8, 1.25);
}

double latitude_factor(BodyId id, const Figure& figure, const DiskView& view) {
    if (id != BodyId::kUranus) return 1;
    const double a = figure.equatorial_radius_m, b = figure.polar_radius_m;
    const auto latitude_rad = [&](Vec3d dir) {
        return std::abs(std::atan2(dir.z * a * a, std::hypot(dir.x, dir.y) * b * b));
    };
    const double mean_deg = 0.5 * (latitude_rad(view.to_viewer) + latitude_rad(view.to_sun)) / kDegree_rad;
    const double sine = view.to_viewer.z;
    const double outline = std::sqrt(a * a * sine * sine + b * b * (1 - sine * sine)) / b;
    return std::pow(10.0, 0.4 * 8.4e-4 * mean_deg) / outline;
}

double saturn_magnitude_v_1au(double phase_rad, double tilt_sine) {
    const double a = std::min(phase_rad / kDegree_rad, kLawPhase_deg);
    const double sine = std::clamp(tilt_sine, 0.0, std::sin(kLawTilt_deg * kDegree_rad));
    return -8.914 - 1.825 * sine + 0.026 * a - 0.378 * sine * std::exp(-2.25 * a);
}

SaturnLight::SaturnLight(const BodyLook& look) : look_(look) {
    for (const double phase_deg : kPhases_deg)
        for (const double tilt_deg : kTilts_deg) {
            const DiskView view = level_view(tilt_deg * kDegree_rad, phase_deg * kDegree_rad);
            const Drawn here = drawn(view);
            factors_.push_back(law_m2(view) / (here.globe_m2 + here.rings_m2));
        }
}

SaturnLight::Drawn SaturnLight::drawn(const DiskView& view) const {
    const double phase_rad = view.phase_rad(), sphere = sphere_brightness(look_.law(), phase_rad);
    const double coefficient = sphere > 0 ? look_.disk_brightness(phase_rad) / sphere : 0;
    return {coefficient * shape_factor(saturn(), look_.law(), view) * ringed_globe_m2(look_.law(), view),
            rings_m2(view)};
}

double SaturnLight::law_factor(const DiskView& view, const Drawn& here) const {
    const double phase_deg = view.phase_rad() / kDegree_rad;
    const double tilt_deg = std::asin(tilt_sine(view)) / kDegree_rad;
    const std::size_t i = before(kPhases_deg, phase_deg), j = before(kTilts_deg, tilt_deg);
    const auto share = [](double value, double from, double to) {
        return std::clamp((value - from) / (to - from), 0.0, 1.0);
    };
    const double u = share(phase_deg, kPhases_deg[i], kPhases_deg[i + 1]),
                 v = share(tilt_deg, kTilts_deg[j], kTilts_deg[j + 1]);
    const double* at = factors_.data() + i * kTilts_deg.size() + j;
    const double* next = at + kTilts_deg.size();
    const double level = (1 - u) * ((1 - v) * at[0] + v * at[1]) + u * ((1 - v) * next[0] + v * next[1]);
    // Inside the law's range the factor is exact for this very view; there is no step at the end of the
    // range.
    constexpr double kBlend_deg = 0.2;
    const double holds = share(phase_deg, kLawPhase_deg, kLawPhase_deg - kBlend_deg) *
                         share(tilt_deg, kLawTilt_deg + kBlend_deg, kLawTilt_deg);
    const double in_law =
        holds > 0 ? (1 - holds) * level + holds * law_m2(view) / (here.globe_m2 + here.rings_m2) : level;
    return 1 + share(phase_deg, kFadedPhase_deg, kLawPhase_deg) * (in_law - 1);
}

SaturnLight::Factor SaturnLight::factor(const DiskView& view) const {
    const double law = law_factor(view, drawn(view));
    return {law * shape_factor(saturn(), look_.law(), view), law};
}

SaturnLight::Parts SaturnLight::parts(const DiskView& view) const {
    const Drawn here = drawn(view);
    const double law = law_factor(view, here);
    const double outline_m2 = outline_disk_m2(saturn(), look_.law(), view);
    const double sphere = sphere_brightness(look_.law(), view.phase_rad());
    const double whole_m2 = sphere > 0 ? look_.disk_brightness(view.phase_rad()) / sphere * outline_m2 : 0;
    return {whole_m2 > 0 ? law * here.globe_m2 / whole_m2 : 0.0, law * here.rings_m2};
}

}  // namespace hilcam
