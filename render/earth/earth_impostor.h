#pragma once
// An impostor: a picture of the whole Earth from one place under one Sun, kept to be seen by cameras of any attitude about there:
// a few tens of nanoseconds a pixel instead of microseconds.
//
// Light lies in rings about the Earth's middle, somewhat closer than the camera's pixels, and three times as close
// where ground ends and air goes on, linear between them. In space with z stretched so that the Earth is a sphere, a ring is told by
// its rays' closest approach to the middle if they went on straight, so the limb of each camera falls onto the radius R at which the air, which
// bends them, has the ground end.
//
// Cameras and Suns belong to a grid of whole steps (Key), never to what was shown before: a frame is a function of its own
// place and time. What a camera off the grid's place sees is looked for by the place on the ground (Tile), so coasts stay
// where they are; what is off is light by up to half a step of both angles. How much that is, in units of
// sensor noise: ShippedEarth.IsKeptAsAPictureThatIsBetterThanARayAPixel.
//
// Light is for the Sun at 1 AU; frames scale it, that of cities with it, by up to 3.4 % too much. What it does not hold: other bodies behind
// the air, eclipses (EarthModel::add() has both).

#include <atomic>
#include <cstdint>
#include <vector>

#include "render/earth/earth_model.h"

namespace hilcam {

class EarthImpostor {
  public:
    // Steps from zero.
    struct Key {
        std::array<std::int32_t, 3> camera{};  // longitude, latitude, logarithm of distance
        std::array<std::int32_t, 2> sun{};     // longitude, latitude
        std::array<std::int32_t, 2> maps{};    // numbers of the clouds' and of the ground's map
        bool operator==(const Key&) const = default;
    };
    // camera_m, sun_dir: in the Earth's axes; numbers: EarthModel::numbers_at(). Loop.
    static Key key_of(Vec3d camera_m, Vec3d sun_dir, MapNumbers numbers = {});
    // A picture is worth while: the camera is far enough that it is seldom made anew, and the disk is neither a few pixels nor larger
    // than there is room for. Loop.
    static bool is_for(Vec3d camera_m, double pixel_rad);

    // pixel_rad: the camera's. top_m: the height up to which there is light. edge_m: the height at which the ground ends
    // (EarthModel::seen_height_m).
    EarthImpostor(double pixel_rad, double top_m, double edge_m);
    // Begins a picture: begun, none of its pieces is made. Loop; allocates nothing.
    void begin(const Key& key);
    // Works out, on all threads of the arena, the pieces that nobody is at; the picture is there when all who called this
    // have returned. Loop, any thread; allocates nothing. sun_irradiance_1au: [W m^-2 um^-1].
    void make_rest(const EarthModel& earth, const Spectrum& sun_irradiance_1au_w_m2_um);
    // Takes as much memory as a picture that is made, so that making one like it needs none. Loop; allocates nothing.
    void take_memory_as(const EarthImpostor& other) { take_memory(other.used_); }
    std::size_t bytes() const { return light_.size() * sizeof(Coded); }

    // A square of a camera's picture. Places in it are parabolas, both ways, through those of its corners, middles and centre.
    struct Tile {
        std::array<float, 9> across, down;  // by powers of x and y
    };
    static constexpr int kNodes = 3;
    // camera_m: the camera's own place, one that the key is of; dirs: rays of any length at x, y = 0, 1/2, 1 of the square, row by row.
    // They lie within a radian of the Earth's middle: at a right angle to it there is no place, and behind the camera one too many.
    Tile tile(Vec3d camera_m, const std::array<Vec3d, kNodes * kNodes>& dirs) const;

    static constexpr std::size_t kCount = 16;
    using Floats = std::array<float, kCount>;
    // The places in memory where squares of 4 x 4 px are looked up. They are far apart, so that they are asked for beforehand.
    struct Squares {
        std::array<const void*, kCount> middle;
        std::array<std::size_t, kCount> column_bytes;
        // Asks for a square's places. Loop, any thread.
        void fetch(std::size_t square) const;
    };
    // x, y: the squares' middles in a tile, 0 to 1. Loop, any thread.
    void find_squares(const Tile& tile, const Floats& x, const Floats& y, Squares& squares) const;
    // A look at the limb takes four places of a pixel, 0.75 px apart at most, each between two rings.
    static constexpr int kLimbRows = 6;
    using LimbRows = std::array<float, kLimbRows>;  // their weights
    // Radiance for the Sun at 1 AU [W m^-2 sr^-1 um^-1] at places of a tile, x and y from 0 to 1. share: of a pixel's width that each
    // stands for, 0..1. Loop, any thread.
    void look(const Tile& tile, const Floats& x, const Floats& y, std::size_t count, float share,
              std::array<Spectrum, kCount>& radiance) const;

  private:
    // Rings with as many columns each; neighbours share one, so that a look needs one band. Columns lie one behind the other, so that
    // what a tile of a camera's picture looks at is in a few pages.
    struct Band {
        float first, per_step;  // row = (b - first) per_step, b: closest approach over the radius
        int rows, columns;      // the first column is stored once more behind the last
        std::size_t offset;

        int runs() const;  // number of pieces of each ring
    };

    double pixel_rad_, top_m_;
    double radius_m_;  // R
    Vec3d camera_m_, sun_dir_;
    MapNumbers numbers_;
    double distance_m_ = 1;       // stretched
    Vec3d ahead_, right_, down_;  // stretched axes, unit
    std::vector<Band> bands_;     // the last is the limb's
    float limb_from_ = 0, dark_from_ = 0, pixel_ = 0, inner_per_b_ = 0;
    // Floats without their sign, lowest digits and most of their exponent (coded()).
    using Coded = std::array<std::uint16_t, kMaxBins>;
    std::vector<Coded> light_;
    std::size_t used_ = 0;
    // Pieces are a run of columns of a ring each, so that who waits for one does not wait for a whole ring. They are taken
    // in order.
    int pieces_ = 0;
    std::atomic<int> next_piece_{0};

    void take_memory(std::size_t used);
    void place_bands();
    void make_piece(const EarthModel& earth, const Spectrum& irradiance, int piece);
    void fill_run(const EarthModel& earth, const Spectrum& irradiance, const Band& band, int row, int first);
    // The row and the column before a place, and how far it is behind them, 0..1.
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
