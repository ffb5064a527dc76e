#include "render/ground/crater_field.h"

#include <algorithm>
#include <cmath>

namespace hilcam {
namespace {

// The rays of the youngest reach farther than their heights.
constexpr double kRayReach = 6;
// Wear beyond which rays are gone.
constexpr double kRaysWorn = 0.01;

}  // namespace

Fields fields(CraterSettings& c) {
    return {
        integer("seed", c.seed, {0, 9e15}, "seed of the craters, apart from the scenario's"),
        number("age_ga", c.age_ga, 1, {0.001, 4.2},
               "age of the ground, which says how many craters there are"),
        number("smallest_m", c.smallest_m, 1, {0.05, 1e5}, "diameter of the smallest craters"),
        number("largest_m", c.largest_m, 1, {0.05, 1e5},
               "diameter of the largest craters: where the maps' own craters begin"),
        number("diffusivity_m2_ga", c.diffusivity_m2_ga, 1, {0, 1e9}, "wear of the ground's heights"),
        number("rays", c.rays, 1, {0, 3}, "brightening by the ejecta of the youngest craters; 0: none"),
    };
}

void validate(const CraterSettings& c) {
    if (!(c.smallest_m < c.largest_m)) throw KeyError("largest_m", "is not above smallest_m");
}

CraterField::CraterField(double radius_m, const CraterSettings& s)
    : radius_m_(radius_m),
      settings_(s),
      law_(s.age_ga, s.smallest_m, s.largest_m),
      octaves_(
          radius_m, s.seed, RandomPurpose::kCrater, s.smallest_m, s.largest_m,
          [this](double diameter_m) { return law_.per_m2(diameter_m); },
          [](const SeededOctaves::Octave& octave) { return CraterProfile::kReach * octave.least_m; }) {}

CraterField::Shaped CraterField::shaped(const SeededOctaves::Thing& thing) const {
    Shaped c;
    c.place = thing.place;
    c.diameter_m = law_.diameter_m(thing.above);
    const double radius_m = 0.5 * c.diameter_m;
    const double oldest = settings_.diffusivity_m2_ga * settings_.age_ga / (radius_m * radius_m);
    c.worn = thing.spare * std::min(CraterProfile::kMostWorn, oldest);
    const auto waves = thing.words(1), phases = thing.words(2), rays = thing.words(3);
    for (std::size_t i = 0; i < 4; ++i) {
        const double wave =
            0.06 * (GroundCells::uniform(waves[i]) - 0.5) / (1 + 0.5 * static_cast<double>(i));
        const double phase_rad = 2 * kPi * GroundCells::uniform(phases[i]);
        c.wave_cos[i] = wave * std::cos(phase_rad), c.wave_sin[i] = wave * std::sin(phase_rad);
    }
    c.bright = settings_.rays * std::max(0.0, 1 - c.worn / kRaysWorn);
    c.ray_phase_rad = 2 * kPi * GroundCells::uniform(rays[0]);
    c.ray_count = 5 + static_cast<int>(rays[1] % 7);
    return c;
}

void CraterField::find(Vec3d middle, double reach_rad, double smallest_m,
                       std::vector<Crater>& craters) const {
    octaves_.visit_within(middle, reach_rad, smallest_m, [&](const SeededOctaves::Thing& thing) {
        if (const Shaped c = shaped(thing); c.diameter_m >= smallest_m) craters.push_back(c);
    });
}

void CraterField::add(const GroundPatch& patch) const {
    // A crater of fewer posts is no crater.
    constexpr double kPosts = 2.5;
    octaves_.visit_on(patch, kPosts, 0.5 * kRayReach,
                      [&](const SeededOctaves::Thing& thing) { add_one(shaped(thing), patch); });
}

void CraterField::add_one(const Shaped& c, const GroundPatch& patch) const {
    const double radius_m = 0.5 * c.diameter_m;
    const double reach = c.bright > 0 ? kRayReach : CraterProfile::kReach;
    if (length(c.place - patch.middle) * radius_m_ > patch.reach_rad * radius_m_ * 1.001 + reach * radius_m)
        return;
    const double depth_m = CraterProfile::fresh_depth(c.diameter_m) * c.diameter_m;
    const AlongGround axes = axes_along(c.place);
    const Vec3d east = axes.east, north = axes.north;
    const double most2 = (reach * 1.1 * radius_m / radius_m_) * (reach * 1.1 * radius_m / radius_m_);
    patch.for_each(patch.window(c.place, reach * 1.1 * radius_m / radius_m_), [&](std::size_t i) {
        const Vec3d away = patch.places[i] - c.place;
        const double away2 = dot(away, away);
        if (away2 > most2) return;
        const double distance = std::sqrt(away2);
        double outline = 1;
        if (distance > 0) {
            // Cosines and sines of two, three ... times the azimuth, by rotation.
            const double c1 = dot(away, east) / distance, s1 = dot(away, north) / distance;
            double ck = c1, sk = s1;
            for (std::size_t k = 0; k < 4; ++k) {
                const double next = ck * c1 - sk * s1;
                sk = sk * c1 + ck * s1, ck = next;
                outline += c.wave_cos[k] * ck + c.wave_sin[k] * sk;
            }
        }
        const double x = distance * radius_m_ / (radius_m * outline);
        patch.heights_m[i] += depth_m * profile_.height(x, c.worn);
        if (c.bright > 0 && !patch.colors.empty() && x < kRayReach) {
            const double azimuth = std::atan2(dot(away, north), dot(away, east));
            const double ray = 0.5 + 0.5 * std::cos(c.ray_count * azimuth + c.ray_phase_rad);
            const double share =
                x < 1 ? 0.6 : std::exp(1 - x) * (0.3 + 0.7 * ray * ray) * (1 - x / kRayReach);
            patch.colors[i] = static_cast<float>(1 + c.bright * share) * patch.colors[i];
        }
    });
}

}  // namespace hilcam
