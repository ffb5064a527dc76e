#include "render/frame/render_quality.h"

namespace hilcam {

Fields fields(RenderQuality& q) {
    return {
        integer("samples_per_axis", q.samples_per_axis, {1, 16}, "n: each pixel is an n x n grid of rays"),
        text("visibility", q.visibility,
             "rays, or buffer: what the camera sees by sixteen samples a pixel at once, where all rows have "
             "one instant, there is no terrain and the lens bends lines little within 16 pixels (elsewhere "
             "rays)"),
        text("path_model", q.path_model, "kept | direct | hemisphere | path, or a plug-in's"),
        integer("max_depth", q.max_depth, {1, 64},
                "surfaces that a light path may meet; 1: direct sunlight only"),
        number("contribution_threshold", q.contribution_threshold, 1, {0, 1},
               "a path whose largest weight falls below this ends (hemisphere, kept), or lives on by chance "
               "(path)"),
        flag("sun_disk", q.sun_disk, "sunlight from the whole disk: soft shadows, exact highlights"),
        integer("kept_directions", q.kept_directions, {16, 256},
                "kept: directions that each place's light comes from, 16, 60 or 256"),
        integer("kept_nodes", q.kept_nodes, {1000, 4'000'000},
                "kept: about so many places on all objects together, where light is kept"),
        number("kept_step_deg", q.kept_step_rad, kDegree_rad, {0.01, 10},
               "kept: the grid that directions of the Sun and the bodies are rounded to, in an object's own "
               "axes; what turns faster than two steps a second has a wider one, to 10 degrees"),
        number("facets_behind_diffuse", q.facets_behind_diffuse, 1, {0, 1},
               "path: least GGX alpha of surfaces seen by way of a diffuse one, against sparkle; 0: as they "
               "are"),
        flag("watertight", q.watertight,
             "no ray slips through the edge that two triangles share, as none ever does through terrain; "
             "costs a sixth"),
        number("lod_error_px", q.lod_error_px, 1, {0, 16},
               "a mesh may be this far off, in pixels, where it is drawn from a coarser level; 0: never"),
        integer(
            "rays_across", q.rays_across, {0, 4096},
            "an object of some pixels gets more rays per pixel, up to 16 x 16, until so many go across it"),
        integer("point_samples", q.point_samples, {16, 512},
                "an object of a few pixels or less is measured by a grid of so many rays in each direction"),
        number("noise_budget", q.noise_budget, 1, {0, 100},
               "a pixel is sampled again only while the standard error of its rendering is above this share "
               "of its own sensor noise; rays are then scattered over the pixel; 0: once, on the grid"),
        // Numbers are drawn by sample and depth: 63 passes of 16 x 16 samples fit (random.h).
        integer("most_passes", q.most_passes, {1, 63}, "with a noise budget: n x n rays each"),
    };
}

}  // namespace hilcam
