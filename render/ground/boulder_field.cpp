#include "render/ground/boulder_field.h"

#include <algorithm>
#include <cmath>

namespace hilcam {
namespace {

// Returns the integral of D^(1 - b) from one diameter to another.
double area_integral(double b, double min_m, double max_m) {
    return std::abs(b - 2) < 1e-9 ? std::log(max_m / min_m)
                                  : (std::pow(max_m, 2 - b) - std::pow(min_m, 2 - b)) / (2 - b);
}

// The ratio of the smaller to the larger width is uniform from 0.6 to 1; areas contain its mean.
constexpr double kSlimFrom = 0.6, kMeanSlim = 0.8;

}  // namespace

Fields fields(BoulderSettings& b) {
    return {
        integer("seed", b.seed, {0, 9e15}, "seed of the boulders, independent of the scenario's seed"),
        number("abundance", b.abundance, 1, {0, 0.5}, "share of the ground covered by boulders"),
        number("exponent", b.exponent, 1, {1, 4},
               "exponent of the cumulative number of boulders above a diameter"),
        number("smallest_m", b.smallest_m, 1, {0.02, 1e3}, "width of the smallest boulders"),
        number("largest_m", b.largest_m, 1, {0.02, 1e3}, "width of the largest boulders"),
    };
}

void validate(const BoulderSettings& b) {
    if (!(b.smallest_m < b.largest_m)) throw KeyError("largest_m", "is not above smallest_m");
}

// abundance = integral of pi/4 D^2 slim dN, dN = K b D^(-b - 1) dD. Cells hold about one boulder, not wider
// than the cell.
BoulderField::BoulderField(double radius_m, const BoulderSettings& s,
                           std::shared_ptr<const SeededFactor> factor)
    : radius_m_(radius_m),
      settings_(s),
      by_place_(std::move(factor)),
      factor_(s.abundance /
              (0.25 * kPi * kMeanSlim * s.exponent * area_integral(s.exponent, s.smallest_m, s.largest_m))),
      octaves_(
          radius_m, s.seed, RandomPurpose::kBoulder, s.smallest_m, s.largest_m,
          [this](double diameter_m) { return per_m2(diameter_m); },
          [](const SeededOctaves::Octave& octave) {
              return std::max(octave.max_m, std::sqrt(1 / octave.per_m2));
          },
          by_place_) {}

double BoulderField::per_m2(double diameter_m) const {
    return factor_ * std::pow(diameter_m, -settings_.exponent);
}

double BoulderField::per_m2_at(Vec3d place, double diameter_m) const {
    double factor = 1;
    if (by_place_) by_place_->find({&place, 1}, {&factor, 1});
    return factor * per_m2(diameter_m);
}

double BoulderField::diameter_m(const SeededOctaves::Thing& thing) const {
    return std::pow(thing.above / factor_, -1 / settings_.exponent);
}

BoulderField::Shaped BoulderField::shaped(const SeededOctaves::Thing& thing) const {
    Shaped b;
    b.place = thing.place;
    b.diameter_m = diameter_m(thing);
    b.turn_rad = kPi * thing.spare;
    const auto shape = thing.words(1);
    b.slim = kSlimFrom + (1 - kSlimFrom) * GroundCells::uniform(shape[0]);
    b.height_m = b.diameter_m * (0.3 + 0.35 * GroundCells::uniform(shape[1])) * b.slim;
    b.bright = 0.85 + 0.4 * GroundCells::uniform(shape[2]);
    for (std::size_t i = 0; i < kPlanes; ++i) {
        const auto plane = thing.words(static_cast<std::uint32_t>(2 + i));
        // Planes lean by 10 to 80 deg, each in its own sector.
        const double turn = 2 * kPi * (static_cast<double>(i) + GroundCells::uniform(plane[0])) / kPlanes,
                     lean = 0.17 + 1.22 * GroundCells::uniform(plane[1]);
        b.plane[i] = {std::sin(lean) * std::cos(turn), std::sin(lean) * std::sin(turn), std::cos(lean)};
        b.plane_at[i] = 0.62 + 0.33 * GroundCells::uniform(plane[2]);
    }
    return b;
}

void BoulderField::find(Vec3d middle, double reach_rad, double smallest_m,
                        std::vector<Boulder>& boulders) const {
    octaves_.visit_within(middle, reach_rad, smallest_m, [&](const SeededOctaves::Thing& thing) {
        if (const Shaped b = shaped(thing); b.diameter_m >= smallest_m) boulders.push_back(b);
    });
}

void BoulderField::add(const GroundPatch& patch) const {
    // A boulder smaller than this many posts is left out.
    constexpr double kPosts = 3;
    octaves_.visit_on(patch, kPosts, 1, [&](const SeededOctaves::Thing& thing) {
        const double radius_m = 0.5 * diameter_m(thing);
        if (length(thing.place - patch.middle) <= patch.reach_rad * 1.001 + radius_m / radius_m_)
            add_one(shaped(thing), patch);
    });
}

void BoulderField::add_one(const Shaped& b, const GroundPatch& patch) const {
    const double radius_m = 0.5 * b.diameter_m;
    const AlongGround axes = axes_along(b.place);
    const Vec3d east = axes.east, north = axes.north;
    const double c = std::cos(b.turn_rad), s = std::sin(b.turn_rad);
    const double per_radius = radius_m_ / radius_m;
    patch.for_each(patch.window(b.place, radius_m / radius_m_), [&](std::size_t i) {
        const Vec3d away = patch.places[i] - b.place;
        if (dot(away, away) * per_radius * per_radius > 1) return;
        const double e = dot(away, east) * per_radius, n = dot(away, north) * per_radius;
        const double x = c * e + s * n, y = (c * n - s * e) / b.slim;
        const double inside = 1 - x * x - y * y;
        if (inside <= 0) return;
        double z = std::sqrt(inside);
        for (std::size_t k = 0; k < kPlanes; ++k)
            z = std::min(z, (b.plane_at[k] - b.plane[k].x * x - b.plane[k].y * y) / b.plane[k].z);
        if (z <= 0) return;
        patch.heights_m[i] += b.height_m * z;
        if (!patch.colors.empty()) patch.colors[i] = static_cast<float>(b.bright) * patch.colors[i];
    });
}

}  // namespace hilcam
