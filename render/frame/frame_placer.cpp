#include "render/frame/frame_placer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "render/ground_shading/ground_light.h"
#include "render/shading/point_field.h"
#include "render/sky/body_bounds.h"
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
            static_cast<int>(std::min(quality.point_samples, quality.point_samples_least))};
}

// Frames that show more triangles than this are left to rays, which hardly cost more for more.
constexpr std::size_t kMostTriangles = 8'000'000;

// So many objects may have pictures of their own, by levels of so many triangles: one takes 0.15 ms of the processor where twenty
// are a few pixels wide, and some milliseconds where it is 64.
constexpr std::size_t kMostPictured = 32, kMostInPicture = 1'000'000;

// Visible sets are made of objects of which there are so many, and of levels of so few triangles: it takes some
// seconds of the processor at the start for 5000 of them, and a mesh of more is hardly seen so small.
constexpr std::size_t kManyLike = 16, kMostInSets = 20'000;

// The place of an object that is left out: nowhere for rays, and far behind the camera for all that reckons with places.
constexpr Vec3d kNowhere_m{std::numeric_limits<double>::quiet_NaN(), 0, 0};
Vec3d away_m(const Pose& camera) {
    return camera.position_world_m - kFarthestPlace_m * (to_matrix(camera.world_from_body) * Vec3d{0, 0, 1});
}
void move_left_out(std::span<const std::uint8_t> left_out, Vec3d place_m, std::span<Pose> objects) {
    for (std::size_t i = 0; i < objects.size(); ++i)
        if (left_out[i] != 0) objects[i].position_world_m = place_m;
}

}  // namespace

