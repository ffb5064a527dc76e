#pragma once
// The radiance engine: from a scene and a world snapshot it makes a radiance image and a list of point
// sources.
//
// Radiance follows equation (1) of Peng et al. 2011. Its models are exchangeable (modules.h): the camera's
// rays (ray_generator.h), how light is followed (path_model.h), what a surface sends (radiance_model.h), and
// the air (atmosphere.h). Before each frame a plan decides what it needs (plan.h). docs/rendering.md
// describes the steps.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/frame/frame_truth.h"
#include "render/frame/image_motion.h"
#include "render/frame/parts_buffer.h"
#include "render/frame/plan.h"
#include "render/frame/recorded_surface.h"
#include "render/frame/render_quality.h"
#include "render/paths/modules.h"
#include "render/scene/scene.h"
#include "render/shading/pixel_record.h"
#include "render/vocabulary/image_geometry.h"
#include "render/vocabulary/point_source.h"
#include "render/vocabulary/radiance_image.h"
#include "render/vocabulary/random.h"
#include "render/vocabulary/ray_counts.h"
#include "render/vocabulary/side_light.h"

namespace hilcam {

struct PathModelSpeed;  // render_bench.h

struct RenderStats : RayCounts {
    double coverage = 0;           // share of the frame's samples that hit an object
    double setup_ms = 0;           // instances, plan, background
    double trace_ms = 0;           // rays and shading
    double points_ms = 0;          // stars, and things smaller than a pixel
    std::uint64_t not_finite = 0;  // pixels and points whose light was not finite and was dropped
};

class Renderer {
  public:
    // Takes ownership of the scene and builds the acceleration structures. Throws InputError. Owner thread.
    // lower: further qualities for use_level(), from 1 on; `quality` is level 0. They may differ from it only
    // in the values that RenderQuality marks.
    Renderer(Scene scene, const SpectralGrid& grid, const ImageGeometry& geometry,
             const RenderQuality& quality, const RenderModels& models = {}, const Modules& modules = {},
             std::span<const RenderQuality> lower = {});
    ~Renderer();

    // Sets the quality of the next frames. Loop: no allocation.
    void use_level(std::size_t level);
    const RenderQuality& quality() const;
    // Takes the transfer tables for which the scene's light was waiting: one per object, null to keep the
    // scene's own. Builds what frames need and hands it over. Called by one thread beside the loop, once.
    void give_tables(std::span<const std::shared_ptr<const TransferTable>> tables);
    // Lets the next frames use cached light if it has arrived. Returns false if their quality asks for it and
    // it has not arrived; they then use random paths. Loop, between two frames: no lock, no allocation.
    bool take_light();
    // Ends the threads that compute cached light and the Earth's impostor ahead of time. Frames stay the
    // same. For programs that make single pictures or are about to fork. Owner thread.
    void stop_looking_ahead();

    // From the next frame on, also stores each part of the light in `buffer` (made by make_parts_buffer())
    // and the contents of recorded pixels in `record`; null stops that. Pictures stay the same to the last
    // bit. Loop, between frames: no allocation.
    void keep_parts(PartsBuffer* buffer, PixelRecord* record = nullptr);
    // Returns memory for keep_parts(). like: an image like those that render() fills. only: the one part that
    // is wanted; none: all. Any thread.
    PartsBuffer make_parts_buffer(const RadianceImage& like,
                                  std::optional<LightPart> only = std::nullopt) const;
    // Returns the surface that sends the light of a record's entry (one that has a surface) in the last
    // rendered frame. Not for the loop.
    RecordedSurface surface_of(const PixelRecord::Entry& entry) const;

    // Fills `radiance` (padded size, a plane per bin) and `points` (cleared first; the caller reserves
    // max_points()). Loop: no allocation after the first call with this thread pool. Runs on oneTBB; the
    // result does not depend on the number of threads.
    void render(const WorldSnapshot& world, RandomKey key, RadianceImage& radiance,
                std::vector<PointSource>& points, RenderStats& stats);

    // Returns how the picture of `middle` moves from one world to the other. Loop, like render().
    ImageMotion motion(const WorldSnapshot& middle, const WorldSnapshot& before, const WorldSnapshot& after);
    // Returns the same for the world that was rendered last.
    ImageMotion motion_of_last(const WorldSnapshot& before, const WorldSnapshot& after);
    // Sets the drifts of the points that render() returned: their way from one world to the other, times
    // per_s.
    void set_drifts(const WorldSnapshot& before, const WorldSnapshot& after, double per_s,
                    std::span<PointSource> points);
    // True when the last picture may show a body's disk or terrain on a body; its motion then depends on the
    // bodies.
    bool last_shows_body() const;

    // Places a world for report_truth() alone, without its light, which may take longer than everything else.
    // Loop.
    void place_for_truth(const WorldSnapshot& world);

    // Makes a record with room for the truth of frames up to a size. Owner thread.
    FrameTruth make_truth(const TruthRequest& request, int width_px, int height_px) const;
    // Fills `truth` for the world that was placed last by render(), motion() or place_for_truth(). The caller
    // has set its raster. Loop, like render().
    void report_truth(FrameTruth& truth) const;

    // Finds the light from outside the picture of the world that was placed last (find_side_light.h). Loop,
    // like render(); `lights` needs room for kMaxSideLights.
    void find_side_light(std::vector<SideLight>& lights) const;

    // Returns an upper bound of the number of points from render().
    std::size_t max_points() const;
    std::size_t triangles() const;
    // Returns the radius of the sphere about an object's origin that holds it, in the scene's order.
    double object_radius_m(std::size_t object) const;
    const ImageGeometry& geometry() const;

    // Returns what a frame of this world needs and why, one line each. Not for the loop.
    std::vector<std::string> explain_plan(const WorldSnapshot& world);

    // Makes the terrain mesh that the first frame would wait for, from a world before it. Not for the loop.
    void make_ground_ahead(const WorldSnapshot& world);

    // Throws InputError, which says what is missing, if the atmosphere does not cover what the camera sees of
    // the Earth. Call it at the first instant of a run; rays that leave the table later are counted. Not for
    // the loop.
    void require_air(const WorldSnapshot& world);
    std::uint64_t rays_outside_air() const;
    // Describes what is wrong with the frames so far: maps that could not be read, light that was not finite,
    // and how often. Empty: nothing. Any thread.
    std::string fault() const;
    // Returns the share of the present frame that is traced, 0 to 1. Any thread.
    double share_traced() const;

    // See render_bench.h. Not for the loop.
    double floor_ms(const WorldSnapshot& world);
    std::vector<PathModelSpeed> path_model_speeds(const WorldSnapshot& world, const Modules& modules,
                                                  int runs);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace hilcam
