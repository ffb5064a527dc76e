#include "render/frame/frame_setup.h"

#include <algorithm>
#include <cmath>

#include "render/ground_shading/ground_light.h"
#include "render/shading/point_field.h"
#include "render/visibility/screen_bounds.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

bool any_material(const std::vector<ShownObject>& objects, const auto& says) {
    return std::any_of(objects.begin(), objects.end(), [&](const ShownObject& object) {
        return std::any_of(object.materials().begin(), object.materials().end(), says);
    });
}

RayDensity density_of(const RenderQuality& quality) {
    return {static_cast<int>(quality.samples_per_axis), static_cast<int>(quality.rays_across),
            static_cast<int>(quality.point_samples),
            static_cast<int>(std::min(quality.point_samples, quality.min_point_samples))};
}

}  // namespace

FrameSetup::FrameSetup(Scene scene, const SpectralGrid& grid, const ImageGeometry& geometry,
                       std::span<const RenderQuality> levels, const RenderModels& models,
                       const Modules& modules)
    : embree_(ordered_meshes(with_terrain_object(scene)), levels.front().watertight),
      objects_(shown_objects(scene)),
      possible_(objects_.size()),
      world_(possible_.world()),
      lamps_(std::move(scene.lamps)),
      stars_(std::move(scene.stars), scene.stars_time),
      bodies_(std::move(scene.bodies)),
      air_(std::move(scene.air)),
      earth_(std::move(scene.earth)),
      bands_(grid),
      background_(bodies_, air_.get(), earth_.get(), scene.sun_irradiance_1au_w_m2_um, scene.limb_darkening,
                  grid),
      object_mask_(geometry),
      full_mask_(geometry),
      rays_(modules.rays.make(models.rays.model, models.rays)),
      radiance_model_(modules.radiance.make(models.radiance)),
      lod_error_px_(levels.front().lod_error_px),
      density_(density_of(levels.front())),
      earth_view_(earth_.get(), scene.sun_irradiance_1au_w_m2_um, geometry, background_.top_m(BodyId::kEarth),
                  levels.front().earth_impostor),
      visibility_({embree_, objects_, levels_, shown_, radii_m_, plans_, world_}) {
    const RenderQuality& quality = levels.front();
    if (scene.terrain)
        terrain_ = std::make_unique<ShownTerrain>(embree_, std::move(scene.terrain), objects_.size() - 1);
    levels_.resize(objects_.size());
    plans_.resize(objects_.size());
    object_boxes_.resize(objects_.size());
    for (const ShownObject& object : objects_) {
        triangles_ += object.levels.front()->triangles.size();
        radii_m_.push_back(object.radius_m());
        shown_.push_back(object.levels.front().get());
    }
    full_mask_.fill();
    const bool emission = radiance_model_->emits() &&
                          any_material(objects_, [](const Material& m) { return !m.emission.none(); });
    indirect_settings_ = {static_cast<float>(quality.source_step_rad), lamps_.all().size(), emission};
    if (!scene.light_later) indirect_ = make_indirect_cache();
    // Rows of different instants sweep over more than a field, and draw a star several times if they are slow
    // over it. Twice the field includes the aberration of a moving camera, a few thousandths at most.
    max_stars_ = rays_->is_still()
                     ? std::min(stars_.size(),
                                stars_.max_within(2 * half_field_rad(geometry) + background_.max_turn_rad()))
                     : stars_.size();
    visibility_.make(geometry, levels,
                     {terrain_ != nullptr, plain_ground_triangles(geometry), rays_->row_motion() != nullptr});
    frame_.scene = &embree_;
    frame_.objects = &shown_;
    frame_.world_from_body.resize(objects_.size());
    frame_.is_point.resize(objects_.size());
    frame_.is_cached.resize(objects_.size());
    frame_.has_impostor.resize(objects_.size());
    frame_.background = &background_;
    frame_.radiance = radiance_model_.get();
    frame_.lamps = &lamps_;
    frame_.bands = &bands_;
    frame_.rays = rays_.get();
    frame_.geometry = geometry;
    frame_.bins = grid.size();
    frame_.alpha_behind_diffuse = static_cast<float>(quality.facets_behind_diffuse);
    frame_.has_glass = any_material(objects_, [](const Material& m) { return m.transmits(); });
    frame_.has_emission = emission;
}

// Returns the number of triangles of terrain that is the only thing in the scene and suits the ground buffer;
// otherwise 0.
std::size_t FrameSetup::plain_ground_triangles(const ImageGeometry& geometry) const {
    const bool is_all = terrain_ && objects_.size() == 1 && lamps_.all().empty() &&
                        geometry.distortion.none() && rays_->is_still();
    const bool is_plain =
        is_all && radiance_model_->reflects_plainly() && is_plain_ground(objects_.back().materials().front());
    return is_plain ? terrain_->max_triangles() : 0;
}

std::unique_ptr<IndirectCache> FrameSetup::make_indirect_cache() const {
    return std::make_unique<IndirectCache>(objects_, embree_, bands_, indirect_settings_);
}

