#pragma once
// The visibility buffers of a camera's frames, and which of them a frame uses: of objects with 4 x 4 or 8 x 8 samples a pixel, of ground
// that alone is seen, or none, where rays find what the camera sees.

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
    // The objects as the frame's set-up has them; all outlives this.
    struct Objects {
        const EmbreeScene& scene;
        const std::vector<ShownObject>& all;
        const std::vector<std::size_t>& levels;              // level of detail at which each is shown
        const std::vector<const ObjectSurfaces*>& surfaces;  // at that level
        const std::vector<double>& radii_m;
        std::vector<ObjectPlan>& plans;
        const WorldSnapshot& world;
    };
    explicit VisibilityChoice(const Objects& objects) : objects_(objects) {}

    struct Needs {
        bool has_terrain;  // then objects have no buffer
        // Triangles of terrain that is all there is, and plain (is_plain_ground()), at most; 0: there is none.
        std::size_t ground_triangles;
        bool has_rows;  // rows are of several instants (RayGenerator::row_motion())
    };
    // Makes what frames of these qualities need. Owner thread.
    void make(const ImageGeometry& geometry, std::span<const RenderQuality> levels, const Needs& needs);
    // Loop.
    void set_quality(const RenderQuality& quality);

    // Returns what pictures of single objects need (object_impostor.h); empty: there are none.
    const std::optional<VisibilityBuffer::Capacity>& impostor_capacity() const { return impostor_capacity_; }
    // True when an object may have a picture of its own where it is drawn as points; when objects that are not may have one, too.
    bool takes_impostor_of(std::size_t object) const;
    bool has_buffer(const PixelSamples& samples) const { return buffer(samples) != nullptr; }
    // Returns the object as the placed frame shows it.
    VisibilityBuffer::Shown shown(std::size_t object) const;

    // Sorts the triangles of the placed frame into the buffer that it uses, and lets the frame know. Loop.
    void place(FrameContext& frame);

  private:
    Objects objects_;
    std::unique_ptr<VisibilityBuffer> standard_, fine_;
    // By the pixels between their places, from 1.
    std::array<std::unique_ptr<VisibilityBuffer>, 2> ground_;
    std::vector<VisibilityBuffer::Shown> seen_;
    // Sets of what may be seen from afar of those objects that are instances of one prototype, by its levels; none: of all
    // others.
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
    // The buffer of ground of the quality in use; null: none.
    VisibilityBuffer* ground() const { return ground_[static_cast<std::size_t>(ground_step_px_ - 1)].get(); }
    bool ground_is_alone(const FrameContext& frame) const;
    const PotentiallyVisibleSet* potentially_visible_set(const FrameContext& frame, std::size_t object) const;
    void light_by_rays(FrameContext& frame);
};

}  // namespace hilcam
