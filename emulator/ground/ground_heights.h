#pragma once
// Heights of a scenario's ground on a square of places, with all that is seeded on it, and what a lander asks of them: slope and
// step at each.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "emulator/ground/globe_config.h"
#include "render/ground/ground_surface.h"

namespace hilcam {

// The tangent plane at a place, the middle.
struct LocalPlane {
    Vec3d up, east, north;  // body axes
    double radius_m;

    LocalPlane(const Geodetic& middle, const Figure& figure);
    // Returns the unit vector of a place along the ground from the middle.
    Vec3d place(double east_m, double north_m) const;
    // Returns where a place is, along the ground from the middle [m].
    Vec2d along(Vec3d place) const;
    // "longitude_deg,latitude_deg,east_m,north_m" of a place.
    std::string text_of(Vec3d place) const;
};

struct GroundSlope {
    double slope_rad = 0;  // slope of the plane through nine posts by least squares
    double step_m = 0;     // greatest distance of one of the nine from that plane through the middle one
};

// A square of heights about the middle, the first one in the south-west; with a border of one post, which has no slope.
struct HeightSquare {
    int half = 0;  // posts from the middle to the edge, without the border
    double spacing_m = 1;
    std::vector<double> heights_m;

    int side() const { return 2 * half + 3; }
    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>((row + half + 1) * side() + column + half + 1);
    }
    // column, row: from the middle, to half at most.
    double height_m(int column, int row) const { return heights_m[index(column, row)]; }
    GroundSlope slope(int column, int row) const;
};

class GroundHeights {
  public:
    // Opens the maps. Throws InputError.
    GroundHeights(const GlobeConfig& globe, const MappedBody& body);
    // Throws InputError where there would be too many posts.
    HeightSquare square(const LocalPlane& plane, double within_m, double spacing_m);
    // Returns the height of a place over the ellipsoid, with what is as wide as some of a spacing.
    double height_m(Vec3d place, double spacing_m);
    // Returns the place's point at that height, body axes.
    Vec3d point_m(Vec3d place, double height_m) const { return surface_.point(place, height_m); }

  private:
    GroundSurface surface_;
    std::vector<std::unique_ptr<const GroundDetail>> details_;

    void find(std::span<const Vec3d> places, int side, double reach_m, double spacing_m,
              std::span<double> heights_m);
};

}  // namespace hilcam
