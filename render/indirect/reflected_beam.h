#pragma once
// The beams of light from flat mirrors (mirror_sunlight.h), one for each. Nearly all places are in no beam,
// so the test has to be cheap: one mirror against many places, and many mirrors against a box of places.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/vocabulary/vec.h"

namespace hilcam {

// Ray space, metres. A place is in the beam if it is farther than min_m from the mirror's plane, along the
// beam, and sees the Sun's middle inside the mirror's rectangle extended by a margin that grows with the
// distance.
struct ReflectedBeam {
    // A linear function of a place.
    struct Line {
        Vec3f by_place;
        float constant = 0;
    };
    Line distance{}, x{},
        y{};  // coordinates on the mirror, along its sides, where a place sees the Sun's middle
    float min_m = 0, width_m = 0, height_m = 0;
    Vec2f margin{}, margin_m{};  // margin per distance, and margin at the mirror
};

// Places side by side.
struct BeamPlaces {
    static constexpr std::size_t kMax = 256;
    alignas(64) std::array<float, kMax> x, y, z;
    alignas(64) std::array<std::uint8_t, kMax> in_beam;  // 1: in the beam
};
// Sets in_beam of all kMax places. Loop, any thread.
void find_places_in_beam(const ReflectedBeam& beam, BeamPlaces& places);

// A box along the axes.
struct PlaceBox {
    Vec3f middle_m, half_m;
};

// Beams side by side.
class ReflectedBeams {
  public:
    static constexpr std::size_t kTogether = 64;

    // Allocates memory. Owner thread.
    void reserve(std::size_t beams) { blocks_.reserve((beams + kTogether - 1) / kTogether); }
    // Loop; no allocation while there is room.
    void clear() { blocks_.clear(), count_ = 0; }
    void add(const ReflectedBeam& beam);

    std::size_t blocks() const { return blocks_.size(); }
    // Finds the beams of a block (numbers 64 x block and on) that may meet the box, and sets 1 in `meets`. It
    // may report beams that do not meet it, but misses none in which find_places_in_beam() finds a place of
    // the box. Loop, any thread.
    void find(const PlaceBox& box, std::size_t block, std::array<std::uint8_t, kTogether>& meets) const;

  private:
    using Numbers = std::array<float, kTogether>;
    struct Lines {
        Numbers by_x, by_y, by_z, constant;
    };
    struct alignas(64) Block {
        Lines distance, x, y;
        Numbers min_m, width_m, height_m, margin_x, margin_y, margin_x_m, margin_y_m;
    };
    std::vector<Block> blocks_;
    std::size_t count_ = 0;

    static void find_in(const Block& block, const PlaceBox& box, std::array<std::uint8_t, kTogether>& meets);
};

}  // namespace hilcam
