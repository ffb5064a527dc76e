#include "render/frame/visibility_choice.h"

#include <algorithm>
#include <map>

#include "render/ground_shading/ground_light.h"

namespace hilcam {
namespace {

// Frames with more triangles are left to rays, whose cost hardly depends on the number.
constexpr std::size_t kMaxTriangles = 8'000'000;

// Limits on the number of objects with impostors and on the triangles of their levels. One takes 0.15 ms of
// processor time when twenty are a few pixels wide, and some milliseconds when it is 64 pixels wide.
constexpr std::size_t kMaxPictured = 32, kMaxInPicture = 1'000'000;

// Potentially visible sets are made for at least this many equal objects, and for levels of at most this many
// triangles. It takes some processor seconds at the start for 5000 triangles, and larger meshes are hardly
// seen so small.
constexpr std::size_t kManyLike = 16, kMaxInSets = 20'000;

}  // namespace

void VisibilityChoice::make(const ImageGeometry& geometry, std::span<const RenderQuality> levels,
                            const Needs& needs) {
    const auto [has_terrain, ground_triangles, has_rows] = needs;
    for (const RenderQuality& level : levels) {
        if (level.uses_buffer() && !has_terrain && VisibilityBuffer::takes(geometry)) {
            const PixelSamples samples = level.pixel_samples();
            std::unique_ptr<VisibilityBuffer>& made = samples.quarters() == 1 ? standard_ : fine_;
            if (!made)
                made = std::make_unique<VisibilityBuffer>(scaled(geometry, samples.buffer_px()),
                                                          capacity(has_rows));
            if (potentially_visible_sets_.empty()) make_potentially_visible_sets();
        }
        if (!level.sees_ground() || ground_triangles == 0) continue;
        const std::size_t most = std::min(kMaxTriangles, ground_triangles + ground_triangles / 4);
        auto& made = ground_[static_cast<std::size_t>(level.ground_step_px - 1)];
        if (!made)
            made = std::make_unique<VisibilityBuffer>(
                ground_geometry(geometry, static_cast<int>(level.ground_step_px)),
                VisibilityBuffer::Capacity{1, most, most});
    }
    seen_.reserve(objects_.all.size());
    const bool buffer =
        std::any_of(levels.begin(), levels.end(), [](const RenderQuality& q) { return q.uses_buffer(); });
    if (buffer && !has_terrain) impostor_capacity_ = capacity_for_impostors();
}

void VisibilityChoice::set_quality(const RenderQuality& quality) {
    uses_buffer_ = quality.uses_buffer(), sees_ground_ = quality.sees_ground();
    ground_step_px_ = static_cast<int>(quality.ground_step_px);
}

void VisibilityChoice::make_potentially_visible_sets() {
    std::map<const ObjectSurfaces*, std::vector<std::size_t>> makes;
    for (std::size_t i = 0; i < objects_.all.size(); ++i)
        makes[objects_.all[i].levels.front().get()].push_back(i);
    potentially_visible_sets_.resize(objects_.all.size());
    for (const auto& [make, objects] : makes) {
        if (objects.size() < kManyLike) continue;
        const std::size_t first = objects.front();
        LevelSets sets(objects_.all[first].levels.size());
        for (std::size_t level = 0; level < sets.size(); ++level)
            if (const MeshView mesh = objects_.scene.mesh(first, level); mesh.triangles.size() <= kMaxInSets)
                sets[level] = std::make_unique<PotentiallyVisibleSets>(
                    mesh, objects_.radii_m[first], objects_.all[first].levels[level]->coplanar_groups);
        const auto shared = std::make_shared<const LevelSets>(std::move(sets));
        for (const std::size_t i : objects) potentially_visible_sets_[i] = shared;
    }
}

// Null: the whole object is drawn.
const PotentiallyVisibleSet* VisibilityChoice::potentially_visible_set(const FrameContext& frame,
                                                                       std::size_t object) const {
    if (!potentially_visible_sets_[object]) return nullptr;
    const PotentiallyVisibleSets* const sets =
        (*potentially_visible_sets_[object])[objects_.levels[object]].get();
    const double sample_rad = 1 / (frame.geometry.focal_length_px * frame.samples.across());
    if (!sets || !sets->serves(objects_.plans[object].distance_m, sample_rad)) return nullptr;
    const Pose& pose = objects_.world.objects[object];
    return &sets->from(transposed(to_matrix(pose.world_from_body)) *
                       (objects_.world.camera.position_world_m - pose.position_world_m));
}

VisibilityBuffer::Capacity VisibilityChoice::capacity(bool rows) const {
    VisibilityBuffer::Capacity out{objects_.all.size(), 0, 0, rows};
    for (std::size_t i = 0; i < objects_.all.size(); ++i) {
        const MeshView mesh = objects_.scene.mesh(i, 0);
        out.vertices = std::min(kMaxTriangles, out.vertices + mesh.vertices_m.size());
        out.triangles = std::min(kMaxTriangles, out.triangles + mesh.triangles.size());
    }
    return out;
}

std::optional<VisibilityBuffer::Capacity> VisibilityChoice::capacity_for_impostors() const {
    if (objects_.all.empty() || objects_.all.size() > kMaxPictured) return {};
    VisibilityBuffer::Capacity out{1, 0, 0};
    for (std::size_t i = 0; i < objects_.all.size(); ++i)
        for (std::size_t level = 0; level < objects_.all[i].levels.size(); ++level) {
            const MeshView mesh = objects_.scene.mesh(i, level);
            if (std::max(mesh.triangles.size(), mesh.vertices_m.size()) > kMaxInPicture) continue;
            out.vertices = std::max(out.vertices, mesh.vertices_m.size());
            out.triangles = std::max(out.triangles, mesh.triangles.size());
        }
    return out.triangles > 0 ? std::optional(out) : std::nullopt;
}

bool VisibilityChoice::takes_impostor_of(std::size_t i) const {
    const MeshView mesh = objects_.scene.mesh(i, objects_.levels[i]);
    return uses_buffer_ && impostor_capacity_ && mesh.triangles.size() <= impostor_capacity_->triangles &&
           mesh.vertices_m.size() <= impostor_capacity_->vertices;
}

VisibilityBuffer::Shown VisibilityChoice::shown(std::size_t i) const {
    return {static_cast<std::uint32_t>(i),
            objects_.world.objects[i],
            objects_.radii_m[i],
            objects_.scene.mesh(i, objects_.levels[i]),
            objects_.surfaces[i]->cluster_bounds_m,
            objects_.surfaces[i]->coplanar_groups};
}

// True in space, if the ground's mesh is all that can be seen of it.
bool VisibilityChoice::ground_is_alone(const FrameContext& frame) const {
    return ground() && sees_ground_ && !frame.background->camera_in_air() && frame.start_before_m <= 0 &&
           objects_.plans.back().use == ObjectUse::kMesh && objects_.plans.back().samples_per_axis == 1 &&
           frame.rays->linear();
}

void VisibilityChoice::place(FrameContext& frame) {
    seen_.clear();
    if (ground_is_alone(frame)) {
        seen_.push_back({0, objects_.world.objects.back(), objects_.radii_m.back(), objects_.scene.mesh(0, 0),
                         objects_.surfaces.back()->cluster_bounds_m});
        if (ground()->place(objects_.world.camera, seen_))
            frame.ground = ground(), frame.ground_step_px = ground_step_px_;
        return;
    }
    VisibilityBuffer* const of_objects = buffer(frame.samples);
    const RowMotion* const rows = frame.rays->row_motion();
    if (!of_objects || !uses_buffer_ || !(frame.rays->is_still() || rows)) return;
    for (std::size_t i = 0; i < objects_.all.size(); ++i)
        if (objects_.plans[i].use == ObjectUse::kMesh) {
            seen_.push_back(shown(i));
            seen_.back().visible = potentially_visible_set(frame, i);
        }
    if (of_objects->place(objects_.world.camera, seen_, rows, frame.samples.buffer_px()))
        frame.visibility = of_objects;
    else
        light_by_rays(frame);
}

// Lets the camera's rays find all light.
void VisibilityChoice::light_by_rays(FrameContext& frame) {
    frame.has_impostors = false;
    for (std::size_t i = 0; i < objects_.all.size(); ++i)
        if (frame.has_impostor[i]) frame.has_impostor[i] = 0, objects_.plans[i].picture_px = 0;
}

}  // namespace hilcam
