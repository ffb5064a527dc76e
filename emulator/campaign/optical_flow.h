#pragma once
// Optical flow between two pictures of a camera: for each pixel of the first, how far in the second what it
// shows has moved [px of the frame].
//
// What a pixel shows is the place that the ray through its middle meets. Objects, bodies and
// parts that turn by joints move as rigid things, each by its own pose; the sky turns with the camera.
// Whether the second picture shows it, or something stands before it there, is not asked.

#include "render/frame/frame_truth.h"

namespace hilcam {

using FlowImage = Image<float, struct FlowQuantity>;  // two planes: to the right, down [px]

// The value of a pixel whose place the second picture does not have: behind the camera, or beyond the lens.
// Above 1e9, as in Middlebury's .flo files (Baker et al., IJCV 92, 2011: "unknown").
inline constexpr float kUnknownFlow_px = 1e10f;

// Both have the layers object and position. Without the layer part in the first, parts that turn are taken to
// move with their object.
FlowImage optical_flow(const FrameTruth& from, const FrameTruth& to);

}  // namespace hilcam
