#pragma once
// The air between a point near the ground and space, as a table made from any Atmosphere: for a viewer above the air it
// depends on the point's height and three angles alone, so that a look costs some tens of nanoseconds instead of
// microseconds.
//
// Grids: 41 zenith angles of the viewer, crowded at the horizon, 64 of the Sun to 20 degrees below it, 13 azimuths, two
// heights. Linear between; against Atmosphere::look(): tests/unit/render/earth/air_columns_test.cpp.
//
// Where the air has other ground below it from place to place, what that adds (AirByPlace::Parts) is in tables of its own,
// which have no azimuths: such light comes from all around.

#include <optional>
#include <vector>

#include "render/sky/air_by_place.h"

namespace hilcam {

class AirColumns {
  public:
    // high_m: the upper of the two heights; nothing: it is not asked for, and looks have the lower in its place. Works the
    // table out on all threads. air: must outlive this.
    AirColumns(const Atmosphere& air, std::optional<double> high_m);

    struct Looks {
        Atmosphere::Sight low, high;  // to a point on the ground, and to one at high_m
    };
    // Returns what Atmosphere::look() says of rays from space. mu, mu0: cosines of the zenith angles of viewer and Sun at the
    // point; cos_phase: of the angle between the directions to both; lift: as lift() has it there. Loop, any thread.
    Looks look(float mu, float mu0, float cos_phase, const Spectrum& lift) const;

    // The same of a ray from space that misses the ground and has its lowest point ahead: that point's height, 0 to the
    // air's top; mu0, lift: there; ahead_dot_sun: cosine of the angle between the ray's way and the Sun.
    Atmosphere::Sight look_past(float height_m, float mu0, float ahead_dot_sun, const Spectrum& lift) const;
    // Returns what Atmosphere::look() says of a ray; nothing for one that begins within the air or ends within it above the
    // ground. Loop, any thread.
    std::optional<Atmosphere::Sight> from_space(Vec3d origin_m, Vec3d dir, double distance_m,
                                                Vec3d sun_dir) const;
    // The air where light from below differs by place; else null.
    const AirByPlace* by_place() const { return by_place_; }
    // AirByPlace::lift_at(), lift(); zero where light from below does not differ by place. Loop, any thread.
    Spectrum lift_at(float u, float v) const { return by_place_ ? by_place_->lift_at(u, v) : Spectrum{}; }
    Spectrum lift(Vec3d point_m) const { return by_place_ ? by_place_->lift(point_m) : Spectrum{}; }
    float top_m() const { return top_m_; }
    std::size_t bytes() const {
        return sizeof(Spectrum) * (passed_.size() + passing_.size() + transmittance_.size() +
                                   radiance_.size() + lifted_.size() + passing_lifted_.size());
    }

  private:
    // Past the ground: heights by their root, azimuths from the Sun's by theirs.
    static constexpr int kPassHeights = 80, kPassSuns = 64, kPassAzimuths = 20;
    const AirByPlace* by_place_;  // null: the same light from below everywhere
    float top_m_;
    std::vector<Spectrum> passed_;          // [height]
    std::vector<Spectrum> passing_;         // [azimuth][sun][height]
    std::vector<Spectrum> passing_lifted_;  // [sun][height]; empty: none

    void fill_passing(const Atmosphere& air);

    static constexpr int kViews = 41, kSuns = 64, kAzimuths = 13;
    std::vector<Spectrum> transmittance_;  // [view][height]
    std::vector<Spectrum> radiance_;       // [azimuth][sun][view][height]
    std::vector<Spectrum> lifted_;         // [sun][view][height]; empty: none
};

}  // namespace hilcam
