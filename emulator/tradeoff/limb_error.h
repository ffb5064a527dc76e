#pragma once
// Where a body's limb lies in a picture, against where it lies in a reference: what horizon sensors and
// limb-fitting navigation measure.
//
// Places on the limb follow from geometry: the rays that touch an ellipsoid do so along a plane curve, which
// is a circle once the polar axis is stretched to the equatorial one (an affine map keeps tangents). At each
// place the picture is read along the limb's normal, 8 px to either side, bilinearly between pixel centres.
// The limb is where the light, coming from the sky, first reaches half of the reference's step from sky to
// disk; the error is the difference of the two places. Not asked: whether that isophote is the solid limb,
// which in air it is not.

#include <optional>
#include <span>
#include <vector>

#include "render/sky/bodies.h"
#include "render/vocabulary/image.h"
#include "render/vocabulary/image_geometry.h"
#include "render/vocabulary/pose.h"

namespace hilcam {

struct LimbPlace {
    Vec2d position_px;  // of the window; the middle of pixel (0, 0) is at (0.5, 0.5)
    Vec2d sky_dir;      // unit, perpendicular to the limb, away from the disk
};
inline constexpr double kLimbReach_px = 8;

// Evenly over the part of the limb that is in view with its surroundings, 512 at most. geometry: of the
// window, guard band left out. None when the camera is inside the body, or too few are in view to tell.
std::vector<LimbPlace> limb_places(const BodyState& body, const Figure& figure, const Pose& camera,
                                   const ImageGeometry& geometry);

struct LimbError {
    double rms_px = 0;
    int places = 0;  // where the limb is lit
};
// offset_px: of the window's corner in the array. Places count whose step in the reference is above
// min_step_e; where the picture shows no limb within reach it is off by that. None when no place counts.
std::optional<LimbError> limb_error(const ElectronImage& image, const ElectronImage& reference,
                                    std::span<const LimbPlace> places, Vec2d offset_px, double min_step_e);

}  // namespace hilcam
