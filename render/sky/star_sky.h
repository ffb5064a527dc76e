#pragma once
// The stars, sorted by their position in the sky, so that a frame processes only those in its field.
//
// Cells are regions of the sky with about the same number of stars each, in an order in which neighbours
// mostly follow each other, so that a frame's stars are close together in memory.

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/sky/star_block.h"
#include "render/sky/stars.h"
#include "render/vocabulary/units.h"

namespace hilcam {

class StarSky {
  public:
    StarSky() = default;
    // time: the epoch of the stars' positions.
    StarSky(std::vector<Star> stars, TimeTai time);

    std::size_t size() const { return stars_.size(); }
    bool empty() const { return stars_.empty(); }
    TimeTai time() const { return time_; }
    // Returns the largest number of stars in a cone of this half angle, anywhere in the sky. Slow.
    std::size_t max_within(double angle_rad) const;

    // Calls use(star, apparent direction) for each star that the observer may see in a cone, and for some
    // just outside it, in the order of the cells. Loop, any thread.
    template <class Use>
    void each_within(const StarObserver& observer, Vec3d axis_dir, double angle_rad, const Use& use) const {
        const Cone field(axis_dir, angle_rad + farthest_shift_rad(observer));
        StarBlock block;
        for (const Cell& cell : cells_) {
            if (!field.touches(cell.cone)) continue;
            for (std::size_t i = cell.begin; i < cell.end; ++i) {
                if (!field.holds(stars_[i].world_dir)) continue;
                block.add(stars_[i]);
                if (block.full()) block.use_all(observer, use);
            }
        }
        block.use_all(observer, use);
    }

  private:
    // All directions within half angle of its axis.
    struct Cone {
        Vec3d axis_dir;
        double angle_rad, cosine, sine;

        Cone(Vec3d axis, double angle)
            : axis_dir(axis),
              angle_rad(std::min(angle, kPi)),
              cosine(std::cos(angle_rad)),
              sine(std::sin(angle_rad)) {}
        bool holds(Vec3d dir) const { return dot(dir, axis_dir) >= cosine; }
        bool touches(const Cone& other) const {
            return angle_rad + other.angle_rad >= kPi ||
                   dot(axis_dir, other.axis_dir) >= cosine * other.cosine - sine * other.sine;
        }
    };
    struct Cell {
        Cone cone;  // a cone around its stars
        std::size_t begin, end;
    };

    std::vector<Star> stars_;
    std::vector<Cell> cells_;
    TimeTai time_;
    double fastest_rad_yr_ = 0, max_parallax_rad_ = 0;

    Cone cone_of(std::size_t begin, std::size_t end) const;
    double farthest_shift_rad(const StarObserver& observer) const;
};

}  // namespace hilcam
