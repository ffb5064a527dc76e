#pragma once
// Things smaller than a pixel become point sources where nothing but air and glass is before them: stars, far
// planets, far objects.

#include <vector>

#include "render/scene/scene.h"
#include "render/shading/frame_context.h"
#include "render/sky/star_sky.h"
#include "render/vocabulary/point_source.h"

namespace hilcam {

// Half the angle of the cone about the boresight that holds the padded image of an instant.
double half_field_rad(const ImageGeometry& geometry);

// The points of light of one frame. With rows of different instants each point is where the row is that sees
// it; a scanning line that is slow over a star draws it as a column of points, one per row, while the vector
// has room. Loop; no allocation while the vector has room.
class PointField {
  public:
    PointField(const FrameContext& frame, const WorldSnapshot& world);

    void add_stars(const StarSky& stars, std::vector<PointSource>& points) const;
    // Calls use(star, apparent direction) for each star that can be in the image, the air's bending left out (Background::seen_through_air).
    template <class Use>
    void each_star(const StarSky& stars, const Use& use) const {
        stars.each_within(observer_of(stars.time()), boresight_dir_, field_rad_ + lifted_rad_, use);
    }
    // A thing at a distance [m] in a direction (unit, world) with this irradiance at the camera; part of an
    // object, or of the sky.
    void add(Vec3d dir, double distance_m, const Spectrum& irradiance_w_m2_um,
             std::vector<PointSource>& points, std::uint32_t object = PointSource::kSky) const;
    // The same for a star or a body, which is seen where the air before it has it.
    void add_from_sky(Vec3d dir, double distance_m, const Spectrum& irradiance_w_m2_um,
                      std::vector<PointSource>& points, std::uint32_t thing = PointSource::kSky) const;
    // True when the thing is in the padded image.
    bool sees(Vec3d dir, double distance_m) const {
        Sighting ignored;
        return find(dir, distance_m, ignored);
    }
    // Finds where add() draws it, and with what light: that which air and glass before it leave. False: it is
    // outside, or hidden.
    bool look(Vec3d dir, double distance_m, const Spectrum& irradiance_w_m2_um, Sighting& where,
              Spectrum& seen_w_m2_um) const;

  private:
    const FrameContext& frame_;
    const WorldSnapshot& world_;
    Vec3d boresight_dir_;
    double field_rad_;   // from the boresight at the frame's time, of what can be in the image
    double min_cosine_;  // cosine of that angle
    double lifted_rad_;  // by which the air may move what is seen through it

    StarObserver observer_of(TimeTai star_time) const;
    bool find(Vec3d dir, double distance_m, Sighting& seen) const;
    void push(const Sighting& seen, const PointSource& point, std::vector<PointSource>& points) const;
};

}  // namespace hilcam
