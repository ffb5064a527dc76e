#pragma once
// The path model of a plug-in, and its view of the renderer: surfaces that light paths have met, how they
// scatter light, and how light is added to the picture. Such a plug-in includes no other header of the
// renderer's light; the renderer may change everything else without a new kPathPluginInterface.
//
//     #include "render/paths/path_plugin.h"
//     class Mine final : public hilcam::PathPlugin { ... };
//     HILCAM_PATH_PLUGIN("mine", Mine)
//
// Directions are unit vectors in world axes. Positions are in ray space: metres, world axes, from an origin
// that the frame chooses.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "render/vocabulary/light_part.h"
#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// A surface that a light path has met. It is valid only during the call of PathPlugin::light() that receives
// it.
struct PathPoint {
    Vec3f point_m;           // in ray space
    Vec3f geometric_normal;  // on the viewer's side
    Vec3f normal;            // shading normal, on the same side
    Vec3f view_dir;          // back along the path
    Spectrum throughput;     // share of the light it sends that reaches its pixel
    float samples;           // number of samples its throughput is for; contribution_threshold() is for one
    std::uint32_t pixel;     // in the tile, row by row
    int depth;               // 1: the camera sees it
    bool scatters;           // some light is scattered in all directions; false: only exact directions
    const void* inside;      // the renderer's own data

    // Returns the value to compare with contribution_threshold().
    float importance(const Spectrum& of) const { return max_component(of) / samples; }
};

// A direction from which light reaches a surface that scatters it towards the viewer.
struct PathDirection {
    Vec3f dir;
    Spectrum weight;         // f cos / density of directions; for exact ones: reflectance or transmittance
    bool exact = false;      // the one direction of a mirror or a sheet
    bool transmits = false;  // continues on the other side
    bool sees_sun = false;   // add_direct_light() has left out the Sun in this direction
};

// A ray that leaves a surface.
struct PathRay {
    Vec3f dir;
    Spectrum throughput;        // the surface's, times the direction's weight
    LightPart part;             // part of the light from surfaces on its way
    LightPart background_part;  // part of the light that it finds if it meets none
    float spread_rad = 0;       // the cone that it represents
    bool below = false;         // starts on the other side
    bool sees_bodies = true;    // finds bodies and air if it meets no surface
    bool sees_sun = false;      // also finds the Sun's disk there
};

// The Earth, the Moon or a planet, as a source of light.
struct PathBody {
    Vec3f dir;                // from the objects to its centre
    float one_minus_cosine;   // 1 - cosine of its half angle
    float cone_sine_squared;  // sin^2 of its half angle; 1 inside it
    float max_over_sun;       // largest radiance over the Sun's irradiance [sr^-1]
};

class PathPlugin;

// The renderer's services for a path model. One thread at a time.
class PathView {
  public:
    // The largest number of rays in one call of follow().
    static constexpr std::size_t kMaxRays = 64;

    // Returns the largest number of surfaces on a path.
    virtual int max_depth() const = 0;
    // Returns the least importance with which a path continues.
    virtual float contribution_threshold() const = 0;
    // True when the camera is in air, so that there is a sky.
    virtual bool in_air() const = 0;
    // Returns the bodies that light the objects.
    virtual std::span<const PathBody> bodies() const = 0;

    // Returns f [sr^-1] for light from that direction; zero from below, and for exact directions.
    virtual Spectrum brdf(const PathPoint& at, Vec3f dir) const = 0;
    // Returns an exact direction: 0 reflection, 1 transmission; nothing if there is none.
    virtual std::optional<PathDirection> exact_direction(const PathPoint& at, int number) const = 0;
    // Draws a direction roughly in proportion to f cos, by the sample's own random numbers; nothing if it
    // leads below.
    virtual std::optional<PathDirection> random_direction(const PathPoint& at) const = 0;

    // Adds light that a surface sends to its pixel. light: radiance times the surface's throughput.
    virtual void add(const PathPoint& at, LightPart part, const Spectrum& light) = 0;
    // Adds the light of the Sun and of lamps that surfaces reflect, and what they emit. points: as passed to
    // light().
    virtual void add_direct_light(std::span<const PathPoint> points) = 0;
    // Adds the light of bodies that reaches a surface along directions to them, if nothing is in the way.
    virtual void add_body_light(const PathPoint& at, std::span<const PathDirection> directions) = 0;
    // Follows rays from a surface: adds the light of those that leave the scene, and calls the model to light
    // the surfaces that the others meet, up to max_depth(). Everything added in the meantime is summed
    // separately, so that many small parts keep their digits.
    virtual void follow(const PathPoint& at, std::span<const PathRay> rays, PathPlugin& model) = 0;

  protected:
    ~PathView() = default;
};

// A path model. The renderer has one per thread and calls it in the loop: it must not allocate or throw.
class PathPlugin {
  public:
    virtual ~PathPlugin() = default;

    // Adds the light of surfaces, all at one depth, that the camera sees or that rays have met.
    virtual void light(PathView& view, std::span<const PathPoint> points) = 0;
    // The view treats facet lobes narrower than this (GGX alpha) as mirrors of the same albedo; 0: no limit.
    virtual float narrowest_alpha() const { return 0; }
};

// Raised with every change of this header.
inline constexpr std::uint32_t kPathPluginInterface = 1;
inline constexpr std::uint32_t kPathPluginSizes = static_cast<std::uint32_t>(
    sizeof(PathPoint) * 31 + sizeof(PathDirection) * 37 + sizeof(PathRay) * 41 + sizeof(PathBody) * 43);

struct PathPluginInfo {
    std::uint32_t interface_version;
    std::uint32_t shared_sizes;
    const char* compiler;
    const char* name;       // word of quality.path_model
    PathPlugin* (*make)();  // the caller owns the result
};

}  // namespace hilcam

#define HILCAM_PATH_PLUGIN(model_name, Model)                                                              \
    extern "C" __attribute__((visibility("default"))) const hilcam::PathPluginInfo* hilcam_path_plugin() { \
        static const hilcam::PathPluginInfo info{hilcam::kPathPluginInterface, hilcam::kPathPluginSizes,   \
                                                 __VERSION__, model_name,                                  \
                                                 []() -> hilcam::PathPlugin* { return new Model; }};       \
        return &info;                                                                                      \
    }
