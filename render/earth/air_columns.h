#pragma once
// The air between a point near the ground and space, tabulated from any Atmosphere. For a viewer above the
// air it depends only on the point's height and three angles, so a lookup takes tens of nanoseconds instead
// of microseconds.
//
// Grids: 41 zenith angles of the viewer, denser at the horizon; 64 of the Sun, down to 20 degrees below the
// horizon; 13 azimuths; two heights. Linear in between. Compared with Atmosphere::look() in
// tests/unit/render/earth/air_columns_test.cpp.
//
// If the ground below the air differs from place to place, its contribution (AirByPlace::Parts) is in
// separate tables without azimuths, because that light comes from all around.

#include <optional>
#include <vector>

#include "render/sky/air_by_place.h"

namespace hilcam {

class AirColumns {
  public:
    // high_m: the upper of the two heights; nothing: it is not needed, and lookups return the lower one in
    // its place. Computes the table on all threads. air: must outlive this.
    AirColumns(const Atmosphere& air, std::optional<double> high_m);

    struct Looks {
        Atmosphere::Sight low, high;  // to a point on the ground, and to one at high_m
    };
    // Returns what Atmosphere::look() returns for rays from space. mu, mu0: cosines of the zenith angles of
    // viewer and Sun at the point; cos_phase: of the angle between the directions to both; lift: from lift()
    // at the point. Loop, any thread.
    Looks look(float mu, float mu0, float cos_phase, const Spectrum& lift) const;

    // The same for a ray from space that misses the ground and has its lowest point ahead. height_m: of that
    // point, 0 to the air's top; mu0, lift: at that point; ahead_dot_sun: cosine between the ray's direction
    // and the Sun.
    Atmosphere::Sight look_past(float height_m, float mu0, float ahead_dot_sun, const Spectrum& lift) const;
    // Returns what Atmosphere::look() returns for a ray; nothing for a ray that starts inside the air or ends
    // inside it above the ground. Loop, any thread.
    std::optional<Atmosphere::Sight> from_space(Vec3d origin_m, Vec3d dir, double distance_m,
                                                Vec3d sun_dir) const;
    // The air if light from below differs by place; otherwise null.
    const AirByPlace* by_place() const { return by_place_; }
    // The same as AirByPlace::lift_at() and lift(); zero if light from below is the same everywhere. Loop,
    // any thread.
    Spectrum lift_at(float u, float v) const { return by_place_ ? by_place_->lift_at(u, v) : Spectrum{}; }
    Spectrum lift(Vec3d point_m) const { return by_place_ ? by_place_->lift(point_m) : Spectrum{}; }
    float top_m() const { return top_m_; }
    std::size_t bytes() const {
        return sizeof(Spectrum) * (passed_.size() + passing_.size() + transmittance_.size() +
                                   radiance_.size() + lifted_.size() + passing_lifted_.size());
    }

  private:
    // Rays past the ground: grids are uniform in the square root of the height, and in that of the azimuth
    // from the Sun's.
    static constexpr int kPassHeights = 80, kPassSuns = 64, kPassAzimuths = 20;
    const AirByPlace* by_place_;  // null: light from below is the same everywhere
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
