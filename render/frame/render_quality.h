#pragma once
// Speed against accuracy, and the models to render with: what the user chooses of the renderer.

#include <cstdint>
#include <string>

#include "render/paths/modules.h"
#include "render/visibility/pixel_samples.h"
#include "render/vocabulary/config_field.h"
#include "render/vocabulary/units.h"

namespace hilcam {

// Every value here is a named choice of the user. Those that may change from frame to frame are marked in
// fields().
struct RenderQuality {
    std::int64_t samples_per_axis = 1;  // n: a regular n x n grid of rays in each pixel
    std::string visibility = "rays";    // or "buffer": buffer_samples a pixel where it can
    std::int64_t buffer_samples = 16;   // or 64; 1: of ground alone
    std::int64_t ground_step_px = 1;    // or 2: of ground alone, by every second pixel (ground_upsampler.h)
    std::string path_model = "path";
    std::int64_t max_depth = 2;            // 1: direct light only; 2: one bounce; ...
    double contribution_threshold = 1e-3;  // see path_model.h
    bool sun_disk = false;                 // light from places by chance on the disk; false: from its middle
    std::int64_t probe_directions = 60;    // cached light: 16, 60 or 256
    std::int64_t probes = 100'000;         // about, of all objects together
    double source_step_rad = 1.0 * kDegree_rad;
    bool earth_impostor = false;         // the Earth by its model from a kept picture, from afar
    double facets_behind_diffuse = 0.4;  // least GGX alpha there; 0: as they are
    bool watertight = true;              // no ray slips through between two triangles
    double lod_error_px = 0.15;          // error of a coarser level of detail; 0: the mesh itself, always
    std::int64_t rays_across =
        128;  // rays across a small object: 64 keep 0.5 % of its flux, 512 a centroid to 0.01 px
    std::int64_t point_samples = 96;  // rays along one axis of the little picture of an object of few pixels
    std::int64_t min_point_samples =
        512;  // fewer for smaller ones, down to so many; not more than point_samples

    bool uses_buffer() const { return visibility == "buffer" && buffer_samples > 1; }
    // Light that is drawn by chance over the Sun's disk is drawn over the pixel, too (Cook, Porter & Carpenter, Distributed Ray
    // Tracing, SIGGRAPH 84): frames that are averaged then have no grid in common.
    bool scatters_rays() const { return sun_disk && !uses_buffer(); }
    // Ground alone is seen once a pixel, sixteen pixels at a time (ground_light.h).
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
