#pragma once
// The places at which a moving or jittering point of light is drawn: every half pixel along its way; with
// jitter, at each of them a grid with steps of half a standard deviation, out to three, weighted by the
// normal density.

#include <array>
#include <cstddef>

#include "render/vocabulary/vec.h"
#include "sensor/light_channel.h"

namespace hilcam {

class PointTrails {
  public:
    explicit PointTrails(const DetectorView& view) : view_(view) {}
    // Call before the functions below. jitter_px: standard deviation; 0: none. Owner thread or loop.
    void begin(const Exposure& exposure, double jitter_px);

    // The way of a point that is at middle_px at the middle of the exposure.
    struct Trail {
        Vec2d middle_px;
        Vec2d drift_px;  // the point's own motion during the exposure, in addition to the sky's
        bool turns;      // true: moves with the sky as the camera turns
        int parts;       // number of places along it, with equal light
    };
    Trail of_sky(Vec2d middle_px, Vec2d drift_px) const;
    static Trail straight(Vec2d middle_px, Vec2d way_px);
    Vec2d place(const Trail& trail, int part) const;

    // The scatter about each place: how many points, the position of each, and its share of the light.
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
    double turn_px_ = 0;       // turn on the axis
    Vec2d center_px_{};        // where the boresight is
    double per_focal2_ = 0;    // 1 over the square of the focal length [px^-2]
    Mat3d at_start_, at_end_;  // rotate the sky to its attitude at either end

    bool stays_in_part(Vec2d middle_px, Vec2d drift_px) const;
    Vec2d turned_px(const Mat3d& turn, Vec3d dir_camera) const;
    static int parts_of(Vec2d from_px, Vec2d to_px);
};

}  // namespace hilcam
