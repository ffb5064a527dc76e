#pragma once
// Finds what rays of the camera meet first, and whether they would meet a thing if it were alone; up to
// sixteen at a time, through any places of the radiance image and beside it. The rays are the ray generator's
// own, as those of the picture. Objects that the picture draws as points are met too.

#include <cstdint>
#include <limits>
#include <span>

#include "render/frame/frame_setup.h"
#include "render/frame/frame_truth.h"

namespace hilcam {

struct RayMet {
    enum class Kind : std::uint8_t { kSky, kObject, kBody, kSun } kind = Kind::kSky;
    std::uint32_t index = 0;                                   // number of the object, or BodyId
    double range_m = std::numeric_limits<double>::infinity();  // from where the ray began
    Vec3d from_camera_m;  // world axes, from the camera's place at the frame's time; not of the sky
    Vec3d normal_dir;     // world axes, unit, towards the camera; zero where not asked for
};

class TruthRays {
  public:
    // Looks through the camera of the frame that was placed last. Loop.
    explicit TruthRays(const FrameSetup& setup);

    // points_px: of the radiance image without its guard band, kPacketSize at most. Loop, any thread.
    void trace(std::span<const Vec2d> points_px, bool normals, std::span<RayMet> met) const;
    // Bit k: ray k meets the object, or the body, whatever stands before it. Loop, any thread.
    std::uint32_t meets_object(std::span<const Vec2d> points_px, std::size_t object) const;
    std::uint32_t meets_body(std::span<const Vec2d> points_px, const PlacedBody& body) const;
    // The lens has a direction for that place: beside the picture a polynomial of distortion may not.
    bool exists(Vec2d point_px) const;
    // The radiance image has that place; black columns and rows lie beside it.
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