FramePlacer::FramePlacer(Scene scene, const SpectralGrid& grid, const ImageGeometry& geometry,
                         std::span<const RenderQuality> levels, const RenderModels& models,
                         const Modules& modules)
    : embree_(ordered_meshes(with_terrain_object(scene)), levels.front().watertight),
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
      density_(density_of(levels.front())) {
    const RenderQuality& quality = levels.front();
    objects_ = shown_objects(scene);
    if (scene.terrain)
        terrain_ = std::make_unique<ShownTerrain>(embree_, std::move(scene.terrain), objects_.size() - 1);
    world_.objects.reserve(objects_.size());
    levels_.resize(objects_.size());
    plans_.resize(objects_.size());
    object_boxes_.resize(objects_.size());
    is_left_out_.resize(objects_.size());
    for (const ShownObject& object : objects_) {
        triangles_ += object.levels.front()->triangles.size();
        radii_m_.push_back(object.radius_m());
        shown_.push_back(object.levels.front().get());
    }
    full_mask_.fill();
    const bool emission = radiance_model_->emits() &&
                          any_material(objects_, [](const Material& m) { return largest(m.emission) > 0; });
    kept_settings_ = {static_cast<float>(quality.kept_step_rad), lamps_.all().size(), emission};
    if (!scene.light_later) kept_ = make_kept();
    if (earth_ && quality.kept_earth)
        kept_earth_ =
            std::make_unique<KeptEarth>(*earth_, scene.sun_irradiance_1au_w_m2_um,
                                        1 / geometry.focal_length_px, background_.top_m(BodyId::kEarth));
    if (earth_ && earth_->detail())
        earth_detail_ = std::make_unique<DetailStream>(earth_->detail(), earth_->ground().first(),
                                                       earth_->detail_bytes());
    // Rows of different instants sweep over more than a field, and draw a star several times that they are
    // slow over. Twice the field has room for its shift by a camera in motion, a few thousandths at most.
    max_stars_ = rays_->is_still() ? std::min(stars_.size(), stars_.max_within(2 * half_field_rad(geometry)))
                                   : stars_.size();

    for (const RenderQuality& level : levels) {
        make_visibility(geometry, level);
        if (level.sees_ground()) make_ground_visibility(geometry, level);
    }
    picture_room_ = room_for_pictures(levels);
    frame_.scene = &embree_;
    frame_.objects = &shown_;
    frame_.world_from_body.resize(objects_.size());
    frame_.is_point.resize(objects_.size());
    frame_.keeps_light.resize(objects_.size());
    frame_.lit_apart.resize(objects_.size());
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

void FramePlacer::make_visibility(const ImageGeometry& geometry, const RenderQuality& level) {
    if (!level.uses_buffer() || terrain_ || !VisibilityBuffer::takes(geometry)) return;
    const PixelSamples samples = level.pixel_samples();
    std::unique_ptr<VisibilityBuffer>& buffer = samples.quarters() == 1 ? visibility_ : fine_visibility_;
    if (buffer) return;
    seen_.reserve(objects_.size());
    buffer = std::make_unique<VisibilityBuffer>(scaled(geometry, samples.buffer_px()), visibility_room());
    if (visible_sets_.empty()) make_visible_sets();
}

void FramePlacer::make_visible_sets() {
    std::map<const ObjectSurfaces*, std::vector<std::size_t>> makes;
    for (std::size_t i = 0; i < objects_.size(); ++i) makes[objects_[i].levels.front().get()].push_back(i);
    visible_sets_.resize(objects_.size());
    for (const auto& [make, objects] : makes) {
        if (objects.size() < kManyLike) continue;
        const std::size_t first = objects.front();
        LevelSets sets(objects_[first].levels.size());
        for (std::size_t level = 0; level < sets.size(); ++level)
            if (const MeshView mesh = embree_.mesh(first, level); mesh.triangles.size() <= kMostInSets)
                sets[level] = std::make_unique<VisibleSets>(mesh, radii_m_[first],
                                                            objects_[first].levels[level]->patches);
        const auto shared = std::make_shared<const LevelSets>(std::move(sets));
        for (const std::size_t i : objects) visible_sets_[i] = shared;
    }
}

// Null: all of an object is looked at.
const VisibleSet* FramePlacer::visible_set(std::size_t object) const {
    if (!visible_sets_[object]) return nullptr;
    const VisibleSets* const sets = (*visible_sets_[object])[levels_[object]].get();
    const double sample_rad = 1 / (frame_.geometry.focal_length_px * frame_.samples.across());
    if (!sets || !sets->serves(plans_[object].distance_m, sample_rad)) return nullptr;
    const Pose& pose = world_.objects[object];
    return &sets->from(transposed(to_matrix(pose.world_from_body)) *
                       (world_.camera.position_world_m - pose.position_world_m));
}

void FramePlacer::make_ground_visibility(const ImageGeometry& geometry, const RenderQuality& level) {
    const bool plain = radiance_model_->reflects_plainly() && lamps_.all().empty() &&
                       is_plain_ground(objects_.back().materials().front());
    auto& buffer = ground_visibility_[static_cast<std::size_t>(level.ground_step_px - 1)];
    if (buffer || !terrain_ || objects_.size() > 1 || !plain || !geometry.distortion.none() ||
        !rays_->is_still())
        return;
    seen_.reserve(1);
    const std::size_t most =
        std::min(kMostTriangles, terrain_->most_triangles() + terrain_->most_triangles() / 4);
    buffer =
        std::make_unique<VisibilityBuffer>(ground_geometry(geometry, static_cast<int>(level.ground_step_px)),
                                           VisibilityBuffer::Room{1, most, most});
}

VisibilityBuffer::Room FramePlacer::visibility_room() const {
    VisibilityBuffer::Room room{objects_.size(), 0, 0};
    for (std::size_t i = 0; i < objects_.size(); ++i) {
        const MeshView mesh = embree_.mesh(i, 0);
        room.vertices = std::min(kMostTriangles, room.vertices + mesh.vertices_m.size());
        room.triangles = std::min(kMostTriangles, room.triangles + mesh.triangles.size());
    }
    return room;
}

std::optional<VisibilityBuffer::Room> FramePlacer::room_for_pictures(
    std::span<const RenderQuality> levels) const {
    const bool buffer =
        std::any_of(levels.begin(), levels.end(), [](const RenderQuality& q) { return q.uses_buffer(); });
    if (!buffer || terrain_ || objects_.empty() || objects_.size() > kMostPictured) return {};
    VisibilityBuffer::Room room{1, 0, 0};
    for (std::size_t i = 0; i < objects_.size(); ++i)
        for (std::size_t level = 0; level < objects_[i].levels.size(); ++level) {
            const MeshView mesh = embree_.mesh(i, level);
            if (std::max(mesh.triangles.size(), mesh.vertices_m.size()) > kMostInPicture) continue;
            room.vertices = std::max(room.vertices, mesh.vertices_m.size());
            room.triangles = std::max(room.triangles, mesh.triangles.size());
        }
    return room.triangles > 0 ? std::optional(room) : std::nullopt;
}

std::unique_ptr<KeptScene> FramePlacer::make_kept() const {
    return std::make_unique<KeptScene>(objects_, embree_, bands_, kept_settings_);
}

void FramePlacer::use_kept_light() {
    frame_.kept = uses_kept_light_ ? kept_.get() : nullptr;
    for (std::size_t i = 0; i < objects_.size(); ++i)
        frame_.keeps_light[i] = frame_.kept && frame_.kept->keeps(i);
}

void FramePlacer::set_paths(const PathModel& paths) {
    frame_.paths_sample_lobes = paths.samples_lobes();
    uses_kept_light_ = paths.uses_kept_light();
    use_kept_light();
    frame_.ground = nullptr;  // whoever tries a path model wants to see it at work
}

// Nothing is touched that the loop reads of the objects meanwhile.
void FramePlacer::give_tables(std::span<const std::shared_ptr<const TransferTable>> tables) {
    for (std::size_t i = 0; i < tables.size(); ++i)
        if (tables[i]) objects_[i].transfer = tables[i];
    handover_.give(make_kept());
}

bool FramePlacer::take_light() {
    if (!kept_ && any_placed_) kept_ = handover_.take(frame_, world_);
    use_kept_light();
    return kept_ || !uses_kept_light_;
}

void FramePlacer::set_quality(const RenderQuality& quality, const PathModel& paths) {
    lod_error_px_ = quality.lod_error_px;
    density_.samples_per_axis = static_cast<int>(quality.samples_per_axis);
    frame_.max_depth = static_cast<int>(quality.max_depth);
    frame_.contribution_threshold = static_cast<float>(quality.contribution_threshold);
    frame_.sun_is_disk = quality.sun_disk;
    uses_visibility_ = quality.uses_buffer(), sees_ground_ = quality.sees_ground();
    ground_step_px_ = static_cast<int>(quality.ground_step_px);
    frame_.samples = quality.pixel_samples();
    set_paths(paths);
}

// The coarsest level whose error stays below the quality's share of a pixel where the object is nearest.
void FramePlacer::choose_levels() {
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

// The box is that of the sphere that holds the object.
PixelBox FramePlacer::box_of(std::size_t i) const {
    const Vec3d to_object_m = world_.objects[i].position_world_m - world_.camera.position_world_m;
    const double sine = std::min(1.0, radii_m_[i] / plans_[i].distance_m);
    return screen_bounds_of_cone(frame_.geometry, world_.camera, to_object_m / plans_[i].distance_m,
                                 std::sqrt(1 - sine * sine));
}

void FramePlacer::place(const WorldSnapshot& world, RandomKey key) {
    place_shapes(world, key);
    place_earth_picture();
    place_earth_detail();
    if (frame_.kept) kept_->place(frame_, world_);
}

// The last guard before the acceleration structure, which ends the program at a place that is no number. The emulator lets
// none through (WorldState); frames are asked for by others, too.
void FramePlacer::take_world(const WorldSnapshot& world) {
    const Pose camera = world_.camera;
    Bodies bodies = world_.bodies;
    left_out_ = take_possible(world.bodies, bodies) ? 0 : 1;
    world_ = world;
    world_.bodies = bodies;
    if (!is_possible(world.camera)) world_.camera = camera, ++left_out_;
    for (Vec3d* rate : {&world_.camera_velocity_m_s, &world_.rows_velocity_m_s, &world_.camera_rate_rad_s})
        if (!is_finite(*rate)) *rate = {}, ++left_out_;
    for (std::size_t i = 0; i < world_.objects.size(); ++i) {
        is_left_out_[i] = !is_possible(world.objects[i]);
        if (is_left_out_[i]) world_.objects[i] = {away_m(world_.camera), {}}, ++left_out_;
    }
}

void FramePlacer::place_shapes(const WorldSnapshot& world, RandomKey key) {
    HILCAM_CHECK(world.objects.size() + (terrain_ ? 1 : 0) == objects_.size());
    take_world(world);
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
    if (left_out_ > 0) move_left_out(is_left_out_, kNowhere_m, world_.objects);
    embree_.place(world_.objects, levels_, space.origin_world_m);
    if (left_out_ > 0) move_left_out(is_left_out_, away_m(world_.camera), world_.objects);
    rays_->place(frame_.geometry,
                 {world_.time, world_.camera, world_.rows_velocity_m_s, world_.camera_rate_rad_s});
    place_objects();
    place_background();
    frame_.visibility = frame_.ground = nullptr;
    any_placed_ = true;
}

// Where a body may stand before the object, something is seen through it, or it is seen through air, the camera has to find its light.
RayDensity FramePlacer::density_for(std::size_t i) const {
    RayDensity out = density_;
    const MeshView mesh = embree_.mesh(i, levels_[i]);
    out.pictures_of_points = uses_visibility_ && picture_room_ &&
                             mesh.triangles.size() <= picture_room_->triangles &&
                             mesh.vertices_m.size() <= picture_room_->vertices;
    out.pictures_of_meshes = out.pictures_of_points && density_.rays_across > 0 && visibility() &&
                             rays_->is_still() && !frame_.has_glass && !frame_.bodies_may_hide &&
                             !background_.camera_in_air();
    return out;
}

// Rows with poses of their own meet objects anywhere: no mask, no boxes; here and below.
void FramePlacer::place_objects() {
    const bool still = rays_->is_still();
    object_mask_.clear();
    double farthest_m = 0;
    for (std::size_t i = 0; i < objects_.size(); ++i)
        farthest_m =
            std::max(farthest_m, length(world_.objects[i].position_world_m - world_.camera.position_world_m) +
                                     radii_m_[i]);
    frame_.bodies_may_hide = farthest_m > background_.nearest_m();
    frame_.has_lit_apart = false;
    for (std::size_t i = 0; i < objects_.size(); ++i) {
        const Mat3d m = to_matrix(world_.objects[i].world_from_body);
        frame_.world_from_body[i] = {to_float(m.x), to_float(m.y), to_float(m.z)};
        plans_[i] = plan_object(frame_.geometry, world_, world_.objects[i], radii_m_[i], density_for(i));
        plans_[i].level = levels_[i];
        if (is_left_out_[i]) plans_[i].use = ObjectUse::kHidden;
        frame_.is_point[i] = plans_[i].use == ObjectUse::kPoints;
        if (!is_left_out_[i] && !frame_.is_point[i] && still &&
            !object_mask_.add(world_.camera, world_.objects[i], shown_[i]->cluster_bounds_m))
            plans_[i].use = ObjectUse::kHidden;
        if (!frame_.is_point[i] && plans_[i].samples_per_axis > density_.samples_per_axis)
            object_boxes_[i] = box_of(i);
        frame_.lit_apart[i] = plans_[i].use == ObjectUse::kMesh && plans_[i].picture_px > 0;
        frame_.has_lit_apart = frame_.has_lit_apart || frame_.lit_apart[i];
    }
    frame_.object_mask = still ? &object_mask_ : &full_mask_;
}

void FramePlacer::place_background() {
    const PixelBox everything{0, 0, frame_.geometry.padded_width(), frame_.geometry.padded_height()};
    const auto bounds = [&](Vec3d dir, double cosine) {
        return rays_->is_still() ? screen_bounds_of_cone(frame_.geometry, world_.camera, dir, cosine)
                                 : everything;
    };
    frame_.body_box_count = background_.disks().size();
    for (std::size_t i = 0; i < frame_.body_box_count; ++i) {
        const PlacedBody& body = background_.disks()[i];
        frame_.body_boxes[i] = bounds(body.world_dir, body.cone_cosine);
    }
    frame_.sun_box = bounds(background_.sun_camera_dir(), background_.sun_disk_cosine());
    frame_.earth_picture = nullptr;
}

void FramePlacer::place_earth_picture() {
    if (!kept_earth_ || !rays_->is_still() || !background_.earth_in_patches()) return;
    const PlacedBody& earth = background_.disks().front();
    if (kept_earth_->place(earth.camera_m, earth.sun_dir, background_.map_numbers()))
        frame_.earth_picture = &kept_earth_->picture();
    const double au = kAstronomicalUnit_m * earth.sun_radius_rad / kSunRadius_m;
    frame_.earth_picture_factor = static_cast<float>(au * au);
}

// In space, and where its mesh is all there is to see of it.
bool FramePlacer::ground_is_alone() const {
    return ground_visibility() && sees_ground_ && !background_.camera_in_air() &&
           frame_.start_before_m <= 0 && plans_.back().use == ObjectUse::kMesh &&
           plans_.back().samples_per_axis == 1 && frame_.rays->linear();
}

// A kept picture is of the map that memory holds, which is finer than its pixels.
void FramePlacer::place_earth_detail() {
    if (!earth_detail_ || frame_.earth_picture) return;
    const auto disks = background_.disks();
    const auto earth =
        std::find_if(disks.begin(), disks.end(), [](const PlacedBody& b) { return b.id == BodyId::kEarth; });
    if (earth == disks.end()) return;
    const Vec3d boresight =
        earth->fixed_from_world * (to_matrix(world_.camera.world_from_body) * Vec3d{0, 0, 1});
    background_.show_detail(earth_detail_->place({earth->camera_m, boresight, earth->sun_dir,
                                                  half_field_rad(frame_.geometry) + rays_->sweep_rad(),
                                                  1 / frame_.geometry.focal_length_px}));
}

VisibilityBuffer::Shown FramePlacer::shown(std::size_t i) const {
    return {static_cast<std::uint32_t>(i), world_.objects[i],           radii_m_[i],
            embree_.mesh(i, levels_[i]),   shown_[i]->cluster_bounds_m, shown_[i]->patches};
}

void FramePlacer::place_visibility() {
    if (ground_is_alone()) {
        seen_.clear();
        seen_.push_back(
            {0, world_.objects.back(), radii_m_.back(), embree_.mesh(0, 0), shown_.back()->cluster_bounds_m});
        if (ground_visibility()->place(world_.camera, seen_))
            frame_.ground = ground_visibility(), frame_.ground_step_px = ground_step_px_;
        return;
    }
    VisibilityBuffer* const buffer = visibility();
    if (!buffer || !uses_visibility_ || !rays_->is_still()) return;
    seen_.clear();
    for (std::size_t i = 0; i < objects_.size(); ++i)
        if (plans_[i].use == ObjectUse::kMesh) {
            seen_.push_back(shown(i));
            seen_.back().visible = visible_set(i);
        }
    if (buffer->place(world_.camera, seen_))
        frame_.visibility = buffer;
    else
        light_by_rays();
}

// The camera's rays find the light of all that they meet.
void FramePlacer::light_by_rays() {
    frame_.has_lit_apart = false;
    for (std::size_t i = 0; i < objects_.size(); ++i)
        if (frame_.lit_apart[i]) frame_.lit_apart[i] = 0, plans_[i].picture_px = 0;
}

MovingFrame FramePlacer::moving() const {
    return {frame_,
            plans_,
            radii_m_,
            terrain_ ? terrain_->body() : std::optional<BodyId>(),
            terrain_ != nullptr,
            !stars_.empty() || !background_.points().empty()};
}

bool FramePlacer::shows_body() const {
    const PixelBox everything{0, 0, frame_.geometry.padded_width(), frame_.geometry.padded_height()};
    return (terrain_ && terrain_->body()) || frame_.may_see_body(everything);
}

int FramePlacer::samples_in(const PixelBox& box) const {
    int n = density_.samples_per_axis;
    for (std::size_t i = 0; i < objects_.size(); ++i)
        if (plans_[i].use == ObjectUse::kMesh && plans_[i].samples_per_axis > n &&
            box.overlaps(object_boxes_[i]))
            n = plans_[i].samples_per_axis;
    return n;
}

std::vector<std::string> FramePlacer::explain(const RenderQuality& quality) const {
    std::vector<std::size_t> triangles;
    std::vector<std::string> names;
    for (const ShownObject& object : objects_) names.push_back(object.name);
    for (const ObjectSurfaces* surfaces : shown_) triangles.push_back(surfaces->triangles.size());
    std::vector<std::string> out =
        hilcam::explain({frame_, plans_, names, triangles, quality, stars_.size()}, world_);
    if (background_.shows_detail()) out.push_back(earth_detail_->explain());
    return out;
}

}  // namespace hilcam