void FrameSetup::use_indirect_cache() {
    frame_.indirect = uses_indirect_cache_ ? indirect_.get() : nullptr;
    for (std::size_t i = 0; i < objects_.size(); ++i)
        frame_.is_cached[i] = frame_.indirect && frame_.indirect->keeps(i);
}

void FrameSetup::set_paths(const PathModel& paths) {
    frame_.paths_sample_lobes = paths.samples_lobes();
    uses_indirect_cache_ = paths.uses_indirect_cache();
    use_indirect_cache();
    frame_.ground = nullptr;  // a path model that is being tried has to be used
}

// Touches nothing that the loop reads of the objects in the meantime.
void FrameSetup::give_tables(std::span<const std::shared_ptr<const TransferTable>> tables) {
    for (std::size_t i = 0; i < tables.size(); ++i)
        if (tables[i]) objects_[i].transfer = tables[i];
    handover_.give(make_indirect_cache());
}

bool FrameSetup::take_light() {
    if (!indirect_ && any_placed_) indirect_ = handover_.take(frame_, world_);
    use_indirect_cache();
    return indirect_ || !uses_indirect_cache_;
}

void FrameSetup::set_quality(const RenderQuality& quality, const PathModel& paths) {
    lod_error_px_ = quality.lod_error_px;
    density_.samples_per_axis = static_cast<int>(quality.samples_per_axis);
    frame_.max_depth = static_cast<int>(quality.max_depth);
    frame_.contribution_threshold = static_cast<float>(quality.contribution_threshold);
    frame_.sun_is_disk = quality.sun_disk;
    visibility_.set_quality(quality);
    frame_.samples = quality.pixel_samples();
    set_paths(paths);
}

// Chooses the coarsest level with an error below the quality's share of a pixel where the object is nearest.
void FrameSetup::choose_levels() {
    for (std::size_t i = 0; i < objects_.size(); ++i) {
        const ShownObject& object = objects_[i];
        const auto level_from = [&](double distance_m) {
            const double error_m =
                lod_error_px_ * std::max(0.0, distance_m) / frame_.geometry.focal_length_px;
            std::size_t level = 0;
            while (level + 1 < object.levels.size() && object.error_m[level + 1] <= error_m) ++level;
            return level;
        };
        const Vec3d to_camera_m = world_.camera.position_world_m - world_.objects[i].position_world_m;
        levels_[i] = level_from(length(to_camera_m) - radii_m_[i]);
        // A satellite's wings make its sphere large where there is nothing.
        if (levels_[i] + 1 < object.levels.size())
            levels_[i] = level_from(
                object.distance_m(transposed(to_matrix(world_.objects[i].world_from_body)) * to_camera_m));
        shown_[i] = object.levels[levels_[i]].get();
    }
}

// The box of the object's bounding sphere.
PixelBox FrameSetup::box_of(std::size_t i) const {
    const Vec3d to_object_m = world_.objects[i].position_world_m - world_.camera.position_world_m;
    const double sine = std::min(1.0, radii_m_[i] / plans_[i].distance_m);
    return screen_bounds_of_cone(frame_.geometry, world_.camera, to_object_m / plans_[i].distance_m,
                                 std::sqrt(1 - sine * sine));
}

void FrameSetup::place(const WorldSnapshot& world, RandomKey key) {
    place_shapes(world, key);
    earth_view_.place(world_, background_, frame_);
    if (frame_.indirect) indirect_->place(frame_, world_);
}

void FrameSetup::place_shapes(const WorldSnapshot& world, RandomKey key) {
    HILCAM_CHECK(world.objects.size() + (terrain_ ? 1 : 0) == objects_.size());
    possible_.take(world);
    if (terrain_) {
        world_.objects.push_back(terrain_->update(world_, frame_.geometry.focal_length_px,
                                                  half_field_rad(frame_.geometry), objects_.back()));
        radii_m_.back() = objects_.back().radius_m();
    }
    const RaySpace space = choose_ray_space(world_, radii_m_, rays_->is_still());
    const double pixel_rad = 1 / frame_.geometry.focal_length_px;
    background_.place(world_, space.origin_world_m, pixel_rad, terrain_ ? terrain_->body() : std::nullopt);
    lamps_.place(world_, space.origin_world_m);
    frame_.key = key;
    frame_.rays_world_m = space.origin_world_m;
    frame_.camera_m = world_.camera.position_world_m - space.origin_world_m;
    frame_.start_before_m = space.start_before_m;
    choose_levels();
    possible_.hide_from_rays();
    embree_.place(world_.objects, levels_, space.origin_world_m);
    possible_.put_away();
    rays_->place(frame_.geometry,
                 {world_.time, world_.camera, world_.rows_velocity_m_s, world_.camera_rate_rad_s});
    place_objects();
    place_background();
    frame_.visibility = frame_.ground = nullptr;
    any_placed_ = true;
}

