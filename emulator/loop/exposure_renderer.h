#pragma once
// Renders one exposure: from the world's motion while the shutter is open to the radiance image.
//
// quality.motion
//   off    renders the pose at mid-exposure
//   fast   renders the pose at mid-exposure and gives the sensor one rate to blur the picture along: that of
//          the thing that fills most of it (render/frame/image_motion.h). Stars are blurred by the camera's
//          own rate. Other motion (a second object, a spin, a turn about the boresight) is blurred wrongly.
//   exact  cuts the exposure into N equal parts, renders each at its middle and averages them. Points appear
//          in each part with 1/N of their light. The rate covers the step from part to part. N is the largest
//          motion in the picture over motion_error_px, rounded up, at most 64. Error: a thing with another
//          rate than the picture's lacks the blur within its own step, and steps are straight.
// A scanning line sees each place when it passes, so for it exact is the same as fast. If nothing moves more
// than a thousandth of a pixel, frames are those of motion off.
//
// A lamp that is switched during the exposure shines for its share of the time; with exact motion, for its
// share of each part. All rows get the same share, even if they are exposed one after the other.
//
// Pointing jitter (sensor/motion.h) turns the camera before anything else, with one draw for each exposure.

#include <cstdint>
#include <vector>

#include "emulator/scenario/exposure_config.h"
#include "emulator/world/world_state.h"
#include "render/frame/renderer.h"
#include "sensor/camera_model.h"
#include "sensor/chain.h"
#include "sensor/motion.h"

namespace hilcam {

// The simulated time that an exposure covers.
struct ShownWorld {
    ShownWorld(TimeTai instant, double share = 1) : middle(instant), moving(share) {}
    TimeTai middle;
    // Share of the exposure, about its middle, during which the world moves; 0: it stands still.
    double moving;
};

class ExposureRenderer {
  public:
    static constexpr int kMaxParts = 64;

    // Allocates everything that render() needs. Owner thread.
    ExposureRenderer(Renderer& renderer, const ExposureConfig& config, const CameraModel& camera,
                     const SpectralGrid& grid, std::size_t placed_objects);

    // Return an image and a number of points that fit render(). Owner thread.
    RadianceImage make_image() const;
    std::size_t max_points() const;

    // Sets the quality of the next exposures: 0 as configured, otherwise an entry of lower_levels(). Loop.
    void use_level(std::size_t level) { renderer_.use_level(level); }

    // See Renderer::take_light(). Loop, before an exposure.
    bool take_light() { return renderer_.take_light(); }

    // Makes the renderer split the light of the next exposures into parts (Renderer::keep_parts); null ends
    // that. Exact motion renders an exposure as several pictures, which cannot be split. Loop, before an
    // exposure.
    void keep_parts(PartsBuffer* buffer) { renderer_.keep_parts(buffer); }
    // Allocates a buffer for one part of the light. Any thread.
    PartsBuffer make_parts_buffer(LightPart part) const {
        return renderer_.make_parts_buffer(make_part(), part);
    }

    struct Result {
        RenderStats stats;  // totals over all parts
        ShownCommand shown;
        int parts = 1;
        bool parts_limited = false;  // true: motion would have needed more than kMaxParts
    };
    // Renders an exposure of length exposure.exposure_s, and sets the exposure's rates and ray grid. truth:
    // receives the truth of the frame's middle, or null. Loop, one thread; no allocation.
    Result render(WorldState& world, const ShownWorld& shown, RandomKey key, RadianceImage& radiance,
                  std::vector<PointSource>& points, Exposure& exposure, FrameTruth* truth = nullptr);
    // Finds the light from outside the picture in the last exposure (in its last part), for a camera with a
    // lens that scatters it (camera.outside_light); finds nothing for other cameras. Loop.
    void look_beside(std::vector<SideLight>& lights) const;
    static void reserve_beside(std::vector<SideLight>& lights) { lights.reserve(kMaxSideLights); }
    // Does the same as render() with the shutter closed. Loop.
    void keep_dark(RadianceImage& radiance, std::vector<PointSource>& points, Exposure& exposure) const;

    // Returns the world at the middle of the last exposure, including the camera's jitter. Loop.
    const WorldSnapshot& middle_world() const { return middle_; }

    // Result of plan(): what exact motion would do, and how far things move in the picture [px of the
    // detector]. Not for the loop.
    struct Plan {
        double picture_px = 0;  // motion of the thing that fills most of the picture
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
    bool rows_pass_object_;  // true: rows have different instants, and the camera does not look at ground
    bool looks_beside_;
    double focal_length_px_, oversampling_;
    PointingJitter jitter_;
    std::vector<Spectrum> responses_;  // responses of the detector's channels
    bool for_detector_, has_moments_;
    WorldSnapshot middle_, before_, after_, part_world_;
    double reported_moving_ = 1;  // rate of the world against the camera's time
    RadianceImage part_;          // one part of exact motion
    std::vector<PointSource> part_points_;
    std::size_t bins_;

    struct Span {
        TimeTai middle;
        std::int64_t length_ns = 0;  // time that passes in the world
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
