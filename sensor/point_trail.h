#pragma once
// The places at which a point of light is drawn that moves through the exposure or jitters: along its way
// half a pixel apart, and at each of them, with jitter, a grid half a standard deviation apart, out to three,
// by the normal density.

#include <array>
#include <cstddef>

#include "render/vocabulary/vec.h"
#include "sensor/light_channel.h"

namespace hilcam {

class PointTrails {
  public:
    explicit PointTrails(const DetectorView& view) : view_(view) {}
    // Owner thread or loop, before the next three. jitter_px: standard deviation; 0: none.
    void begin(const Exposure& exposure, double jitter_px);

    // The way of a point that is at middle_px in the middle of the exposure.
    struct Trail {
        Vec2d middle_px;
        Vec2d drift_px;  // its own way through the exposure, over that of the sky
        bool turns;      // true: moves with the sky, as the camera turns
        int parts;       // places along it; they have equal light
    };
    Trail of_sky(Vec2d middle_px, Vec2d drift_px) const;
    static Trail straight(Vec2d middle_px, Vec2d way_px);
    Vec2d place(const Trail& trail, int part) const;

    // About each place: how many, the shift of one, and its share of the light.
    std::size_t scattered() const { return jitter_px_ > 0 ? kScattered : 1; }
    Vec2d scattered_px(Vec2d place_px, std::size_t i) const;
    double share(std::size_t i) const;

  private:
    static constexpr int kSteps = 6;  // out to three standard deviations
    static constexpr std::size_t kAcross = 2 * kSteps + 1, kScattered = kAcross * kAcross;

    const DetectorView& view_;
    double jitter_px_ = 0;
    std::array<double, kAcross> weights_{};
    double weight_sum_ = 0;
    Vec3d turn_rad_;
    bool turns_ = false;
    double turn_px_ = 0;       // on the axis
    Vec2d center_px_{};        // the boresight's place
    double per_focal2_ = 0;    // 1 over the focal length's square [px^-2]
    Mat3d at_start_, at_end_;  // turn the sky to where it is then

    bool stays_in_part(Vec2d middle_px, Vec2d drift_px) const;
    Vec2d turned_px(const Mat3d& turn, Vec3d dir_camera) const;
    static int parts_of(Vec2d from_px, Vec2d to_px);
};

}  // namespace hilcam
