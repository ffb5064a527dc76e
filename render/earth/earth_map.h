#pragma once
// A map of the Earth's surface and clouds: eight values per texel on an equirectangular grid (left edge 180
// W, top 90 N, geodetic), with mip levels, and averages over a footprint on the ground.
//
// Texels are bytes; light values are stored as square roots, so that dark ground keeps its precision. Each
// coarser level is the mean of the finer one in linear values.

#include <array>
#include <cstdint>
#include <vector>

namespace hilcam {

// Means over a footprint.
struct EarthSample {
    enum Channel { kBlue, kGreen, kRed, kInfrared, kWater, kCloud, kCloudTop, kLights, kChannels };
    static constexpr float kHighestTop_m = 16000;

    alignas(32) std::array<float, kChannels> value{};

    // Returns the land's reflectance in a band of land.h, 0..1; zero if all is sea.
    float land(int band) const { return value[static_cast<std::size_t>(band)]; }
    float water() const { return value[kWater]; }  // share of the ground, 0..1
    float cloud() const { return value[kCloud]; }  // b tau / (1 + b tau), see cloud_table.h, 0..1
    float cloud_top_m() const { return kHighestTop_m * value[kCloudTop]; }
    float lights() const { return value[kLights]; }  // relative to the brightest, 0..1
};

// The sides of a parallelogram on the ground, as shares of the map: u of its width, v of its height.
struct MapFootprint {
    float u1 = 0, v1 = 0, u2 = 0, v2 = 0;
};

class EarthMap {
  public:
    using Texel = std::array<std::uint8_t, EarthSample::kChannels>;
    struct Level {
        int width = 0, height = 0;
        std::vector<Texel> texels;  // rows from the north
    };
    // The height of the finest level is a power of two up to this; its width is twice that.
    static constexpr int kMaxHeight = 16384;

    EarthMap() = default;
    // levels: from the finest on, each with half the width and height, to 2 x 1. HILCAM_CHECK: sizes.
    explicit EarthMap(std::vector<Level> levels);
    // Makes all levels from the finest one.
    static std::vector<Level> halves(Level finest);
    // Returns a sample's codes.
    static Texel coded(const EarthSample& sample);
    // Adds the bilinear mean of four neighbours, times weight: upper left, upper right, lower left, lower
    // right; right, down: 0..1.
    static void mix_texels(const std::array<const Texel*, 4>& corner, float right, float down, float weight,
                           EarthSample& sum);

    bool empty() const { return levels_.empty(); }
    int width() const { return levels_.front().width; }
    int height() const { return levels_.front().height; }
    std::size_t bytes() const;
    const Level& finest() const { return levels_.front(); }

    // Returns the means over a footprint. u: 0 at 180 W, wraps around; v: 0 at the north pole, clamped at the
    // poles. Several lookups along the longer axis of the footprint, each as wide as the shorter (McCormack
    // et al., SIGGRAPH 99). Loop, any thread.
    EarthSample sample(float u, float v, const MapFootprint& footprint) const;
    // The same for a round footprint; `width` is a share of the map's height.
    EarthSample sample(float u, float v, float width) const;
    // Adds one round lookup, times weight. level: number of halvings of the finest map; 0: a texel wide.
    // Loop, any thread.
    void add_at_level(float u, float v, float level, float weight, EarthSample& sum) const;
    // Returns the mean over the sphere.
    EarthSample mean() const;

  private:
    std::vector<Level> levels_;
};

}  // namespace hilcam
