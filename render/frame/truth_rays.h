#pragma once
// Finds what camera rays meet first, and whether they would meet a thing if it were alone. Up to sixteen rays
// at a time, through any place in the radiance image or beside it. They come from the picture's own ray
// generator. They also meet objects that the picture draws as points.

#include <cstdint>
#include <limits>
#include <span>

#include "render/frame/frame_setup.h"
#include "render/frame/frame_truth.h"

namespace hilcam {

struct RayMet {
    enum class Kind : std::uint8_t { kSky, kObject, kBody, kSun } kind = Kind::kSky;
    std::uint32_t index = 0;                                   // number of the object, or BodyId
    double range_m = std::numeric_limits<double>::infinity();  // from the ray's origin
    Vec3d from_camera_m;  // world axes, from the camera's position at the frame's time; not set for sky
    Vec3d normal_dir;     // world axes, unit, towards the camera; zero if not asked for
};

class TruthRays {
  public:
    // Uses the camera of the last placed frame. Loop.
    explicit TruthRays(const FrameSetup& setup);

    // points_px: in the radiance image without its guard band, at most kPacketSize. Loop, any thread.
    void trace(std::span<const Vec2d> points_px, bool normals, std::span<RayMet> met) const;
    // Returns a word in which bit k is set if ray k meets the object or body, whatever is in front of it.
    // Loop, any thread.
    std::uint32_t meets_object(std::span<const Vec2d> points_px, std::size_t object) const;
    std::uint32_t meets_body(std::span<const Vec2d> points_px, const PlacedBody& body) const;
    // True when the lens has a direction for that place. Beside the picture a distortion polynomial may have
    // none.
    bool exists(Vec2d point_px) const;
    // True when the place is in the radiance image. Black columns and rows are outside it.
    bool on_image(Vec2d point_px) const;

  private:
    void generate(std::span<const Vec2d> points_px, std::span<CameraRay> rays) const;

    const FrameSetup& setup_;
    const FrameContext& frame_;
    float pixel_rad_;
};

// Returns the number of the thing that an object of the renderer is part of.
std::uint32_t owner_of(const FrameTruth& truth, std::size_t object);
// Returns the id of the thing that a ray has met.
std::uint32_t id_of(const FrameTruth& truth, const RayMet& met);

}  // namespace hilcam
