#include "render/frame/truth_probe.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render/frame/truth_outlines.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/stopwatch.h"

namespace hilcam {
namespace {

constexpr int kBlock_px = 4;  // a packet of sixteen rays
constexpr float kInfinity_m = std::numeric_limits<float>::infinity();

template <class Layer>
void size_layer(Layer& layer, const FrameRaster& raster) {
    if (layer.planes() > 0) layer.reshape(raster.width_px, raster.height_px);
}

template <class Layer>
void write_vector(Layer& layer, int x, int y, Vec3f value) {
    if (layer.planes() == 0) return;
    const auto at = static_cast<std::size_t>(x);
    layer.row(y, 0)[at] = value.x, layer.row(y, 1)[at] = value.y, layer.row(y, 2)[at] = value.z;
}

double phase_of(Vec3d to_sun_m, Vec3d to_camera_m) {
    const double cosine = dot(normalized(to_sun_m), normalized(to_camera_m));
    return std::acos(std::clamp(cosine, -1.0, 1.0));
}

}  // namespace

FrameTruth make_truth(const FrameSetup& setup, const TruthRequest& request, int width_px, int height_px) {
    FrameTruth truth;
    truth.request = request;
    const std::size_t objects = setup.objects();
    truth.things.reserve(objects + 1 + kMaxBodies);
    truth.parts.reserve(objects);
    truth.point_boxes.reserve(objects);
    if (request.stars) {
        truth.stars.reserve(std::min(setup.max_stars(), kMaxTruthStars));
        truth.star_field.reserve(setup.max_stars());
    }
    if (request.rays()) truth.layers.object = IdImage(width_px, height_px);
    if (request.part) truth.layers.part = IdImage(width_px, height_px);
    if (request.range) truth.layers.range_m = LengthImage(width_px, height_px);
    if (request.depth) truth.layers.depth_m = LengthImage(width_px, height_px);
    if (request.position) truth.layers.position_m = LengthImage(width_px, height_px, 3);
    if (request.normal) truth.layers.normal = DirectionImage(width_px, height_px, 3);
    return truth;
}

TruthProbe::TruthProbe(const FrameSetup& setup, FrameTruth& truth)
    : setup_(setup),
      frame_(setup.frame()),
      world_(setup.world()),
      truth_(truth),
      rays_(setup),
      camera_from_world_(transposed(to_matrix(setup.world().camera.world_from_body))) {}

void TruthProbe::report() {
    const Stopwatch watch;
    truth_.time = world_.time;
    truth_.camera = world_.camera;
    truth_.camera_velocity_m_s = world_.camera_velocity_m_s;
    truth_.camera_rate_rad_s = world_.camera_rate_rad_s;
    truth_.geometry = frame_.geometry;
    truth_.height_above_ground_m = setup_.height_above_ground_m();
    truth_.things.clear();
    truth_.parts.clear();
    report_objects();
    report_sun_and_bodies();
    if (truth_.request.rays()) trace_pixels();
    if (truth_.request.visibility) {
        count_pixels();
        TruthOutlines outlines(setup_, rays_, truth_);
        if (truth_.request.silhouettes) outlines.find_silhouettes();
        for (SeenThing& thing : truth_.things) outlines.measure(thing);
    }
    if (truth_.request.stars) report_stars();
    truth_.took_ms = watch.ms();
}

// --- poses and places

// Finds where the picture shows a place.
bool TruthProbe::project(Vec3d from_camera_m, Vec2d& frame_px) const {
    const double distance_m = length(from_camera_m);
    Sighting seen;
    if (!(distance_m > 0) || !frame_.rays->find(from_camera_m / distance_m, distance_m, seen)) return false;
    if (!std::isfinite(seen.position_px.x) || !std::isfinite(seen.position_px.y)) return false;
    frame_px = truth_.raster.frame_px(seen.position_px);
    return true;
}

SeenThing TruthProbe::described(std::uint32_t id, const Pose& world) const {
    return described(id, world, world.position_world_m - world_.camera.position_world_m);
}

// from_camera_m: its apparent position.
SeenThing TruthProbe::described(std::uint32_t id, const Pose& world, Vec3d from_camera_m) const {
    SeenThing thing;
    thing.id = id;
    thing.world = world;
    thing.position_camera_m = camera_from_world_ * from_camera_m;
    thing.camera_from_thing = conjugate(world_.camera.world_from_body) * world.world_from_body;
    thing.distance_m = length(from_camera_m);
    thing.has_center = project(from_camera_m, thing.center_px);
    thing.phase_rad = phase_of(world_.bodies.sun_world_m - world.position_world_m, -from_camera_m);
    return thing;
}

void TruthProbe::report_objects() {
    HILCAM_CHECK(truth_.request.thing_of_object.empty() ||
                 truth_.request.thing_of_object.size() == setup_.objects());
    for (std::size_t i = 0; i < setup_.objects(); ++i) {
        const std::uint32_t owner = owner_of(truth_, i), id = owner + 1;
        const Pose& pose = world_.objects[i];
        if (owner < truth_.things.size()) {
            const Vec3d from_camera_m = pose.position_world_m - world_.camera.position_world_m;
            truth_.parts.push_back({id, static_cast<std::uint32_t>(i), camera_from_world_ * from_camera_m,
                                    conjugate(world_.camera.world_from_body) * pose.world_from_body});
            SeenThing& whole = truth_.things[owner];
            whole.radius_m =
                std::max(whole.radius_m,
                         length(pose.position_world_m - whole.world.position_world_m) + setup_.radius_m(i));
            continue;
        }
        SeenThing thing = described(id, pose);
        thing.radius_m = setup_.radius_m(i);
        const Spectrum seen = frame_.background->sun_seen_from(pose.position_world_m, kNoBody);
        double sum = 0;
        for (int b = 0; b < frame_.bins; ++b) sum += static_cast<double>(seen[b]);
        thing.sunlit = sum / frame_.bins;
        truth_.things.push_back(thing);
    }
}

void TruthProbe::report_sun_and_bodies() {
    const Vec3d to_sun_m = world_.bodies.sun_world_m - world_.camera.position_world_m;
    truth_.sun_distance_m = length(to_sun_m);
    truth_.sun_world_dir = frame_.background->sun_camera_dir();
    truth_.sun_camera_dir = camera_from_world_ * truth_.sun_world_dir;
    SeenThing sun =
        described(kSunId, {world_.bodies.sun_world_m, {}}, truth_.sun_distance_m * truth_.sun_world_dir);
    sun.is_body = true;
    sun.phase_rad = 0;
    sun.radius_m = sun.polar_radius_m = kSunRadius_m;
    truth_.things.push_back(sun);
    const auto add = [&](const PlacedBody& body) {
        const BodyState& state = world_.bodies[body.id];
        SeenThing thing =
            described(truth_id(body.id), {state.world_m, to_quat(transposed(state.fixed_from_world))},
                      body.distance_m * body.world_dir);
        thing.is_body = true;
        thing.radius_m = body.figure.equatorial_radius_m;
        thing.polar_radius_m = body.figure.polar_radius_m;
        truth_.things.push_back(thing);
    };
    for (const PlacedBody& body : frame_.background->disks()) add(body);
    for (const PlacedBody& body : frame_.background->points()) add(body);
}

void TruthProbe::report_stars() {
    truth_.stars.clear();
    truth_.stars_left_out = 0;
    const PointField field(frame_, world_);
    constexpr double kFar = std::numeric_limits<double>::infinity();
    // In the catalogue's order; if there is no room for all, the fainter ones are left out.
    truth_.star_field.clear();
    field.each_star(setup_.stars(), [&](const Star& star, Vec3d dir) {
        if (static_cast<double>(star.magnitude_v) <= truth_.request.faintest_magnitude)
            truth_.star_field.push_back({&star, dir});
    });
    std::sort(truth_.star_field.begin(), truth_.star_field.end(),
              [](const auto& a, const auto& b) { return a.star->row < b.star->row; });
    for (const auto& [in_field, dir] : truth_.star_field) {
        const Star& star = *in_field;
        Sighting where;
        SeenStar seen;
        const AirRefraction::Seen through_air = frame_.background->seen_through_air(dir, kFar);
        if (!field.look(through_air.dir, kFar,
                        static_cast<float>(through_air.light) * star.irradiance_w_m2_um, where,
                        seen.irradiance_w_m2_um))
            continue;
        const Vec2d at_px = truth_.raster.frame_px(where.position_px);
        if (!rays_.on_image(where.position_px) || !(at_px.x >= 0 && at_px.x < truth_.raster.width_px) ||
            !(at_px.y >= 0 && at_px.y < truth_.raster.height_px))
            continue;
        if (truth_.stars.size() == truth_.stars.capacity()) {
            ++truth_.stars_left_out;
            continue;
        }
        seen.row = star.row, seen.hip = star.hip, seen.hd = star.hd;
        seen.position_px = at_px, seen.image_px = where.position_px;
        seen.magnitude_v = star.magnitude_v;
        seen.irradiance_w_m2_um = static_cast<float>(where.light_ratio) * seen.irradiance_w_m2_um;
        truth_.stars.push_back(seen);
    }
}

// --- a ray through the middle of every pixel

void TruthProbe::size_layers() {
    size_layer(truth_.layers.object, truth_.raster);
    size_layer(truth_.layers.part, truth_.raster);
    size_layer(truth_.layers.range_m, truth_.raster);
    size_layer(truth_.layers.depth_m, truth_.raster);
    size_layer(truth_.layers.position_m, truth_.raster);
    size_layer(truth_.layers.normal, truth_.raster);
}

void TruthProbe::trace_pixels() {
    size_layers();
    truth_.point_boxes.clear();
    for (std::size_t i = 0; i < setup_.objects(); ++i)
        if (setup_.is_point(i)) truth_.point_boxes.push_back(setup_.box_of(i));
    const int rows = (truth_.raster.height_px + kBlock_px - 1) / kBlock_px;
    tbb::parallel_for(tbb::blocked_range<int>(0, rows), [&](const tbb::blocked_range<int>& range) {
        for (int row = range.begin(); row < range.end(); ++row)
            for (int x = 0; x < truth_.raster.width_px; x += kBlock_px) trace_block(x, row * kBlock_px);
    });
}

// Returns the box of the radiance image that pixels of the frame cover.
PixelBox TruthProbe::padded_box(int x0, int y0, int x1, int y1) const {
    const Vec2d a = truth_.raster.image_px({static_cast<double>(x0), static_cast<double>(y0)});
    const Vec2d b = truth_.raster.image_px({static_cast<double>(x1), static_cast<double>(y1)});
    const ImageGeometry& g = frame_.geometry;
    const auto within = [&](double px, int size) {
        return static_cast<int>(std::clamp(px + g.guard_px, 0.0, static_cast<double>(size)));
    };
    return {within(std::floor(std::min(a.x, b.x)), g.padded_width()),
            within(std::floor(std::min(a.y, b.y)), g.padded_height()),
            within(std::ceil(std::max(a.x, b.x)), g.padded_width()),
            within(std::ceil(std::max(a.y, b.y)), g.padded_height())};
}

// The picture has no rays for objects that it draws as points.
bool TruthProbe::can_see(const PixelBox& padded) const {
    if (padded.empty()) return false;
    return setup_.can_see_anything(padded) ||
           std::any_of(truth_.point_boxes.begin(), truth_.point_boxes.end(),
                       [&](const PixelBox& box) { return box.overlaps(padded); });
}

void TruthProbe::trace_block(int x0, int y0) {
    const int x1 = std::min(x0 + kBlock_px, truth_.raster.width_px);
    const int y1 = std::min(y0 + kBlock_px, truth_.raster.height_px);
    const bool anything = can_see(padded_box(x0, y0, x1, y1));
    std::array<Vec2d, kPacketSize> points;
    std::array<std::array<int, 2>, kPacketSize> pixels;
    std::size_t count = 0;
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
            const Vec2d at = truth_.raster.image_px({x + 0.5, y + 0.5});
            if (!anything || !rays_.on_image(at)) {
                write(x, y, {});
                continue;
            }
            pixels[count] = {x, y};
            points[count++] = at;
        }
    if (count == 0) return;
    std::array<RayMet, kPacketSize> met;
    rays_.trace(std::span(points).first(count), truth_.request.normal, met);
    for (std::size_t k = 0; k < count; ++k) write(pixels[k][0], pixels[k][1], met[k]);
}

