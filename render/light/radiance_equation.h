#pragma once
// Equation (1) of Peng et al. 2011 at one surface: L = eps L_T + E_s tau_1 cos(sigma) f + (light of the
// bodies) + (light of lamps, lamp_light.h). Sun: a point at the middle of its disk, with highlights as wide
// as the disk makes them, or its disk by sampling.

#include <memory>

#include "render/light/radiance_model.h"

namespace hilcam {

std::unique_ptr<RadianceModel> make_radiance_equation(bool emission);

// Density [sr^-1] of the directions that kSampled draws to all bodies together, for a vertex; what a path's
// own direction is weighed against.
float lamp_density(const FrameView& frame, const Vertex& at, Vec3f dir);
// The same for the Sun's disk; 0 where the Sun is a point or the direction is off its disk.
float sun_density(const FrameView& frame, Vec3f dir);

}  // namespace hilcam
