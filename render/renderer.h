#pragma once
// The radiance engine: a scene and a world snapshot in, a radiance image and a list of point sources out.
//
// Radiance is equation (1) of Peng et al. 2011. What it is made of are exchangeable models (modules.h): the
// camera's rays (ray_generator.h), how light is followed (path_model.h), what a surface sends by itself
// (radiance_model.h), and the air (atmosphere.h). Before each frame a plan decides what this one needs
// (plan.h).

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "render/config_field.h"
#include "render/image.h"
#include "render/image_geometry.h"
#include "render/image_motion.h"
#include "render/modules.h"
#include "render/plan.h"
#include "render/point_source.h"
#include "render/random.h"
#include "render/scene.h"

namespace hilcam {

// Speed against accuracy; every value here is a named choice of the user.
struct RenderQuality {
    std::int64_t samples_per_axis = 1;  // n: a regular n x n grid of rays in each pixel
    std::string path_model = "path";
    std::int64_t max_depth = 2;            // 1: direct light only; 2: one bounce; ...
    double contribution_threshold = 1e-3;  // see path_model.h
    bool sun_disk = false;                 // soft shadows and exact highlights; false: a point at its middle
    double facets_behind_diffuse = 0.4;    // least GGX alpha there; 0: as they are
    bool watertight = true;                // no ray slips through between two triangles
    double lod_error_px = 0.25;            // of a coarser level of detail; 0: the mesh itself, always
    std::int64_t rays_across =
        128;  // of a small object: 64 keep 0.5 % of its flux, 512 a centroid to 0.01 px
    std::int64_t point_samples = 96;  // of an object of few pixels, along one axis of its little picture
};
Fields fields(RenderQuality& quality);

// The chosen models, by name.
struct RenderModels {
    RayConfig rays;
    std::string radiance = "reflected";
};

struct RenderStats {
    std::uint64_t primary_rays = 0;
    std::uint64_t shadow_rays = 0;
    std::uint64_t secondary_rays = 0;
    double coverage = 0;   // share of the frame's samples that meet an object
    double setup_ms = 0;   // instances, plan, background
    double trace_ms = 0;   // rays and shading
    double points_ms = 0;  // stars, and what is smaller than a pixel
};

// How fast a path model is against Embree alone on the same rays.
struct PathModelSpeed {
    std::string name;
    std::uint64_t rays = 0;  // of all kinds, of one frame
    double frame_ms = 0;
    double bare_ms = 0;  // Embree alone
};

class Renderer {
  public:
    // Builds the acceleration structures; takes the scene over. Throws InputError. Owner thread.
    Renderer(Scene scene, const SpectralGrid& grid, const ImageGeometry& geometry,
             const RenderQuality& quality, const RenderModels& models = {}, const Modules& modules = {});
    ~Renderer();

    // Fills `radiance` (padded size, a plane per bin) and `points` (cleared first; capacity reserved by
    // reserve_points). Loop: after the first call with this thread pool nothing is allocated. Runs on oneTBB;
    // the result does not depend on the thread count.
    void render(const WorldSnapshot& world, RandomKey key, RadianceImage& radiance,
                std::vector<PointSource>& points, RenderStats& stats);

    // How the picture of `middle` moves from the one world to the other. Loop, as render().
    ImageMotion motion(const WorldSnapshot& middle, const WorldSnapshot& before, const WorldSnapshot& after);
    // The same of the world that was rendered last.
    ImageMotion motion_of_last(const WorldSnapshot& before, const WorldSnapshot& after);
    // Sets the drifts of the points that it gave: the way from one world to the other, times per_s.
    void set_drifts(const WorldSnapshot& before, const WorldSnapshot& after, double per_s,
                    std::span<PointSource> points);
    // A body's disk or terrain on one may be in the last picture: how it moves depends on the bodies.
    bool last_shows_body() const;

    // An upper bound of the points that render() can give.
    std::size_t most_points() const;
    std::size_t triangles() const;
    const ImageGeometry& geometry() const;

    // What a frame of this world needs and why, a line each. Not for the loop.
    std::vector<std::string> explain_plan(const WorldSnapshot& world);

    // Throws InputError where the atmosphere does not cover what the camera sees of the Earth: what is
    // missing. For the first instant of a run; what leaves the table later is counted. Not for the loop.
    void require_air(const WorldSnapshot& world);
    std::uint64_t rays_outside_air() const;

    // Time that bare Embree needs for the primary and shadow rays of this frame, on the same threads [ms]:
    // the floor that no renderer built on it can go below. Not for the loop.
    double floor_ms(const WorldSnapshot& world);

    // One frame with every path model of the registry, medians of `runs`. Not for the loop.
    std::vector<PathModelSpeed> path_model_speeds(const WorldSnapshot& world, const Modules& modules,
                                                  int runs);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace hilcam
