#include "render/frame/render_quality.h"

namespace hilcam {

Fields fields(RenderQuality& q) {
    return {
        per_frame(integer("samples_per_axis", q.samples_per_axis, {1, 16},
                          "number of rays along each axis of a pixel, on a grid unless sun_disk is true")),
        per_frame(
            text("visibility", q.visibility,
                 "method of finding visible surfaces: rays; or buffer, which finds many samples a pixel at "
                 "once. The buffer needs one instant for all rows and a lens with little curvature within 16 "
                 "pixels; otherwise, and for terrain with 16 or more samples, rays are used")),
        per_frame(
            integer("buffer_samples", q.buffer_samples, {1, 64},
                    "samples a pixel of the visibility buffer: 16, 64, or 1. 1 is for terrain alone in the "
                    "scene, in sunlight (path_model: direct) and with a lens without distortion: the same "
                    "result as one ray a pixel in a third of the time; other scenes use rays")),
        per_frame(integer("ground_step_px", q.ground_step_px, {1, 2},
                          "step between computed pixels over terrain alone in the scene, with "
                          "buffer_samples: 1. 1: every pixel; 2: every second pixel of every second row, "
                          "with cubic convolution between them (docs/ground.md gives the error)")),
        per_frame(text("path_model", q.path_model, "path model: cached, direct, path, or a plug-in's")),
        per_frame(integer("max_depth", q.max_depth, {1, 64},
                          "largest number of surfaces that a light path meets; 1: direct sunlight only")),
        per_frame(
            number("contribution_threshold", q.contribution_threshold, 1, {0, 1},
                   "largest throughput below which a path ends (cached), or survives only by chance (path)")),
        per_frame(flag("sun_disk", q.sun_disk,
                       "true: sunlight comes from the whole disk, for soft shadows and exact highlights. "
                       "Rays (visibility: rays) then pass through random points of their pixels, so that "
                       "averaged frames show no grid")),
        integer("probe_directions", q.probe_directions, {16, 256},
                "cached: number of directions from which each probe receives light: 16, 60 or 256"),
        integer("probes", q.probes, {1000, 4'000'000},
                "cached: approximate number of surface probes on all objects together"),
        number("source_step_deg", q.source_step_rad, kDegree_rad, {0.01, 10},
               "cached: step, in an object's own axes, to which directions of the Sun and bodies are "
               "rounded; wider, up to 10 degrees, for an object that turns more than two steps a second"),
        flag("earth_impostor", q.earth_impostor,
             "true: an impostor (a stored picture) replaces the Earth of earth_surface.map where the camera "
             "is at least three radii above it and its disk is 12 to 1280 pixels wide; false: every pixel is "
             "computed"),
        number("facets_behind_diffuse", q.facets_behind_diffuse, 1, {0, 1},
               "path: smallest GGX alpha of surfaces seen after a diffuse reflection, which prevents "
               "fireflies; 0: no limit"),
        flag("watertight", q.watertight,
             "true: no ray slips between two triangles with a common edge, at a sixth more time (terrain is "
             "always watertight)"),
        per_frame(number("lod_error_px", q.lod_error_px, 1, {0, 16},
                         "largest error, in pixels, of a coarser mesh level, and an eighth of it for masts, "
                         "rings and other shapes; 0: finest level only")),
        integer("rays_across", q.rays_across, {0, 4096},
                "smallest number of rays across a small object, reached with up to 16 x 16 rays a pixel. "
                "With visibility: buffer, up to 32 objects below 64 pixels instead have own pictures of 128 "
                "x 128 pixels with 64 samples each. 0: no extra rays"),
        integer("point_samples", q.point_samples, {16, 512},
                "number of rays along each axis of the grid over an object of 8 pixels or less"),
        integer(
            "min_point_samples", q.min_point_samples, {8, 512},
            "smallest number of these rays: below 8 pixels it falls as the power 2/3 of the object's size, "
            "so that the error keeps its ratio to photon noise; point_samples or more: no reduction"),
    };
}

}  // namespace hilcam