void TruthProbe::write(int x, int y, const RayMet& met) {
    const auto at = static_cast<std::size_t>(x);
    const bool sky = met.kind == RayMet::Kind::kSky;
    TruthLayers& layers = truth_.layers;
    layers.object.row(y)[at] = id_of(truth_, met);
    if (layers.part.planes() > 0)
        layers.part.row(y)[at] =
            met.kind == RayMet::Kind::kObject ? 1 + static_cast<std::uint32_t>(met.index) : 0;
    if (layers.range_m.planes() > 0) layers.range_m.row(y)[at] = static_cast<float>(met.range_m);
    const Vec3d place_m = camera_from_world_ * met.from_camera_m;
    if (layers.depth_m.planes() > 0)
        layers.depth_m.row(y)[at] = sky ? kInfinity_m : static_cast<float>(place_m.z);
    write_vector(layers.position_m, x, y,
                 sky ? Vec3f{kInfinity_m, kInfinity_m, kInfinity_m} : to_float(place_m));
    write_vector(layers.normal, x, y, to_float(camera_from_world_ * met.normal_dir));
}

// --- what is visible of each thing

SeenThing* TruthProbe::thing_of(std::uint32_t id) {
    const auto found = std::find_if(truth_.things.begin(), truth_.things.end(),
                                    [id](const SeenThing& thing) { return thing.id == id; });
    return found == truth_.things.end() ? nullptr : &*found;
}