// The camera has to find the light of an object itself if a body may be in front of it, if it is seen through
// air, or if something is seen through it.
RayDensity FrameSetup::density_for(std::size_t i) const {
    RayDensity out = density_;
    out.pictures_of_points = visibility_.takes_impostor_of(i);
    out.pictures_of_meshes = out.pictures_of_points && density_.rays_across > 0 &&
                             visibility_.has_buffer(frame_.samples) && rays_->is_still() &&
                             !frame_.has_glass && !frame_.bodies_may_hide && !background_.camera_in_air();
    return out;
}

// Rows with their own poses may meet objects anywhere, so there is no mask.
void FrameSetup::place_objects() {
    const bool still = rays_->is_still();
    object_mask_.clear();
    double farthest_m = 0;
    for (std::size_t i = 0; i < objects_.size(); ++i)
        farthest_m =
            std::max(farthest_m, length(world_.objects[i].position_world_m - world_.camera.position_world_m) +
                                     radii_m_[i]);
    frame_.bodies_may_hide = farthest_m > background_.nearest_m();
    frame_.has_impostors = false;
    for (std::size_t i = 0; i < objects_.size(); ++i) {
        const Mat3d m = to_matrix(world_.objects[i].world_from_body);
        frame_.world_from_body[i] = {to_float(m.x), to_float(m.y), to_float(m.z)};
        plans_[i] = plan_object(frame_.geometry, world_, world_.objects[i], radii_m_[i], density_for(i));
        plans_[i].level = levels_[i];
        if (possible_.is_left_out(i)) plans_[i].use = ObjectUse::kHidden;
        frame_.is_point[i] = plans_[i].use == ObjectUse::kPoints;
        if (!possible_.is_left_out(i) && !frame_.is_point[i] && still &&
            !object_mask_.add(world_.camera, world_.objects[i], shown_[i]->cluster_bounds_m))
            plans_[i].use = ObjectUse::kHidden;
        if (!frame_.is_point[i] && plans_[i].samples_per_axis > density_.samples_per_axis)
            object_boxes_[i] = box_of(i);
        frame_.has_impostor[i] = plans_[i].use == ObjectUse::kMesh && plans_[i].picture_px > 0;
        frame_.has_impostors = frame_.has_impostors || frame_.has_impostor[i];
    }
    frame_.object_mask = still ? &object_mask_ : &full_mask_;
}

// Rows see directions that differ by up to the camera's sweep.
void FrameSetup::place_background() {
    const PixelBox everything{0, 0, frame_.geometry.padded_width(), frame_.geometry.padded_height()};
    const bool bounded = rays_->is_still() || rays_->row_motion();
    const double sweep_rad = rays_->sweep_rad();
    const auto bounds = [&](Vec3d dir, double cosine) {
        if (!bounded) return everything;
        if (!(sweep_rad > 0)) return screen_bounds_of_cone(frame_.geometry, world_.camera, dir, cosine);
        const double wider_rad = std::acos(cosine) + sweep_rad;
        if (wider_rad > 0.5 * kPi) return everything;
        return screen_bounds_of_cone(frame_.geometry, world_.camera, dir, std::cos(wider_rad));
    };
    frame_.body_box_count = background_.disks().size();
    for (std::size_t i = 0; i < frame_.body_box_count; ++i) {
        const PlacedBody& body = background_.disks()[i];
        frame_.body_boxes[i] = bounds(body.world_dir, body.cone_cosine);
    }
    frame_.sun_box = bounds(background_.sun_camera_dir(), background_.sun_seen_cosine());
    frame_.earth_impostor = nullptr;
}

VisibilityBuffer::Shown FrameSetup::shown(std::size_t object) const { return visibility_.shown(object); }

void FrameSetup::place_visibility() { visibility_.place(frame_); }

MovingFrame FrameSetup::moving() const {
    return {frame_,
            plans_,
            radii_m_,
            terrain_ ? terrain_->body() : std::optional<BodyId>(),
            terrain_ != nullptr,
            !stars_.empty() || !background_.points().empty()};
}

bool FrameSetup::shows_body() const {
    const PixelBox everything{0, 0, frame_.geometry.padded_width(), frame_.geometry.padded_height()};
    return (terrain_ && terrain_->body()) || frame_.may_see_body(everything);
}

int FrameSetup::samples_in(const PixelBox& box) const {
    int n = density_.samples_per_axis;
    for (std::size_t i = 0; i < objects_.size(); ++i)
        if (plans_[i].use == ObjectUse::kMesh && plans_[i].samples_per_axis > n &&
            box.overlaps(object_boxes_[i]))
            n = plans_[i].samples_per_axis;
    return n;
}

std::vector<std::string> FrameSetup::explain(const RenderQuality& quality) const {
    std::vector<std::size_t> triangles;
    std::vector<std::string> names;
    for (const ShownObject& object : objects_) names.push_back(object.name);
    for (const ObjectSurfaces* surfaces : shown_) triangles.push_back(surfaces->triangles.size());
    std::vector<std::string> out =
        hilcam::explain({frame_, plans_, names, triangles, quality, stars_.size()}, world_);
    if (background_.shows_detail()) out.push_back(earth_view_.detail()->explain());
    return out;
}

}  // namespace hilcam
