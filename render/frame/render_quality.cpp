#include "render/frame/render_quality.h"

namespace hilcam {

Fields fields(RenderQuality& q) {
    return {
        per_frame(integer("samples_per_axis", q.samples_per_axis, {1, 16},
                          "n of the n x n rays in each pixel, on a grid unless sun_disk is true")),
        per_frame(
            text("visibility", q.visibility,
                 "rays; or buffer: what the camera sees is found by many samples a pixel at once. That needs "
                 "one instant for all rows, and a lens that bends lines little within 16 pixels; elsewhere, "
                 "and for terrain with 16 or more samples, rays are used")),
        per_frame(integer("buffer_samples", q.buffer_samples, {1, 64},
                          "number of the visibility buffer's samples in a pixel: 16 or 64; or 1, for terrain "
                          "that is alone in the scene, in the Sun's light (path_model: direct) and by a "
                          "lens without distortion: what one ray a pixel finds, for a third of the time; "
                          "elsewhere it is as visibility: rays")),
        per_frame(
            integer("ground_step_px", q.ground_step_px, {1, 2},
                    "terrain that is alone, with buffer_samples: 1: 1: each pixel is worked out; 2: every "
                    "second one of every second row, and those between by cubic convolution "
                    "(docs/ground.md has the error)")),
        per_frame(text("path_model", q.path_model, "path model: cached | direct | path, or a plug-in's")),
        per_frame(integer("max_depth", q.max_depth, {1, 64},
                          "number of surfaces that a light path may meet; 1: direct sunlight only")),
        per_frame(number(
            "contribution_threshold", q.contribution_threshold, 1, {0, 1},
            "a path whose largest throughput falls below this ends (cached), or lives on by chance (path)")),
        per_frame(flag(
            "sun_disk", q.sun_disk,
            "true: sunlight comes from the whole disk, which gives soft shadows and exact highlights. "
            "Rays (visibility: rays) then go through random places of their pixels in place of a grid, so "
            "that averaged frames have no grid in common")),
        integer("probe_directions", q.probe_directions, {16, 256},
                "cached: number of directions that each probe's light comes from: 16, 60 or 256"),
        integer("probes", q.probes, {1000, 4'000'000},
                "cached: approximate number of surface probes, on all objects together"),
        number("source_step_deg", q.source_step_rad, kDegree_rad, {0.01, 10},
               "cached: step of the grid, in an object's own axes, to which directions of the Sun and the "
               "bodies are rounded; an object that turns faster than two steps a second has a wider one, to "
               "10 degrees"),
        flag("earth_impostor", q.earth_impostor,
             "true: the Earth by earth_surface.map is seen as a kept picture where the camera is three radii "
             "or more above it and its "
             "disk is 12 to 1280 pixels wide; false: each pixel is worked out"),
        number("facets_behind_diffuse", q.facets_behind_diffuse, 1, {0, 1},
               "path: least GGX alpha of surfaces seen by way of a diffuse one, which prevents sparkle; 0: "
               "surfaces as they are"),
        flag("watertight", q.watertight,
             "true: no ray slips through the edge that two triangles share (none ever does through terrain); "
             "costs a sixth"),
        per_frame(number("lod_error_px", q.lod_error_px, 1, {0, 16},
                         "greatest error, in pixels, of a mesh drawn from a coarser level, an eighth of it "
                         "for masts, rings and other shapes; 0: never a coarser level")),
        integer("rays_across", q.rays_across, {0, 4096},
                "number of rays across a small object: it gets more rays per pixel, up to 16 x 16, until so "
                "many go across it; with visibility: buffer, up to 32 objects of less than 64 pixels have "
                "pictures of their own instead, of 128 x 128 pixels with 64 samples each; 0: none of it"),
        integer("point_samples", q.point_samples, {16, 512},
                "rays in each direction of the grid by which an object of 8 pixels or less is measured"),
        integer("min_point_samples", q.min_point_samples, {8, 512},
                "smaller objects have fewer of these rays, as the power 2/3 of their size, which leaves the "
                "error its share of their light's own noise, down to this number; from point_samples on: "
                "all have as many"),
    };
}

}  // namespace hilcam
