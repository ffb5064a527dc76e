#pragma once
// The radiance engine: a scene and a world snapshot in, a radiance image and a list of point sources out.
//
// Radiance is equation (1) of Peng et al. 2011. What it is made of are exchangeable models (modules.h): the
// camera's rays (ray_generator.h), how light is followed (path_model.h), what a surface sends by itself
// (radiance_model.h), and the air (atmosphere.h). Before each frame a plan decides what this one needs
// (plan.h).

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
    double coverage = 0;           // share of the frame's samples that meet an object
    double setup_ms = 0;           // instances, plan, background
    double trace_ms = 0;           // rays and shading
    double points_ms = 0;          // stars, and what is smaller than a pixel
    std::uint64_t not_finite = 0;  // pixels and points whose light was no number, and was left out
};

class Renderer {
  public:
    // Builds the acceleration structures; takes the scene over. Throws InputError. Owner thread.
    // lower: qualities that use_level() may choose instead, from 1 on. Only what RenderQuality marks may be
    // different in them; the rest stays that of `quality`, which is level 0.
    Renderer(Scene scene, const SpectralGrid& grid, const ImageGeometry& geometry,
             const RenderQuality& quality, const RenderModels& models = {}, const Modules& modules = {},
             std::span<const RenderQuality> lower = {});
    ~Renderer();

    // The quality of the next frames. Loop: nothing is allocated.
    void use_level(std::size_t level);
    const RenderQuality& quality() const;
    // Takes the tables that a scene's light was waiting for: transfer tables, by object, null where
    // there is no other than the scene had. Makes of them what frames need and hands it over. One thread
    // beside the loop, once.
    void give_tables(std::span<const std::shared_ptr<const TransferTable>> tables);
    // Lets the next frames have cached light if it has come. False: it has not, and their quality asks for it:
    // they are made with random paths. Loop, between two frames: no lock, nothing is allocated.
    bool take_light();
    // Ends the threads that make cached light and the Earth's picture before frames ask for them: they are the same
    // without. For who makes single pictures, or is about to fork. Owner thread.
    void stop_looking_ahead();

    // From the next frame on also takes pictures apart: buffer gets what each part of the light has in them, and record what lies in
    // its pixels; null: no more. Pictures are the same to the last bit. buffer: make_parts_buffer()'s. Loop,
    // between frames: nothing is allocated.
    void keep_parts(PartsBuffer* buffer, PixelRecord* record = nullptr);
    // Returns memory for that. like: an image like those that render() fills. only: the one part that is wanted; none: all are. Any
    // thread.
    PartsBuffer make_parts_buffer(const RadianceImage& like,
                                  std::optional<LightPart> only = std::nullopt) const;
    // Says what surface sends the light of a record's entry, one with a surface, in the frame that was rendered last. Not for the
    // loop.
    RecordedSurface surface_of(const PixelRecord::Entry& entry) const;

    // Fills `radiance` (padded size, a plane per bin) and `points` (cleared first; capacity reserved by
    // reserve_points). Loop: after the first call with this thread pool nothing is allocated. Runs on oneTBB;
    // the result does not depend on the thread count.
    void render(const WorldSnapshot& world, RandomKey key, RadianceImage& radiance,
                std::vector<PointSource>& points, RenderStats& stats);

    // Returns how the picture of `middle` moves from the one world to the other. Loop, as render().
    ImageMotion motion(const WorldSnapshot& middle, const WorldSnapshot& before, const WorldSnapshot& after);
    // The same of the world that was rendered last.
    ImageMotion motion_of_last(const WorldSnapshot& before, const WorldSnapshot& after);
    // Sets the drifts of the points that it gave: the way from one world to the other, times per_s.
    void set_drifts(const WorldSnapshot& before, const WorldSnapshot& after, double per_s,
                    std::span<PointSource> points);
    // A body's disk or terrain on one may be in the last picture: how it moves depends on the bodies.
    bool last_shows_body() const;

    // Places a world for report_truth() alone, without its light, which may take longer than all else. Loop.
    void place_for_truth(const WorldSnapshot& world);

    // A record with room for what frames show, up to a size of them. Owner thread.
    FrameTruth make_truth(const TruthRequest& request, int width_px, int height_px) const;
    // Fills `truth` with what the world shows that was placed last, by render(), motion() or place_for_truth(); its raster is
    // set. Loop, as render().
    void report_truth(FrameTruth& truth) const;

    // Finds what shines from beside the picture of the world that was placed last (find_side_light.h). Loop, as
    // render(); room for kMaxSideLights.
    void find_side_light(std::vector<SideLight>& lights) const;

    // An upper bound of the points that render() can give.
    std::size_t max_points() const;
    std::size_t triangles() const;
    // Returns the radius of the sphere about an object's origin that holds it, in the scene's order.
    double object_radius_m(std::size_t object) const;
    const ImageGeometry& geometry() const;

    // Says what a frame of this world needs and why, a line each. Not for the loop.
    std::vector<std::string> explain_plan(const WorldSnapshot& world);

    // Makes what the first frame would wait for, by a world before it: a mesh of terrain. Not for the loop.
    void make_ground_ahead(const WorldSnapshot& world);

    // Throws InputError where the atmosphere does not cover what the camera sees of the Earth: what is
    // missing. For the first instant of a run; what leaves the table later is counted. Not for the loop.
    void require_air(const WorldSnapshot& world);
    std::uint64_t rays_outside_air() const;
    // Says what is wrong with the frames so far: maps that could not be read where they looked, light that was no
    // number, and how often; empty: nothing. Any thread.
    std::string fault() const;
    // Returns how much of the frame that is being rendered is traced, 0 to 1. Any thread.
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
