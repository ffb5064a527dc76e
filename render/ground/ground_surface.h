#pragma once
// The ground of a body as a function of place: heights, colours and other quantities of nested maps. If
// several maps of a kind overlap, the finest counts, blended into the one below at its margin. Where there is
// none, the height is 0 and the factor on the reflectance 1.
//
// Values are interpolated between posts, bilinearly or by cubic convolution (Keys, IEEE Trans. ASSP 29, 1153,
// 1981, a = -1/2), which also passes through the posts. If a footprint is wider than the spacing of posts, a
// pyramid of 2 x 2 means is used. A hole shows the map below it. A pole has the mean of the row beside it.

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "render/ground/ground_pages.h"
#include "render/ground/ground_raster.h"
#include "render/sky/bodies.h"
#include "render/vocabulary/hapke_parameters.h"

namespace hilcam {

// The quantity of a map. Those of Hapke's law are in the order of HapkeParameters; the slope is in degrees.
enum class GroundKind {
    kHeights,
    kAlbedo,
    kRockAbundance,
    kLobeWidth,
    kLobeBackward,
    kSurgeAmplitude,
    kSurgeWidth,
    kSlope
};
inline constexpr std::size_t kGroundKinds = 8;
// Returns the bounds of a quantity, if it has any.
inline std::optional<ParameterLimits> limits_of(GroundKind kind) {
    switch (kind) {
        case GroundKind::kHeights:
        case GroundKind::kAlbedo:
            break;
        case GroundKind::kRockAbundance:
            return ParameterLimits{0, 0.5};
        case GroundKind::kLobeWidth:
            return kLobeWidthLimits;
        case GroundKind::kLobeBackward:
            return kLobeBackwardLimits;
        case GroundKind::kSurgeAmplitude:
            return kSurgeAmplitudeLimits;
        case GroundKind::kSurgeWidth:
            return kSurgeWidthLimits;
        case GroundKind::kSlope:
            return kSlopeLimits_deg;
    }
    return {};
}
inline bool is_of_hapke(GroundKind kind) { return kind >= GroundKind::kLobeWidth; }
enum class GroundBetween { kBilinear, kCubic };

struct GroundMap {
    std::unique_ptr<GroundRaster> raster;
    GroundKind kind = GroundKind::kHeights;
    GroundBetween between = GroundBetween::kBilinear;
    double blend_m = 0;  // width of the margin in which it blends into the map below
};

// One thread at a time.
class GroundSurface {
  public:
    GroundSurface(const Figure& figure, std::vector<GroundMap> maps, std::size_t max_bytes);

    const Figure& figure() const { return figure_; }
    // Finds the heights above the ellipsoid [m] of places, averaged over about a footprint.
    void find_heights(std::span<const Vec3d> places, double footprint_m, std::span<double> heights_m);
    // Finds the factors on the material's reflectance: linear red, green, blue.
    void find_colors(std::span<const Vec3d> places, double footprint_m, std::span<Vec3f> colors);
    // Finds a quantity with one channel, within its bounds. Places without a map keep the given values.
    void find_figures(GroundKind kind, std::span<const Vec3d> places, double footprint_m,
                      std::span<double> figures);
    // Finds the parameters of Hapke's law. Places without a map keep the given values.
    void find_hapke(std::span<const Vec3d> places, double footprint_m, std::span<HapkeParameters> hapke);
    // Returns the spacing of the finest map of heights; a very large number if there is none.
    double finest_m() const {
        const std::vector<Layer>& heights = layers_of(GroundKind::kHeights);
        return heights.empty() ? 1e30 : heights.front().map.raster->shape().spacing_m;
    }
    bool has(GroundKind kind) const { return !layers_of(kind).empty(); }
    bool has_hapke() const;
    // Returns the point of the body at a height above a place, in its axes.
    Vec3d point(Vec3d place, double height_m) const;
    const GroundPages& pages() const { return pages_; }

  private:
    // The 4 x 4 posts around a place; the next place often has the same ones.
    struct Posts {
        int level = -1, column = 0, row = 0;  // those of the second post in the second row
        std::array<Vec3d, 16> values{};
        std::array<bool, 16> known{}, there{};  // `known`: was read; `there`: is not a hole
    };
    struct Layer {
        GroundMap map;
        std::uint32_t key;
        int levels;
        std::map<std::pair<int, int>, Vec3d> pole_means{};  // by level and row
        Posts posts{};
    };
    Figure figure_;
    GroundPages pages_;
    std::array<std::vector<Layer>, kGroundKinds> layers_;  // by kind, each from fine to coarse
    std::vector<Vec2d> posts_;

    struct Sample {
        Vec3d value;
        double weight = 0;  // 0: a hole, or outside the map
    };
    const std::vector<Layer>& layers_of(GroundKind kind) const {
        return layers_[static_cast<std::size_t>(kind)];
    }
    Sample sample(Layer& layer, Vec2d post, int level);
    bool pole_mean(Layer& layer, int level, int row, Vec3d& mean);
    bool value_at(Layer& layer, int level, int column, int row, Vec3d& value);
    template <class Add>
    void visit(GroundKind kind, std::span<const Vec3d> places, double footprint_m, const Add& add);
};

}  // namespace hilcam
