#pragma once
// The user's choices for the renderer: speed against accuracy, and the models.

#include <cstdint>
#include <string>

#include "render/paths/modules.h"
#include "render/visibility/pixel_samples.h"
#include "render/vocabulary/config_field.h"
#include "render/vocabulary/units.h"

namespace hilcam {

// Each value is a key that the user sets. fields() marks those that may change from frame to frame.
struct RenderQuality {
    std::int64_t samples_per_axis = 1;  // n: a regular n x n grid of rays per pixel
    std::string visibility = "rays";    // or "buffer": buffer_samples per pixel where possible
    std::int64_t buffer_samples = 16;   // or 64; 1: for ground alone
    // Or 2: ground alone is shaded at every second pixel (ground_upsampler.h)
    std::int64_t ground_step_px = 1;
    std::string path_model = "path";
    std::int64_t max_depth = 2;            // 1: direct light only; 2: one bounce; ...
    double contribution_threshold = 1e-3;  // see path_model.h
    bool sun_disk = false;                 // draw places on the Sun's disk at random; false: use its middle
    std::int64_t probe_directions = 60;    // for cached light: 16, 60 or 256
    std::int64_t probes = 100'000;         // approximate number for all objects together
    double source_step_rad = 1.0 * kDegree_rad;
    bool earth_impostor = false;         // draw the Earth's model from an impostor when far away
    double facets_behind_diffuse = 0.4;  // least GGX alpha behind diffuse surfaces; 0: no limit
    bool watertight = true;              // no ray passes between two adjacent triangles
    double lod_error_px = 0.15;          // allowed error of a level of detail; 0: always the full mesh
    std::int64_t rays_across =
        128;  // rays across a small object: 64 keep its flux to 0.5 %, 512 its centroid to 0.01 px
    std::int64_t point_samples = 96;  // rays along one axis of the small picture of an object of a few pixels
    std::int64_t min_point_samples = 512;  // smaller objects have fewer, down to this; at most point_samples

    bool uses_buffer() const { return visibility == "buffer" && buffer_samples > 1; }
    // True when rays have random places in their pixels: then light that is drawn over the Sun's disk at
    // random is also drawn over the pixel (Cook, Porter & Carpenter, Distributed Ray Tracing, SIGGRAPH 84),
    // so averaged frames share no grid.
    bool scatters_rays() const { return sun_disk && !uses_buffer(); }
    // True when ground alone is seen once per pixel, sixteen pixels at a time (ground_light.h).
    bool sees_ground() const {
        return visibility == "buffer" && buffer_samples == 1 && samples_per_axis == 1 &&
               path_model == "direct" && !sun_disk;
    }
    PixelSamples pixel_samples() const { return PixelSamples(buffer_samples == 64 ? 8 : 4); }
};
Fields fields(RenderQuality& quality);

// The chosen models, by name.
struct RenderModels {
    RayConfig rays;
    std::string radiance = "reflected";
};

}  // namespace hilcam
