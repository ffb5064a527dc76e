#pragma once
// Tiles of the Earth's finer levels in memory of fixed size, and lookups in them. A frame sees only tiles
// that were chosen for it (choose()), whatever else is left from earlier frames. A lookup that needs another
// tile uses the next coarser level, and finally the map below.

#include <cstdint>
#include <vector>

#include "render/earth/earth_detail.h"

namespace hilcam {

class DetailTiles {
  public:
    // most: number of tiles in memory, at least one.
    DetailTiles(const EarthDetail::Shape& shape, std::size_t most);

    const EarthDetail::Shape& shape() const { return shape_; }
    std::size_t most() const { return slots_.size(); }
    std::size_t bytes() const { return texels_.size() * sizeof(EarthMap::Texel); }

    // --- between frames. One thread.

    bool has(const DetailKey& key) const { return find(word_of(key)) != kNone; }
    // Starts a frame without tiles.
    void begin_frame() { ++frame_; }
    // Makes a tile visible to the frame; returns false if it is not in memory.
    bool choose(const DetailKey& key);
    // Frees the place of the tile that has not been visible for longest, but not one of this frame, and
    // returns the place. It belongs to no tile until put(). Returns kNone if all are visible.
    static constexpr std::size_t kNone = ~std::size_t{0};
    std::size_t take_place();
    std::span<EarthMap::Texel> texels_of(std::size_t place) {
        return {texels_.data() + place * EarthDetail::kTexels, EarthDetail::kTexels};
    }
    // Assigns a tile to a place. is_whole: false if it could not be read; lookups then use a coarser level.
    void put(std::size_t place, const DetailKey& key, bool is_whole);

    // --- in a frame. Loop, any thread.

    // Looks up as EarthMap::sample() does; `below` is the map that continues where these levels end.
    EarthSample sample(const EarthMap& below, float u, float v, const MapFootprint& footprint) const;
    EarthSample sample(const EarthMap& below, float u, float v, float width) const;

  private:
    struct Slot {
        std::uint64_t word = 0;  // 0: empty
        std::uint64_t seen = 0;  // number of the last frame that used it
        bool is_taken = false;   // between take_place() and put()
        bool is_whole = false;
    };
    EarthDetail::Shape shape_;
    std::vector<Slot> slots_;
    std::vector<EarthMap::Texel> texels_;
    // Places by word, with open addressing; kFree: none.
    static constexpr std::uint32_t kFree = ~std::uint32_t{0};
    std::vector<std::uint32_t> table_;
    std::uint64_t frame_ = 1;

    static std::uint64_t word_of(const DetailKey& key) {
        return std::uint64_t{1} << 63 | static_cast<std::uint64_t>(key.level) << 56 |
               static_cast<std::uint64_t>(key.row) << 28 | static_cast<std::uint64_t>(key.column);
    }
    std::size_t first_of(std::uint64_t word) const {
        // Fibonacci hashing (Knuth, The Art of Computer Programming 3, 6.4).
        return static_cast<std::size_t>((word * 0x9e3779b97f4a7c15u) >> 32) & (table_.size() - 1);
    }
    std::size_t find(std::uint64_t word) const;
    void insert(std::size_t place);
    const EarthMap::Texel* seen(int level, int column, int row) const;
    void add(const EarthMap& below, float u, float v, float level, float weight, EarthSample& sum) const;
    void add_at(const EarthMap& below, float u, float v, int level, float weight, EarthSample& sum) const;
};

}  // namespace hilcam