void TruthProbe::count_pixels() {
    for (int y = 0; y < truth_.raster.height_px; ++y) {
        const std::span<const std::uint32_t> row = truth_.layers.object.row(y);
        for (std::size_t from = 0, to = 0; from < row.size(); from = to) {
            while (to < row.size() && row[to] == row[from]) ++to;
            SeenThing* const thing = row[from] == kSkyId ? nullptr : thing_of(row[from]);
            if (!thing) continue;
            const int x0 = static_cast<int>(from), x1 = static_cast<int>(to);
            PixelBox& box = thing->visible_box_px;
            box = thing->visible_px == 0
                      ? PixelBox{x0, y, x1, y + 1}
                      : PixelBox{std::min(box.x0, x0), std::min(box.y0, y), std::max(box.x1, x1), y + 1};
            const double run = x1 - x0;
            thing->visible_px += to - from;
            thing->visible_center_px.x += run * 0.5 * (x0 + x1);
            thing->visible_center_px.y += run * (y + 0.5);
        }
    }
    for (SeenThing& thing : truth_.things) {
        const auto all = static_cast<double>(thing.visible_px);
        if (thing.visible_px > 0)
            thing.visible_center_px = {thing.visible_center_px.x / all, thing.visible_center_px.y / all};
    }
}

}  // namespace hilcam
