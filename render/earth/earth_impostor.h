#pragma once
// An impostor: a picture of the whole Earth from one place under one Sun, kept for cameras of any attitude
// near that place. A pixel costs a few tens of nanoseconds instead of microseconds.
//
// Light is stored in rings around the Earth's middle, slightly closer than the camera's pixels and three
// times as close where ground changes to air, and interpolated linearly. z is stretched so that the Earth is
// a sphere. A ring is identified by how close its rays would come to the middle if they were straight. The
// air bends them, so the ground ends at a radius R above the sphere's; the limb is at R for every camera.
//
// Cameras and Suns are rounded to a grid (Key) that does not depend on earlier frames: a frame depends only
// on its own place and time. A camera off the grid looks up by the place on the ground (Tile), so coasts are
// where they belong; the light is off by up to half a step in both angles.
// ShippedEarth.IsKeptAsAPictureThatIsBetterThanARayAPixel measures that error in units of sensor noise.
//
// Light is for the Sun at 1 AU. Frames scale all of it, including that of cities, which is up to 3.4 % too
// bright. Not included: other bodies behind the air, eclipses (EarthModel::add() has both).

#include <atomic>
#include <cstdint>
#include <vector>

#include "render/earth/earth_model.h"

namespace hilcam {

class EarthImpostor {
  public:
    // Grid steps from zero.
    struct Key {
        std::array<std::int32_t, 3> camera{};  // longitude, latitude, logarithm of distance
        std::array<std::int32_t, 2> sun{};     // longitude, latitude
        std::array<std::int32_t, 2> maps{};    // numbers of the clouds' and the ground's map
        bool operator==(const Key&) const = default;
    };
    // camera_m, sun_dir: in the Earth's axes. numbers: from EarthModel::numbers_at(). Loop.
    static Key key_of(Vec3d camera_m, Vec3d sun_dir, MapNumbers numbers = {});
    // True when an impostor is worthwhile: the camera is so far away that it rarely needs a new one, and the
    // disk is neither a few pixels wide nor too large for its memory. Loop.
    static bool is_for(Vec3d camera_m, double pixel_rad);

    // pixel_rad: of the camera. top_m: the height up to which there is light. edge_m: the apparent height at
    // which the ground ends (EarthModel::seen_height_m).
    EarthImpostor(double pixel_rad, double top_m, double edge_m);
    // Starts a picture; none of its pieces is made yet. Loop; no allocation.
    void begin(const Key& key);
    // Computes, on all threads of the arena, the pieces that no other caller works on. The picture is
    // complete when all callers have returned. Loop, any thread; no allocation. sun_irradiance_1au: [W m^-2
    // um^-1].
    void make_rest(const EarthModel& earth, const Spectrum& sun_irradiance_1au_w_m2_um);
    // Allocates as much memory as another picture uses, so that making a similar one needs none. Loop; no
    // further allocation.
    void take_memory_as(const EarthImpostor& other) { take_memory(other.used_); }
    std::size_t bytes() const { return light_.size() * sizeof(Coded); }

    // A square of a camera's picture. Places in it are biquadratic, through those of its corners, edge
    // middles and centre.
    struct Tile {
        std::array<float, 9> across, down;  // by powers of x and y
    };
    static constexpr int kNodes = 3;
    // camera_m: the camera's own position, which belongs to the key. dirs: rays of any length at x, y = 0,
    // 1/2, 1 of the square, row by row. They must be within a radian of the Earth's middle: at a right angle
    // there is no place, and behind the camera there is a false one.
    Tile tile(Vec3d camera_m, const std::array<Vec3d, kNodes * kNodes>& dirs) const;

    static constexpr std::size_t kCount = 16;
    using Floats = std::array<float, kCount>;
    // The places in memory for squares of 4 x 4 px. They are far apart, so they are prefetched.
    struct Squares {
        std::array<const void*, kCount> middle;
        std::array<std::size_t, kCount> column_bytes;
        // Prefetches a square's places. Loop, any thread.
        void fetch(std::size_t square) const;
    };
    // x, y: the squares' middles in a tile, 0 to 1. Loop, any thread.
    void find_squares(const Tile& tile, const Floats& x, const Floats& y, Squares& squares) const;
    // At the limb a look averages four places of a pixel, 0.75 px apart at most, each between two rings.
    static constexpr int kLimbRows = 6;
    using LimbRows = std::array<float, kLimbRows>;  // weights
    // Returns the radiance for the Sun at 1 AU [W m^-2 sr^-1 um^-1] at places of a tile, x and y from 0 to 1.
    // share: the part of a pixel's width that each represents, 0..1. Loop, any thread.
    void look(const Tile& tile, const Floats& x, const Floats& y, std::size_t count, float share,
              std::array<Spectrum, kCount>& radiance) const;

  private:
    // Rings with the same number of columns. Neighbouring bands share a ring, so that a look needs one band.
    // Columns are stored one after the other, so that a tile of a camera's picture needs few pages.
    struct Band {
        float first, per_step;  // row = (b - first) per_step, with b: closest approach over the radius
        int rows, columns;      // the first column is repeated after the last
        std::size_t offset;

        int runs() const;  // number of pieces of each ring
    };

    double pixel_rad_, top_m_;
    double radius_m_;  // R
    Vec3d camera_m_, sun_dir_;
    MapNumbers numbers_;
    double distance_m_ = 1;       // stretched
    Vec3d ahead_, right_, down_;  // stretched axes, unit
    std::vector<Band> bands_;     // the last is at the limb
    float limb_from_ = 0, dark_from_ = 0, pixel_ = 0, inner_per_b_ = 0;
    // Floats without sign, lowest digits and most of the exponent (coded()).
    using Coded = std::array<std::uint16_t, kMaxBins>;
    std::vector<Coded> light_;
    std::size_t used_ = 0;
    // A piece is a run of columns of one ring, so that waiting for one is shorter than for a whole ring.
    // Pieces are taken in order.
    int pieces_ = 0;
    std::atomic<int> next_piece_{0};

    void take_memory(std::size_t used);
    void place_bands();
    void make_piece(const EarthModel& earth, const Spectrum& irradiance, int piece);
    void fill_run(const EarthModel& earth, const Spectrum& irradiance, const Band& band, int row, int first);
    // The row and column before a place, and its fractional position behind them, 0..1.
    struct Spot {
        const Band& band;
        std::size_t row, column;
        float in_row, in_column;
        bool limb, dark;
        const Coded* of(const std::vector<Coded>& light) const {
            return light.data() + band.offset + column * static_cast<std::size_t>(band.rows) + row;
        }
    };
    Spot spot_of(float b, float turn) const;
    std::size_t weigh_limb(float b, float share, LimbRows& by_row) const;
    Vec3d to_place(Vec3d stretched_m) const;
};

}  // namespace hilcam
