#pragma once
// Maps of the Earth for tests, and finer levels of them by tiles.

#include <atomic>
#include <random>
#include <set>

#include "render/earth/earth_detail.h"

namespace hilcam {

// Grey land by chance in each texel, and water by chance.
inline EarthMap noise_map(int height) {
    std::mt19937 random(7);
    EarthMap::Level level{2 * height, height, {}};
    for (int i = 0; i < 2 * height * height; ++i) {
        const auto grey = static_cast<std::uint8_t>(random() % 200);
        EarthMap::Texel texel{grey, grey, grey, grey};
        texel[EarthSample::kWater] = static_cast<std::uint8_t>(random() % 256);
        level.texels.push_back(texel);
    }
    return EarthMap(EarthMap::halves(std::move(level)));
}

// The same map without its finest levels.
inline EarthMap coarser(const EarthMap& map, int levels) {
    std::vector<EarthMap::Level> all = EarthMap::halves(map.finest());
    all.erase(all.begin(), all.begin() + levels);
    return EarthMap(std::move(all));
}

// The finest levels of a map that is in memory. Tiles in `damaged` cannot be read.
class WholeDetail : public EarthDetail {
  public:
    WholeDetail(const EarthMap& map, int base_rows) : levels_(EarthMap::halves(map.finest())) {
        shape_ = shape_above(map.width(), map.height(), base_rows);
    }
    bool read(const DetailKey& key, const EarthMap&, std::span<EarthMap::Texel> texels) override {
        ++reads;
        const EarthMap::Level& level = levels_[static_cast<std::size_t>(key.level)];
        std::size_t i = 0;
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                const int column = (key.column * kTile + x) % level.width,
                          row = std::min(key.row * kTile + y, level.height - 1);
                texels[i++] = level.texels[static_cast<std::size_t>(row * level.width + column)];
            }
        return !damaged.contains({key.level, key.column, key.row});
    }
    std::string files() const override { return "whole.tif"; }

    std::set<std::array<int, 3>> damaged;
    std::atomic<int> reads{0};

  private:
    std::vector<EarthMap::Level> levels_;
};

// Water from nothing at the north pole to all at the south pole.
class RampDetail : public EarthDetail {
  public:
    RampDetail(int columns, int rows, int base_rows) { shape_ = shape_above(columns, rows, base_rows); }
    bool read(const DetailKey& key, const EarthMap&, std::span<EarthMap::Texel> texels) override {
        std::size_t i = 0;
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                const double south =
                    std::min(1.0, std::ldexp(key.row * kTile + y + 0.5, key.level) / shape_.rows);
                texels[i] = {};
                texels[i++][EarthSample::kWater] = static_cast<std::uint8_t>(std::lround(255 * south));
            }
        return true;
    }
    std::string files() const override { return "ramp.tif"; }
};

}  // namespace hilcam
