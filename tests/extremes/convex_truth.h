#pragma once
// The light of convex sunlit bodies in closed form: each lit face that is seen is a polygon of even radiance
// in the picture. And how well a grid of rays can know it.
//
// A row of samples, `step` apart, meets an edge of a face somewhere between two of them: the face's share of
// the row is off by a number that is even between -step/2 and step/2. An edge of length l crosses l / step
// such rows, independent ones for an edge that is not along the grid: standard deviation of the area
// step^(3/2) sqrt(l / 12). The centroid is off by that share of the light times no more than the distance of
// the farthest corner.

#include <span>

#include "tests/extremes/group.h"
#include "tests/support/stage.h"

namespace hilcam::extremes {

struct ConvexTruth {
    double irradiance = 0;  // [W m^-2 um^-1]
    Vec2d centroid_px;
    double flux_sigma = 0;  // relative, of a grid of rays
    double centroid_sigma_px = 0;
};

// Adds up faces.
class ConvexSum {
  public:
    // step_px: between the camera's rays.
    ConvexSum(const Stage& stage, double step_px) : stage_(stage), step_px_(step_px) {}
    // Corners in the world, from the camera; radiance of all of it.
    void add(std::span<const Vec3d> corners_m, double radiance);
    ConvexTruth truth() const;

  private:
    const Stage& stage_;
    double step_px_;
    double irradiance_ = 0, variance_ = 0, x_ = 0, y_ = 0;
    std::vector<Vec2d> corners_px_;
};

// Of a stage's first object, a white cube of a size about its origin.
ConvexTruth cube_truth(const Stage& stage, double size_m, double albedo);
// Of a triangle in the object's axes.
ConvexTruth triangle_truth(const Stage& stage, std::span<const Vec3d, 3> corners_m, double albedo);

// Between the rays that the plan gives the first object, of that radius [px].
double ray_step_px(const Stage& stage, double radius_m);

// What single and double precision leave of a place in the picture [px]: of a ray's direction and start, of a
// point's position, of the camera's double-precision directions.
double grain_px(const Stage& stage, double radius_m);

// The whole picture against a truth: light, relative, and centroid [px].
std::vector<Found> compared(const Stage& stage, const ConvexTruth& truth);
// Limits of the two.
std::vector<double> limits_of(const Stage& stage, const ConvexTruth& truth, double radius_m);

}  // namespace hilcam::extremes
