#include "render/ground/crater_field.h"

#include <algorithm>
#include <cmath>

namespace hilcam {
namespace {

// Wear beyond which rays are gone.
constexpr double kRaysWorn = 0.01;

}  // namespace

Fields fields(CraterSettings& c) {
    return {
        integer("seed", c.seed, {0, 9e15}, "seed of the craters, independent of the scenario's seed"),
        number("age_ga", c.age_ga, 1, {0.001, 4.2}, "age of the ground, which sets the number of craters"),
        number("smallest_m", c.smallest_m, 1, {0.05, 1e5}, "diameter of the smallest craters"),
        number("largest_m", c.largest_m, 1, {0.05, 1e5},
               "diameter of the largest craters, at which the maps' own craters begin"),
        number("diffusivity_m2_ga", c.diffusivity_m2_ga, 1, {0, 1e9},
               "topographic diffusivity, which wears the heights down"),
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
          [](const SeededOctaves::Octave& octave) { return CraterProfile::kReach * octave.min_m; }) {}

Crater CraterField::crater_of(const SeededOctaves::Thing& thing) const {
    Crater c;
    c.place = thing.place;
    c.diameter_m = law_.diameter_m(thing.above);
    const double radius_m = 0.5 * c.diameter_m;
    const double oldest = settings_.diffusivity_m2_ga * settings_.age_ga / (radius_m * radius_m);
    c.worn = thing.spare * std::min(CraterProfile::kMaxWorn, oldest);
    return c;
}

double CraterField::bright_of(const Crater& c) const {
    return settings_.rays * std::max(0.0, 1 - c.worn / kRaysWorn);
}

CraterShape CraterField::shape_of(const Crater& c, const SeededOctaves::Thing& thing) const {
    CraterShape shape;
    shape.place = c.place, shape.axes = axes_along(c.place);
    shape.radius_m = 0.5 * c.diameter_m, shape.body_radius_m = radius_m_;
    shape.depth_m = CraterProfile::fresh_depth(c.diameter_m) * c.diameter_m;
    shape.profile = profile_.at(c.worn);
    const auto waves = thing.words(1), phases = thing.words(2), rays = thing.words(3);
    for (std::size_t i = 0; i < kCraterWaves; ++i) {
        const double wave =
            0.06 * (GroundCells::uniform(waves[i]) - 0.5) / (1 + 0.5 * static_cast<double>(i));
        const double phase_rad = 2 * kPi * GroundCells::uniform(phases[i]);
        shape.wave_cos[i] = wave * std::cos(phase_rad), shape.wave_sin[i] = wave * std::sin(phase_rad);
    }
    shape.bright = bright_of(c);
    shape.ray_phase_rad = 2 * kPi * GroundCells::uniform(rays[0]);
    shape.ray_count = 5 + static_cast<int>(rays[1] % 7);
    return shape;
}

void CraterField::find(Vec3d middle, double reach_rad, double smallest_m,
                       std::vector<Crater>& craters) const {
    octaves_.visit_within(middle, reach_rad, smallest_m, [&](const SeededOctaves::Thing& thing) {
        if (const Crater c = crater_of(thing); c.diameter_m >= smallest_m) craters.push_back(c);
    });
}

void CraterField::add(const GroundPatch& patch) const {
    // A crater smaller than this many posts is left out.
    constexpr double kPosts = 2.5;
    octaves_.visit_on(patch, kPosts, 0.5 * CraterShape::kRayReach, [&](const SeededOctaves::Thing& thing) {
        const Crater c = crater_of(thing);
        const double reach_m = CraterShape::reach(bright_of(c)) * 0.5 * c.diameter_m;
        if (length(c.place - patch.middle) * radius_m_ <= patch.reach_rad * radius_m_ * 1.001 + reach_m)
            add_crater(shape_of(c, thing), patch);
    });
}

}  // namespace hilcam
