#pragma once
// Measures the shift of a body's limb in a picture relative to a reference, as horizon sensors and
// limb-fitting navigation would see it.
//
// Points on the limb follow from geometry. Rays that touch an ellipsoid do so along a plane curve, which
// becomes a circle when the polar axis is stretched to the equatorial one (an affine map keeps tangents). At
// each point the picture is read along the limb's normal, 8 px to either side, bilinearly between pixel
// centres. The limb is where the light, coming from the sky, first reaches half of the reference's step from
// sky to disk. The error is the distance between this place in the picture and in the reference. In air this
// isophote is not the solid limb, which does not matter here.

#include <optional>
#include <span>
#include <vector>

#include "render/sky/bodies.h"
#include "render/vocabulary/image.h"
#include "render/vocabulary/image_geometry.h"
#include "render/vocabulary/pose.h"

namespace hilcam {

struct LimbPlace {
    Vec2d position_px;  // in the window; the centre of pixel (0, 0) is (0.5, 0.5)
    Vec2d sky_dir;      // unit vector, perpendicular to the limb, away from the disk
};
inline constexpr double kLimbReach_px = 8;

// Returns points spread evenly over the part of the limb that is in view with its surroundings, at most 512.
// geometry: the window's, without guard band. Returns none when the camera is inside the body, or too few
// points are in view.
std::vector<LimbPlace> limb_places(const BodyState& body, const Figure& figure, const Pose& camera,
                                   const ImageGeometry& geometry);

struct LimbError {
    double rms_px = 0;
    int places = 0;  // number of lit limb points
};
// Compares a picture with the reference. offset_px: position of the window in the array. A point counts if
// its step in the reference exceeds min_step_e; if the picture shows no limb within kLimbReach_px, its error
// is that. Returns nothing when no point counts.
std::optional<LimbError> limb_error(const ElectronImage& image, const ElectronImage& reference,
                                    std::span<const LimbPlace> places, Vec2d offset_px, double min_step_e);

}  // namespace hilcam
