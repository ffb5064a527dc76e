#pragma once
// Makes point sources of things smaller than a pixel (stars, far planets, far objects) if nothing but air and
// glass is in front of them.

#include <vector>

#include "render/scene/scene.h"
#include "render/shading/frame_context.h"
#include "render/sky/star_sky.h"
#include "render/vocabulary/point_source.h"

namespace hilcam {

// Returns half the angle of the cone about the boresight that holds the padded image at one instant.
double half_field_rad(const ImageGeometry& geometry);

// The point sources of one frame. If rows have different instants, each point is placed by the row that sees
// it. A line scanner that passes slowly over a star draws it as a column of points, one per row, while the
// vector has room. Loop; no allocation while the vector has room.
class PointField {
  public:
    PointField(const FrameContext& frame, const WorldSnapshot& world);

    void add_stars(const StarSky& stars, std::vector<PointSource>& points) const;
    // Calls use(star, apparent direction) for each star that may be in the image. The direction does not
    // include refraction (Background::seen_through_air).
    template <class Use>
    void each_star(const StarSky& stars, const Use& use) const {
        stars.each_within(observer_of(stars.time()), boresight_dir_, field_rad_ + lifted_rad_, use);
    }
    // Adds a thing at a distance [m] in a direction (unit, world) with this irradiance at the camera; it
    // belongs to an object or to the sky.
    void add(Vec3d dir, double distance_m, const Spectrum& irradiance_w_m2_um,
             std::vector<PointSource>& points, std::uint32_t object = PointSource::kSky) const;
    // Adds a star or a body where it is seen through the air.
    void add_from_sky(Vec3d dir, double distance_m, const Spectrum& irradiance_w_m2_um,
                      std::vector<PointSource>& points, std::uint32_t thing = PointSource::kSky) const;
    // True when the thing is in the padded image.
    bool sees(Vec3d dir, double distance_m) const {
        Sighting ignored;
        return find(dir, distance_m, ignored);
    }
    // Finds where add() would draw it, and with which light: what air and glass in front of it let through.
    // False: it is outside the image or hidden.
    bool look(Vec3d dir, double distance_m, const Spectrum& irradiance_w_m2_um, Sighting& where,
              Spectrum& seen_w_m2_um) const;

  private:
    const FrameContext& frame_;
    const WorldSnapshot& world_;
    Vec3d boresight_dir_;
    double field_rad_;   // largest angle from the boresight (at the frame's time) of what may be in the image
    double min_cosine_;  // cosine of that angle
    double lifted_rad_;  // largest angle by which the air may move a star in this frame

    StarObserver observer_of(TimeTai star_time) const;
    bool find(Vec3d dir, double distance_m, Sighting& seen) const;
    void push(const Sighting& seen, const PointSource& point, std::vector<PointSource>& points) const;
};

}  // namespace hilcam
