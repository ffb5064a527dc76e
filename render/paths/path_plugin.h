#pragma once
// The path model of a plug-in, and what it sees of the renderer: surfaces that light paths have met, how they scatter, and light that
// is added to the picture. This header is all that such a plug-in includes of the renderer's light; what the renderer keeps beside
// it may change without a new kPathPluginInterface.
//
//     #include "render/paths/path_plugin.h"
//     class Mine final : public hilcam::PathPlugin { ... };
//     HILCAM_PATH_PLUGIN("mine", Mine)
//
// Directions are unit vectors in world axes; places are in ray space: metres, world axes, counted from a point that a frame chooses.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "render/vocabulary/light_part.h"
#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// A surface that a light path has met. It is valid while the call of PathPlugin::light() runs that it was given to.
struct PathPoint {
    Vec3f point_m;           // in ray space
    Vec3f geometric_normal;  // towards the viewer's side
    Vec3f normal;            // shading normal, on the same side
    Vec3f view_dir;          // back along the path
    Spectrum throughput;     // share of the light that it sends which reaches its pixel
    float samples;           // its throughput is that of so many samples; contribution_threshold() is for one
    std::uint32_t pixel;     // in the tile, row by row
    int depth;               // 1: the camera sees it
    bool scatters;           // some light goes in all directions; false: exact directions are all there is
    const void* inside;      // the renderer's own knowledge of it

    // Returns the figure that contribution_threshold() is held against.
    float importance(const Spectrum& of) const { return max_component(of) / samples; }
};

// One direction in which light reaches a surface that sends it on towards the viewer.
struct PathDirection {
    Vec3f dir;
    Spectrum weight;  // f cos over the density of directions; of an exact one: reflectance or transmittance
    bool exact = false;      // a mirror's or a sheet's one direction
    bool transmits = false;  // goes on to the other side
    bool sees_sun = false;   // add_direct_light() has left out the Sun there
};

// A ray that leaves a surface.
struct PathRay {
    Vec3f dir;
    Spectrum throughput;        // the surface's, times the direction's weight
    LightPart part;             // part of the light that surfaces on its way send
    LightPart background_part;  // part of the light that it finds where it meets none
    float spread_rad = 0;       // the cone for which it stands
    bool below = false;         // leaves to the other side
    bool sees_bodies = true;    // finds bodies and air where it meets no surface
    bool sees_sun = false;      // finds the Sun's disk there, too
};

// The Earth, the Moon or a planet, as a source of light.
struct PathBody {
    Vec3f dir;                // from the objects to its centre
    float one_minus_cosine;   // 1 - cosine of its half angle
    float cone_sine_squared;  // square of the sine of its half angle; 1 inside it
    float max_over_sun;       // greatest radiance over the Sun's irradiance [sr^-1]
};

class PathPlugin;

// Answers what a path model asks for. One thread at a time.
class PathView {
  public:
    // Greatest number of rays that follow() takes at once.
    static constexpr std::size_t kMaxRays = 64;

    // Returns the number of surfaces that a path may meet at most.
    virtual int max_depth() const = 0;
    // Returns the least importance of a path that goes on.
    virtual float contribution_threshold() const = 0;
    // True when there is a sky: air about the camera.
    virtual bool in_air() const = 0;
    // Returns the bodies that light the objects.
    virtual std::span<const PathBody> bodies() const = 0;

    // Returns f [sr^-1] for light from that direction; zero from below, and of exact directions.
    virtual Spectrum brdf(const PathPoint& at, Vec3f dir) const = 0;
    // Returns an exact direction: 0 reflection, 1 transmission; nothing where there is none.
    virtual std::optional<PathDirection> exact_direction(const PathPoint& at, int number) const = 0;
    // Returns a direction drawn in proportion to f cos, about, by the sample's own random numbers; nothing where it leads below.
    virtual std::optional<PathDirection> random_direction(const PathPoint& at) const = 0;

    // Adds light that a surface sends to its pixel. light: radiance times the surface's throughput.
    virtual void add(const PathPoint& at, LightPart part, const Spectrum& light) = 0;
    // Adds the light of the Sun and of lamps that surfaces reflect, and what they emit. points: as light() was given them.
    virtual void add_direct_light(std::span<const PathPoint> points) = 0;
    // Adds what bodies send to a surface along directions that lead to them, where nothing stands in the way.
    virtual void add_body_light(const PathPoint& at, std::span<const PathDirection> directions) = 0;
    // Follows rays from a surface: adds what those find that leave the scene, and has the model light what the others meet, up to
    // max_depth() surfaces. All that is added meanwhile is summed by itself, so that many small parts keep their digits.
    virtual void follow(const PathPoint& at, std::span<const PathRay> rays, PathPlugin& model) = 0;

  protected:
    ~PathView() = default;
};

// A path model. The renderer has one for each thread, and calls it in the loop: it allocates nothing and throws nothing.
class PathPlugin {
  public:
    virtual ~PathPlugin() = default;

    // Adds the light of surfaces, all of one depth, that the camera sees or that rays have met.
    virtual void light(PathView& view, std::span<const PathPoint> points) = 0;
    // Facet lobes narrower than this (GGX alpha) are mirrors of the same albedo to the view; 0: lobes are as they are.
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
    PathPlugin* (*make)();  // gives a new one to its caller
};

}  // namespace hilcam

#define HILCAM_PATH_PLUGIN(model_name, Model)                                                              \
    extern "C" __attribute__((visibility("default"))) const hilcam::PathPluginInfo* hilcam_path_plugin() { \
        static const hilcam::PathPluginInfo info{hilcam::kPathPluginInterface, hilcam::kPathPluginSizes,   \
                                                 __VERSION__, model_name,                                  \
                                                 []() -> hilcam::PathPlugin* { return new Model; }};       \
        return &info;                                                                                      \
    }
