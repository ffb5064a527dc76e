#pragma once
// Heights of a scenario's ground on a square grid, including all seeded detail, with the slope and step at
// each point that decide where a lander can stand.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "emulator/ground/globe_config.h"
#include "render/ground/ground_surface.h"

namespace hilcam {

// The tangent plane at a point of the ground, its middle.
struct LocalPlane {
    Vec3d up, east, north;  // body axes
    double radius_m;

    LocalPlane(const Geodetic& middle, const Figure& figure);
    // Returns the unit vector of the point at a distance along the ground from the middle.
    Vec3d place(double east_m, double north_m) const;
    // Returns the position of a point relative to the middle, along the ground [m].
    Vec2d along(Vec3d place) const;
    // Returns "longitude_deg,latitude_deg,east_m,north_m" of a point.
    std::string text_of(Vec3d place) const;
};

struct GroundSlope {
    double slope_rad = 0;  // slope of the least-squares plane through nine posts
    // Largest distance of one of the nine from that plane, shifted to pass through the middle post.
    double step_m = 0;
};

// A square grid of heights about the middle, beginning in the south-west. Its border of one post has no
// slope.
struct HeightSquare {
    int half = 0;  // posts between the middle and the edge, without the border
    double spacing_m = 1;
    std::vector<double> heights_m;

    int side() const { return 2 * half + 3; }
    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>((row + half + 1) * side() + column + half + 1);
    }
    // column, row: counted from the middle, -half to half.
    double height_m(int column, int row) const { return heights_m[index(column, row)]; }
    GroundSlope slope(int column, int row) const;
};

class GroundHeights {
  public:
    // Opens the maps. Throws InputError.
    GroundHeights(const GlobeConfig& globe, const MappedBody& body);
    // Throws InputError when there would be too many posts.
    HeightSquare square(const LocalPlane& plane, double within_m, double spacing_m);
    // Returns a point's height above the ellipsoid, with all detail that a grid of this spacing can show.
    double height_m(Vec3d place, double spacing_m);
    // Returns the point in body axes at that height.
    Vec3d point_m(Vec3d place, double height_m) const { return surface_.point(place, height_m); }

  private:
    GroundSurface surface_;
    std::vector<std::unique_ptr<const GroundDetail>> details_;

    void find(std::span<const Vec3d> places, int side, double reach_m, double spacing_m,
              std::span<double> heights_m);
};

}  // namespace hilcam
