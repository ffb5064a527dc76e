#include "render/ground/rock_abundance.h"

#include <algorithm>

namespace hilcam {
namespace {

// Such maps have posts of 200 m or more, so a few pages suffice.
constexpr std::size_t kBytes = std::size_t{16} << 20;

}  // namespace

RockAbundance::RockAbundance(const Figure& figure, std::vector<GroundMap> maps, double elsewhere,
                             double seeded)
    : surface_(figure, std::move(maps), kBytes), elsewhere_(elsewhere), seeded_(seeded) {}

void RockAbundance::find(std::span<const Vec3d> places, std::span<double> factors) const {
    const std::lock_guard lock(mutex_);
    std::fill(factors.begin(), factors.end(), elsewhere_);
    surface_.find_figures(GroundKind::kRockAbundance, places, 0, factors);
    for (double& factor : factors) factor /= seeded_;
}

}  // namespace hilcam
