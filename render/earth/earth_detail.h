#pragma once
// Finer levels of a map of the Earth than memory holds, as an interface: tiles that are asked for. Whoever knows the files makes one
// (io/maps/earth_layers.h).
//
// Level 0 is the finest; each further one is half as wide and high, rounded down. Texels are those of EarthMap, whose own finest
// level goes on where these end.

#include <cmath>
#include <cstdint>
#include <span>
#include <string>

#include "render/earth/earth_map.h"

namespace hilcam {

// A tile's level, its column from 180 W and its row from 90 N.
struct DetailKey {
    int level = 0, column = 0, row = 0;
    bool operator==(const DetailKey&) const = default;
};

class EarthDetail {
  public:
    static constexpr int kTile = 128;  // texels along an edge
    // A tile holds the first column and row of its neighbours, too, so that a look between texels needs one tile.
    static constexpr int kSide = kTile + 1;
    static constexpr std::size_t kTexels = std::size_t{kSide} * kSide;

    struct Shape {
        int columns = 2, rows = 1;  // texels of level 0
        int levels = 1;
        float base_level =
            0;  // level of EarthMap at which its texels are as large as those of level 0, below 0

        int columns_at(int level) const { return columns >> level; }
        int rows_at(int level) const { return rows >> level; }
        int tiles_across(int level) const { return (columns_at(level) + kTile - 1) / kTile; }
        int tiles_down(int level) const { return (rows_at(level) + kTile - 1) / kTile; }
    };
    // Returns the levels of a map that are finer than another of `base_rows` rows; levels is 0 where there are none.
    static Shape shape_above(int columns, int rows, int base_rows) {
        const double finer = std::log2(static_cast<double>(rows) / base_rows);
        return {columns, rows, std::max(0, static_cast<int>(std::ceil(finer))), static_cast<float>(-finer)};
    }

    virtual ~EarthDetail() = default;
    const Shape& shape() const { return shape_; }
    // Reads a tile's kTexels, rows from the north; what the files do not say is that of the map below. False: something of it cannot be
    // read. One thread at a time; allocates.
    virtual bool read(const DetailKey& key, const EarthMap& below, std::span<EarthMap::Texel> texels) = 0;
    // Returns the names of the files.
    virtual std::string files() const = 0;

  protected:
    Shape shape_;
};

}  // namespace hilcam
