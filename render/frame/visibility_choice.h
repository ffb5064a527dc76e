#pragma once
// The visibility buffers of a camera, and the choice among them for a frame: objects with 4 x 4 or 8 x 8
// samples per pixel, ground alone, or none, in which case rays find what the camera sees.

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "render/frame/plan.h"
#include "render/frame/render_quality.h"
#include "render/scene/shown_object.h"
#include "render/shading/frame_context.h"
#include "render/visibility/potentially_visible_sets.h"
#include "render/visibility/visibility_buffer.h"

namespace hilcam {

class VisibilityChoice {
  public:
    // The objects as the set-up has them; everything must outlive this.
    struct Objects {
        const EmbreeScene& scene;
        const std::vector<ShownObject>& all;
        const std::vector<std::size_t>& levels;              // level of detail of each
        const std::vector<const ObjectSurfaces*>& surfaces;  // at that level
        const std::vector<double>& radii_m;
        std::vector<ObjectPlan>& plans;
        const WorldSnapshot& world;
    };
    explicit VisibilityChoice(const Objects& objects) : objects_(objects) {}

    struct Needs {
        bool has_terrain;  // objects then have no buffer
        // Largest number of triangles of terrain that is plain (is_plain_ground()) and the only object; 0:
        // there is none.
        std::size_t ground_triangles;
        bool has_rows;  // rows have different instants (RayGenerator::row_motion())
    };
    // Makes the buffers that frames of these qualities need. Owner thread.
    void make(const ImageGeometry& geometry, std::span<const RenderQuality> levels, const Needs& needs);
    // Loop.
    void set_quality(const RenderQuality& quality);

    // Returns the buffer size for pictures of single objects (object_impostor.h); empty if there are none.
    const std::optional<VisibilityBuffer::Capacity>& impostor_capacity() const { return impostor_capacity_; }
    // True when the quality uses a buffer for impostors and this object, at its present level, fits into it.
    bool takes_impostor_of(std::size_t object) const;
    bool has_buffer(const PixelSamples& samples) const { return buffer(samples) != nullptr; }
    // Returns the object as the placed frame shows it.
    VisibilityBuffer::Shown shown(std::size_t object) const;

    // Sorts the triangles of the placed frame into the buffer that it uses, and stores it in the frame. Loop.
    void place(FrameContext& frame);

  private:
    Objects objects_;
    std::unique_ptr<VisibilityBuffer> standard_, fine_;
    // Index: pixels between shaded places, minus 1.
    std::array<std::unique_ptr<VisibilityBuffer>, 2> ground_;
    std::vector<VisibilityBuffer::Shown> seen_;
    // For objects of which several are instances of one prototype: potentially visible sets from afar, by
    // level. Others have none.
    using LevelSets = std::vector<std::unique_ptr<const PotentiallyVisibleSets>>;
    std::vector<std::shared_ptr<const LevelSets>> potentially_visible_sets_;
    std::optional<VisibilityBuffer::Capacity> impostor_capacity_;
    bool uses_buffer_ = false, sees_ground_ = false;
    int ground_step_px_ = 1;

    void make_potentially_visible_sets();
    VisibilityBuffer::Capacity capacity(bool rows) const;
    std::optional<VisibilityBuffer::Capacity> capacity_for_impostors() const;
    VisibilityBuffer* buffer(const PixelSamples& samples) const {
        return (samples.quarters() == 1 ? standard_ : fine_).get();
    }
    // Returns the ground buffer of the quality in use; null: none.
    VisibilityBuffer* ground() const { return ground_[static_cast<std::size_t>(ground_step_px_ - 1)].get(); }
    bool ground_is_alone(const FrameContext& frame) const;
    const PotentiallyVisibleSet* potentially_visible_set(const FrameContext& frame, std::size_t object) const;
    void light_by_rays(FrameContext& frame);
};

}  // namespace hilcam
