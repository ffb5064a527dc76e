#pragma once
// Places everything for one frame and finds what may be seen: objects at their levels of detail, bodies,
// terrain, the plan, and the part of the picture in which rays can meet something. possible_world.h removes
// what is impossible, visibility_choice.h picks the visibility buffer, and earth_view.h the way to draw the
// Earth.
//
// It owns the scene. Its result is a FrameContext, which the tracing threads only read.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/background/background.h"
#include "render/frame/cache_handover.h"
#include "render/frame/earth_view.h"
#include "render/frame/image_motion.h"
#include "render/frame/plan.h"
#include "render/frame/possible_world.h"
#include "render/frame/render_quality.h"
#include "render/frame/visibility_choice.h"
#include "render/indirect/indirect_cache.h"
#include "render/scene/color_bands.h"
#include "render/scene/embree_scene.h"
#include "render/scene/scene.h"
#include "render/scene/shown_object.h"
#include "render/scene/shown_terrain.h"
#include "render/shading/frame_context.h"
#include "render/shading/lamp_light.h"
#include "render/shading/path_model.h"
#include "render/shading/radiance_model.h"
#include "render/sky/star_sky.h"
#include "render/visibility/screen_mask.h"
#include "render/visibility/visibility_buffer.h"

namespace hilcam {

class FrameSetup {
  public:
    // Takes ownership of the scene and builds the acceleration structures. levels: the qualities that frames
    // may have; the first is used until set_quality(). Throws InputError. Owner thread.
    FrameSetup(Scene scene, const SpectralGrid& grid, const ImageGeometry& geometry,
               std::span<const RenderQuality> levels, const RenderModels& models, const Modules& modules);
    FrameSetup(const FrameSetup&) = delete;  // frame_ points into it
    FrameSetup& operator=(const FrameSetup&) = delete;

    // Applies the values of the quality that may change, and its path model, from the next place() on. Loop.
    void set_quality(const RenderQuality& quality, const PathModel& paths);
    // See the functions of the same names in Renderer.
    void give_tables(std::span<const std::shared_ptr<const TransferTable>> tables);
    bool take_light();
    void stop_looking_ahead() {
        if (indirect_) indirect_->stop_looking_ahead();
        earth_view_.stop_looking_ahead();
    }
    // Prepares the placed frame for tracing: sorts its triangles if the quality has a visibility buffer.
    // Loop.
    void place_visibility();
    // Sets the path model alone; also used to try one (render_bench.h).
    void set_paths(const PathModel& paths);
    // Places the world. An impossible object (motion_bounds.h) is left out of the frame; an impossible camera
    // or body keeps its last state. Loop; no allocation after the first call.
    void place(const WorldSnapshot& world, RandomKey key);
    // Does the same without cached light, for callers that only need to know where things are. Loop.
    void place_shapes(const WorldSnapshot& world, RandomKey key);
    // Makes the terrain's first mesh, for which the first frame would wait. Does nothing for terrain that
    // waits, because that makes a mesh for each frame anyway. Owner thread.
    void make_ground_ahead(const WorldSnapshot& world) {
        if (terrain_ && !terrain_->waits()) place_shapes(world, {});
    }

    // --- the frame that was placed last

    const FrameContext& frame() const { return frame_; }
    const WorldSnapshot& world() const { return world_; }  // includes the terrain among its objects
    MovingFrame moving() const;
    const ObjectPlan& plan(std::size_t object) const { return plans_[object]; }
    bool is_point(std::size_t object) const { return frame_.is_point[object] != 0; }
    // Returns how many things have been left out as impossible so far.
    std::uint64_t left_out() const { return possible_.left_out(); }
    // Returns the object as the placed frame shows it.
    VisibilityBuffer::Shown shown(std::size_t object) const;
    // Returns the buffer size for pictures of single objects (object_impostor.h); empty if there are none.
    const std::optional<VisibilityBuffer::Capacity>& impostor_capacity() const {
        return visibility_.impostor_capacity();
    }
    double radius_m(std::size_t object) const { return radii_m_[object]; }
    const ShownObject& object(std::size_t object) const { return objects_[object]; }
    // True when the last object is the ground.
    bool has_terrain() const { return terrain_ != nullptr; }
    // Returns the camera's height over the terrain; nothing without terrain and beside its map.
    std::optional<double> height_above_ground_m() const {
        return terrain_ ? terrain_->height_above_ground_m() : std::nullopt;
    }
    // Returns the pixels that may show the sphere around an object.
    PixelBox box_of(std::size_t object) const;
    // True when a camera ray through the box may meet something.
    bool can_see_anything(const PixelBox& box) const {
        return frame_.object_mask->any(box) || frame_.may_see_body(box) || box.overlaps(frame_.sun_box);
    }
    // True when the frame shows a body's disk, or terrain on a body.
    bool shows_body() const;
    // Returns the rays along one axis of a pixel: as many as the smallest thing in the box needs.
    int samples_in(const PixelBox& box) const;
    std::vector<std::string> explain(const RenderQuality& quality) const;

    // --- the scene

    std::size_t objects() const { return objects_.size(); }
    std::size_t triangles() const { return triangles_; }
    const StarSky& stars() const { return stars_; }
    std::size_t max_stars() const { return max_stars_; }  // largest number of stars in one frame
    const Background& background() const { return background_; }
    const Lamps& lamps() const { return lamps_; }
    const Atmosphere* air() const { return air_.get(); }                       // may be null
    const DetailStream* earth_detail() const { return earth_view_.detail(); }  // may be null
    EmbreeScene& embree() { return embree_; }                                  // for measurements

  private:
    std::size_t triangles_ = 0;
    EmbreeScene embree_;
    std::vector<ShownObject> objects_;  // the terrain, if any, is the last one
    PossibleWorld possible_;
    WorldSnapshot& world_;                      // belongs to possible_
    std::vector<std::size_t> levels_;           // level of detail of each object
    std::vector<const ObjectSurfaces*> shown_;  // at that level
    std::vector<double> radii_m_;
    std::vector<ObjectPlan> plans_;
    std::vector<PixelBox> object_boxes_;  // pixels that may show each object
    Lamps lamps_;
    StarSky stars_;
    std::size_t max_stars_;
    std::array<SceneBody, kMaxBodies> bodies_;
    std::unique_ptr<Atmosphere> air_;
    std::shared_ptr<const EarthModel> earth_;
    ColorBands bands_;
    Background background_;
    IndirectCache::Settings indirect_settings_;
    std::unique_ptr<IndirectCache> indirect_;  // null until its tables have arrived
    CacheHandover handover_;
    bool uses_indirect_cache_ = false, any_placed_ = false;
    ScreenMask object_mask_, full_mask_;
    std::unique_ptr<RayGenerator> rays_;
    std::unique_ptr<RadianceModel> radiance_model_;
    std::unique_ptr<ShownTerrain> terrain_;
    double lod_error_px_;
    RayDensity density_;
    EarthView earth_view_;
    VisibilityChoice visibility_;
    FrameContext frame_;

    std::unique_ptr<IndirectCache> make_indirect_cache() const;
    void use_indirect_cache();
    void choose_levels();
    void place_objects();
    void place_background();
    std::size_t plain_ground_triangles(const ImageGeometry& geometry) const;
    RayDensity density_for(std::size_t object) const;
};

}  // namespace hilcam
