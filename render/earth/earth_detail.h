#pragma once
// Levels of a map of the Earth that are too fine for memory, as an interface: they are read in tiles on
// demand. The reader of the files implements it (io/maps/earth_layers.h).
//
// Level 0 is the finest; each further level has half the width and height, rounded down. Texels are those of
// EarthMap, whose finest level continues where these end.

#include <cmath>
#include <cstdint>
#include <span>
#include <string>

#include "render/earth/earth_map.h"

namespace hilcam {

// A tile: its level, its column from 180 W and its row from 90 N.
struct DetailKey {
    int level = 0, column = 0, row = 0;
    bool operator==(const DetailKey&) const = default;
};

class EarthDetail {
  public:
    static constexpr int kTile = 128;  // texels along an edge
    // A tile includes the first column and row of its neighbours, so that interpolation needs one tile.
    static constexpr int kSide = kTile + 1;
    static constexpr std::size_t kTexels = std::size_t{kSide} * kSide;

    struct Shape {
        int columns = 2, rows = 1;  // texels of level 0
        int levels = 1;
        float base_level =
            0;  // the level of EarthMap, below 0, at which texels are as large as those of level 0 here

        int columns_at(int level) const { return columns >> level; }
        int rows_at(int level) const { return rows >> level; }
        int tiles_across(int level) const { return (columns_at(level) + kTile - 1) / kTile; }
        int tiles_down(int level) const { return (rows_at(level) + kTile - 1) / kTile; }
    };
    // Returns the levels of a map that are finer than another map of `base_rows` rows; levels is 0 if there
    // are none.
    static Shape shape_above(int columns, int rows, int base_rows) {
        const double finer = std::log2(static_cast<double>(rows) / base_rows);
        return {columns, rows, std::max(0, static_cast<int>(std::ceil(finer))), static_cast<float>(-finer)};
    }

    virtual ~EarthDetail() = default;
    const Shape& shape() const { return shape_; }
    // Reads the kTexels of a tile, rows from the north; values missing in the files come from the map below.
    // Returns false if part of it cannot be read. One thread at a time; allocates.
    virtual bool read(const DetailKey& key, const EarthMap& below, std::span<EarthMap::Texel> texels) = 0;
    // Returns the names of the files.
    virtual std::string files() const = 0;

  protected:
    Shape shape_;
};

}  // namespace hilcam
