#pragma once
// Optical flow between two pictures of a camera: how far the scene point in each pixel of the first picture
// has moved in the second [px of the frame].
//
// A pixel stands for the point that the ray through its centre meets. Objects, bodies and parts on joints
// move as rigid bodies, each by its own pose; the sky turns with the camera. Occlusion in the second picture
// is not checked.

#include "render/frame/frame_truth.h"

namespace hilcam {

using FlowImage = Image<float, struct FlowQuantity>;  // two planes: to the right, down [px]

// Value of a pixel for which the second picture has no place: the point is behind the camera or outside the
// lens's field. It exceeds 1e9, as in Middlebury's .flo files (Baker et al., IJCV 92, 2011: "unknown").
inline constexpr float kUnknownFlow_px = 1e10f;

// Both records need the layers object and position. If the first has no layer part, parts on joints are
// assumed to move with their object.
FlowImage optical_flow(const FrameTruth& from, const FrameTruth& to);

}  // namespace hilcam
