// Invented clouds: noise of many sizes, stretched along the parallels and distorted by its own large shapes.
// Their cover is roughly that of the mean Earth at each latitude (0.5 in the subtropics, 0.85 over the
// southern ocean: Stubenrauch et al., Bull. Am. Meteorol. Soc. 94, 1031, 2013, whose mean is 0.68).

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "render/earth/earth_model.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Returns a number in [0, 1) for a corner of the lattice (splitmix64: Steele, Lea & Flood, OOPSLA 2014).
double lattice(std::uint64_t seed, int x, int y, int z) {
    std::uint64_t h = seed * 0x9e3779b97f4a7c15u + static_cast<std::uint32_t>(x) * 0x8da6b343u +
                      static_cast<std::uint64_t>(static_cast<std::uint32_t>(y)) * 0xd8163841u +
                      (static_cast<std::uint64_t>(static_cast<std::uint32_t>(z)) << 32);
    h = (h ^ h >> 30) * 0xbf58476d1ce4e5b9u;
    h = (h ^ h >> 27) * 0x94d049bb133111ebu;
    return static_cast<double>((h ^ h >> 31) >> 11) * 0x1p-53;
}

double noise(std::uint64_t seed, Vec3d p) {
    const double fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
    const int x = static_cast<int>(fx), y = static_cast<int>(fy), z = static_cast<int>(fz);
    const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
    const double u = smooth(p.x - fx), v = smooth(p.y - fy), w = smooth(p.z - fz);
    double sum = 0;
    for (int i = 0; i < 8; ++i)
        sum += (i & 1 ? u : 1 - u) * (i & 2 ? v : 1 - v) * (i & 4 ? w : 1 - w) *
               lattice(seed, x + (i & 1), y + (i >> 1 & 1), z + (i >> 2));
    return sum - 0.5;
}

double octaves(std::uint64_t seed, Vec3d p, int count) {
    double sum = 0, size = 1;
    for (int i = 0; i < count; ++i, size *= 0.55)
        sum += size * noise(seed + static_cast<std::uint64_t>(i), std::exp2(i) * p);
    return sum;
}

}  // namespace

EarthMap seeded_clouds(std::uint64_t seed, int height) {
    EarthMap::Level level{2 * height, height, {}};
    level.texels.resize(static_cast<std::size_t>(level.width) * static_cast<std::size_t>(height));
    tbb::parallel_for(0, height, [&](int row) {
        const double latitude = kPi * (0.5 - (row + 0.5) / height), degrees = latitude / kDegree_rad;
        const auto bump = [&](double middle, double width) {
            return std::exp(-(degrees - middle) * (degrees - middle) / (width * width));
        };
        const double cover = 0.5 + 0.2 * bump(4, 8) + 0.25 * bump(58, 20) + 0.35 * bump(-60, 18);
        for (int column = 0; column < level.width; ++column) {
            const double longitude = 2 * kPi * (column + 0.5) / level.width;
            const Vec3d n{std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
                          std::sin(latitude)};
            const Vec3d curl{octaves(seed + 11, 3.0 * n, 3), octaves(seed + 23, 3.0 * n, 3),
                             octaves(seed + 37, 3.0 * n, 3)};
            const Vec3d p = n + 0.35 * curl;
            const double large = octaves(seed + 51, 4.0 * Vec3d{p.x, p.y, 1.8 * p.z}, 3);
            const double fine = octaves(seed + 71, 24.0 * p, 6);
            const double dense = large + 0.45 * fine + 0.9 * (cover - 0.62);
            const double c = std::clamp(1.6 * (dense + 0.08), 0.0, 1.0);
            EarthMap::Texel& texel =
                level.texels[static_cast<std::size_t>(row) * static_cast<std::size_t>(level.width) +
                             static_cast<std::size_t>(column)];
            texel[EarthSample::kCloud] = static_cast<std::uint8_t>(std::lround(255 * 0.85 * c));
            texel[EarthSample::kCloudTop] = static_cast<std::uint8_t>(std::lround(255 * (2 + 8 * c) / 16));
        }
    });
    return EarthMap(EarthMap::halves(std::move(level)));
}

}  // namespace hilcam
