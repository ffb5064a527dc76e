#pragma once
// One exposure, from the world's motion to the radiance image: what the shutter lets in while it is open.
//
// quality.motion
//   off    the pose at mid-exposure
//   fast   the pose at mid-exposure, and the picture's rate for the sensor to blur it along: of the thing
//          that fills most of it (render/frame/image_motion.h); stars go by the camera's own rate. What moves
//          in another way than that (a second object, a spin, a turn about the boresight) is blurred wrongly.
//   exact  N equal parts of the exposure, each rendered at its middle, averaged; points of each with 1/N of
//          their light; the rates cover the step from part to part. N is the largest way of anything in the
//          picture over motion_error_px, rounded up, at most 64. Error: a thing whose rate differs from the
//          picture's lacks the blur of its own step, and steps are straight.
// A scanning line sees each place when it passes: for it exact is fast. What moves less than a thousandth of
// a pixel is at rest, and its frames are those of motion off.
//
// A lamp that is switched meanwhile shines for its share of the time: of the exposure, with exact motion of
// each part. Rows that are lit one after the other have the same share.
//
// Pointing jitter (sensor/motion.h) turns the camera before anything else: one draw per exposure.

#include <cstdint>
#include <vector>

#include "emulator/scenario/exposure_config.h"
#include "emulator/world/world_state.h"
#include "render/frame/renderer.h"
#include "sensor/camera_model.h"
#include "sensor/chain.h"
#include "sensor/motion.h"

namespace hilcam {

// The world's time that an exposure sees.
struct ShownWorld {
    ShownWorld(TimeTai instant, double share = 1) : middle(instant), moving(share) {}
    TimeTai middle;
    double moving;  // share of the exposure through which the world moves, about the middle; 0: it stands
};

class ExposureRenderer {
  public:
    static constexpr int kMaxParts = 64;

    // Allocates all that render() needs. Owner thread.
    ExposureRenderer(Renderer& renderer, const ExposureConfig& config, const CameraModel& camera,
                     const SpectralGrid& grid, std::size_t placed_objects);

    // Fits what render() fills. Owner thread.
    RadianceImage make_image() const;
    std::size_t max_points() const;

    // The quality of the next exposures (lower_levels()): 0, as configured, or one of those below. Loop.
    void use_level(std::size_t level) { renderer_.use_level(level); }

    // See Renderer. Loop, before an exposure.
    bool take_light() { return renderer_.take_light(); }

    // Makes the renderer take the light of the next exposures apart (Renderer::keep_parts); null ends that. Exact motion renders an
    // exposure as several pictures, which cannot be taken apart. Loop, before an exposure.
    void keep_parts(PartsBuffer* buffer) { renderer_.keep_parts(buffer); }
    // Memory for that: for one part of the light. Any thread.
    PartsBuffer make_parts_buffer(LightPart part) const {
        return renderer_.make_parts_buffer(make_part(), part);
    }

    struct Result {
        RenderStats stats;  // figures of all parts
        ShownCommand shown;
        int parts = 1;
        bool parts_limited = false;  // more than kMaxParts were asked for
    };
    // The exposure of exposure.exposure_s of a world about an instant; sets the exposure's rates and ray
    // grid. truth: to be told of the frame's middle, or null. Loop, one thread; no allocation.
    Result render(WorldState& world, const ShownWorld& shown, RandomKey key, RadianceImage& radiance,
                  std::vector<PointSource>& points, Exposure& exposure, FrameTruth* truth = nullptr);
    // Finds the light from beside the picture, as it stood in the last exposure (in its last part), for a camera
    // whose lens scatters it (camera.outside_light); finds nothing for others. Loop.
    void look_beside(std::vector<SideLight>& lights) const;
    static void reserve_beside(std::vector<SideLight>& lights) { lights.reserve(kMaxSideLights); }
    // The same with the shutter closed. Loop.
    void keep_dark(RadianceImage& radiance, std::vector<PointSource>& points, Exposure& exposure) const;

    // The world at the middle of the last exposure, the camera's jitter in it. Loop.
    const WorldSnapshot& middle_world() const { return middle_; }

    // The plan says what exact motion would do, and how far things move [px of the detector]. Not for the
    // loop.
    struct Plan {
        double picture_px = 0;  // motion of what fills most of the picture
        double largest_px = 0;
        int parts = 1;
        bool parts_limited = false;
    };
    Plan plan(WorldState& world, TimeTai middle, double exposure_s);

  private:
    Renderer& renderer_;
    MotionQuality motion_;
    double motion_error_px_;
    ShutterConfig shutter_;
    bool rows_pass_object_;  // are of several instants, and it is not the ground that they see
    bool looks_beside_;
    double focal_length_px_, oversampling_;
    PointingJitter jitter_;
    std::vector<Spectrum> responses_;  // those of the detector's channels
    bool for_detector_, has_moments_;
    WorldSnapshot middle_, before_, after_, part_world_;
    double reported_moving_ = 1;  // speed of the world in the camera's time
    RadianceImage part_;          // a part of exact motion
    std::vector<PointSource> part_points_;
    std::size_t bins_;

    struct Span {
        TimeTai middle;
        std::int64_t length_ns = 0;  // length of the world's motion
        double exposure_s = 0;
        double moving = 1;
    };
    void sample_middle(WorldState& world, const Span& span, ShownCommand& shown);
    Vec3d seen_velocity_m_s(const WorldState& world, const WorldSnapshot& now) const;
    void report_truth(FrameTruth& truth);
    Plan plan_of(const ImageMotion& motion) const;
    void sample_again(const WorldState& world, const Span& span, TimeTai time, bool with_bodies,
                      WorldSnapshot& out) const;
    void sample_ends(const WorldState& world, const Span& span, bool with_bodies);
    RadianceImage make_part() const;
    void render_parts(const WorldState& world, const Span& span, RandomKey key, RadianceImage& radiance,
                      std::vector<PointSource>& points, Result& result);
    double unexpected_px_s(double rate_px_s) const;
    void set_rates(const ImageMotion& motion, int parts, Exposure& exposure) const;
};

}  // namespace hilcam
