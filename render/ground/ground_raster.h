#pragma once
// A map of a body as an interface: values at posts, rows from the north, and where on the body each post is. Whoever
// knows a file format makes one (io/maps); only what is looked at is asked for.
//
// A place is the unit vector of the ellipsoid's normal there, in the body's axes (x: prime meridian, z: north): its
// latitude is geodetic. Post (0, 0) is the middle of the first cell of the file.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "render/vocabulary/vec.h"

namespace hilcam {

class GroundRaster {
  public:
    struct Shape {
        int columns = 2, rows = 2;          // each at least 2
        int channels = 1;                   // 1: heights or one grey; 3: linear red, green, blue
        int bands = 1;                      // channels that the file has, read or not
        bool has_overviews = true;          // its coarse levels are not read out of all of its posts
        double spacing_m = 1;               // distance of neighbours, about, at the map's middle
        bool whole_turn = false;            // the last column is a neighbour of the first
        bool pole_above_first_row = false;  // the pole is half a post beyond
        bool pole_below_last_row = false;
    };
    // Tells people how a map was understood.
    struct Reading {
        bool planetocentric = false;  // kind of the map's latitudes
        std::string taken;  // kinds of latitudes and longitudes, unit, and what says so; may be empty
        std::vector<std::string> doubts;  // remarks on what is probably not meant, a line each
    };
    virtual ~GroundRaster() = default;
    const Shape& shape() const { return shape_; }
    const Reading& reading() const { return reading_; }
    // Returns how many reads have met what cannot be read so far.
    std::uint64_t failed_reads() const { return failed_reads_; }

    // Finds the columns (x) and rows (y) of places; NaN where the projection has none. A column of a map of a whole turn
    // is in [-0.5, columns - 0.5). As many posts as places. One thread at a time.
    virtual void find_posts(std::span<const Vec3d> places, std::span<Vec2d> posts) = 0;
    // Reads a window of level `level`, whose posts each stand for 2^level x 2^level of the map, all within
    // (columns >> level) x (rows >> level); values by row, channels together, NaN for a hole. What cannot be read is
    // a hole. One thread at a time.
    virtual void read(int level, int column, int row, int columns, int rows, std::span<float> values) = 0;

  protected:
    Shape shape_;
    Reading reading_;
    std::uint64_t failed_reads_ = 0;
};

}  // namespace hilcam
