#pragma once
// A map of a body as an interface: values at posts, rows from the north, and the position of each post on the
// body. Readers of file formats implement it (io/maps); only what is needed is read.
//
// A place is the unit normal of the ellipsoid in the body's axes (x: prime meridian, z: north), so its
// latitude is geodetic. Post (0, 0) is the middle of the first cell in the file.

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
        int channels = 1;                   // 1: heights or grey; 3: linear red, green, blue
        int bands = 1;                      // channels in the file, read or not
        bool has_overviews = true;          // coarse levels do not need all posts to be read
        double spacing_m = 1;               // approximate distance of neighbours at the map's middle
        bool whole_turn = false;            // last column is a neighbour of the first
        bool pole_above_first_row = false;  // pole is half a post beyond
        bool pole_below_last_row = false;
    };
    // The interpretation of the map, for users.
    struct Reading {
        bool planetocentric = false;  // latitudes of the map are planetocentric
        // Kinds of latitude and longitude, unit, and what they were inferred from; may be empty.
        std::string taken;
        std::vector<std::string> doubts;  // warnings of probable mistakes, one line each
    };
    virtual ~GroundRaster() = default;
    const Shape& shape() const { return shape_; }
    const Reading& reading() const { return reading_; }
    // Returns the number of reads so far that met unreadable data.
    std::uint64_t failed_reads() const { return failed_reads_; }

    // Finds the columns (x) and rows (y) of places; NaN outside the projection. In a map of a whole turn a
    // column is in [-0.5, columns - 0.5). As many posts as places. One thread at a time.
    virtual void find_posts(std::span<const Vec3d> places, std::span<Vec2d> posts) = 0;
    // Reads a window of level `level`, each of whose posts represents 2^level x 2^level posts of the map,
    // inside (columns >> level) x (rows >> level). Values by row with channels together; NaN is a hole, also
    // where data cannot be read. One thread at a time.
    virtual void read(int level, int column, int row, int columns, int rows, std::span<float> values) = 0;

  protected:
    Shape shape_;
    Reading reading_;
    std::uint64_t failed_reads_ = 0;
};

}  // namespace hilcam
