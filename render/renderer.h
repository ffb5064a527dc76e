#pragma once
// The radiance engine: a scene and a world snapshot in, a radiance image and a list of point sources out.
//
// Radiance is equation (1) of Peng et al. 2011 without air and emission: direct Sun E_s cos(sigma) f_r with a
// shadow ray, plus light from the hemisphere by recursion up to max_depth: mirror-like surfaces along one
// sampled facet, diffuse ones along one cosine-distributed direction (Malley), each weighted by f_r cos /
// pdf. A recursion stops when it leaves the scene, when its weight falls below contribution_threshold, or at
// max_depth. The Earth is an ellipsoid in double precision; the Sun is a point at its distance for shading;
// stars are points.

#include <cstdint>
#include <memory>
#include <vector>

#include "render/config_field.h"
#include "render/image.h"
#include "render/point_source.h"
#include "render/random.h"
#include "render/ray_generator.h"
#include "render/scene.h"

namespace hilcam {

// Speed against accuracy; every value here is a named choice of the user.
struct RenderQuality {
    std::int64_t samples_per_axis = 1;     // n: a regular n x n grid of rays in each pixel
    std::int64_t max_depth = 2;            // 1: direct light only; 2: one bounce; ...
    double contribution_threshold = 1e-3;  // a path whose largest weight is below this is not followed
};
Fields fields(RenderQuality& quality);

struct RenderStats {
    std::uint64_t primary_rays = 0;
    std::uint64_t shadow_rays = 0;
    std::uint64_t secondary_rays = 0;
    double coverage = 0;   // share of the frame's samples that meet an object
    double setup_ms = 0;   // instances, plan, background
    double trace_ms = 0;   // rays and shading
    double points_ms = 0;  // stars
};

class Renderer {
  public:
    // Builds the acceleration structures; takes the scene over. Throws InputError. Owner thread.
    Renderer(Scene scene, const SpectralGrid& grid, const ImageGeometry& geometry,
             const RenderQuality& quality);
    ~Renderer();

    // Fills `radiance` (padded size, a plane per bin) and `points` (cleared first; capacity reserved by
    // reserve_points). Loop: after the first call with this thread pool nothing is allocated. Runs on oneTBB;
    // the result does not depend on the thread count.
    void render(const WorldSnapshot& world, RandomKey key, RadianceImage& radiance,
                std::vector<PointSource>& points, RenderStats& stats);

    // An upper bound of the points that render() can give.
    std::size_t most_points() const;
    std::size_t triangles() const;
    const ImageGeometry& geometry() const;

    // Time that bare Embree needs for the primary and shadow rays of this frame, on the same threads [ms]:
    // the floor that no renderer built on it can go below. Not for the loop.
    double floor_ms(const WorldSnapshot& world);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace hilcam
