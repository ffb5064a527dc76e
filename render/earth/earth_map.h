#pragma once
// A map of the Earth's surface and clouds: eight values a texel on an equirectangular grid (left edge 180 W, top
// 90 N, geodetic), each with its halves, and what a footprint on the ground sees of it.
//
// Texels are bytes; light values are coded as square roots, so that dark ground keeps its digits. Each coarser
// level is the mean of the finer one in the values' own scale.

#include <array>
#include <cstdint>
#include <vector>

namespace hilcam {

// Means over a footprint.
struct EarthSample {
    enum Channel { kBlue, kGreen, kRed, kInfrared, kWater, kCloud, kCloudTop, kLights, kChannels };
    static constexpr float kHighestTop_m = 16000;

    alignas(32) std::array<float, kChannels> value{};

    // Reflectance of the land in the bands of land.h, 0..1; zero where all is sea.
    float land(int band) const { return value[static_cast<std::size_t>(band)]; }
    float water() const { return value[kWater]; }  // share of the ground, 0..1
    float cloud() const { return value[kCloud]; }  // b tau / (1 + b tau), as cloud_table.h has it, 0..1
    float cloud_top_m() const { return kHighestTop_m * value[kCloudTop]; }
    float lights() const { return value[kLights]; }  // share of the brightest, 0..1
};

// A parallelogram's sides on the ground, seen as shares of the map: u of its width, v of its height.
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
    // From the finest on, each half as wide and high as the one before, to 2 x 1. HILCAM_CHECK: sizes.
    explicit EarthMap(std::vector<Level> levels);
    // Levels of which the finest alone is given.
    static std::vector<Level> halves(Level finest);
    // Returns a sample's codes.
    static Texel coded(const EarthSample& sample);
    // Adds what four neighbours are between them, times weight: upper left, upper right, lower left, lower right; right, down: 0..1.
    static void mix_texels(const std::array<const Texel*, 4>& corner, float right, float down, float weight,
                           EarthSample& sum);

    bool empty() const { return levels_.empty(); }
    int width() const { return levels_.front().width; }
    int height() const { return levels_.front().height; }
    std::size_t bytes() const;
    const Level& finest() const { return levels_.front(); }

    // u: 0 at 180 W, wraps around; v: 0 at the north pole, held at the poles. Several looks along the longer axis
    // of the footprint, each as wide as the shorter (McCormack et al., SIGGRAPH 99). Loop, any thread.
    EarthSample sample(float u, float v, const MapFootprint& footprint) const;
    // The same for a footprint that is round: `width`, share of the map's height.
    EarthSample sample(float u, float v, float width) const;
    // Adds one round look, times weight. level: halves of the finest map's texels, 0: a texel wide. Loop, any thread.
    void add_at_level(float u, float v, float level, float weight, EarthSample& sum) const;
    // Mean over the sphere.
    EarthSample mean() const;

  private:
    std::vector<Level> levels_;
};

}  // namespace hilcam
