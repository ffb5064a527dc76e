#include "render/frame/image_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hilcam {
namespace {

constexpr int kGridAcross = 9;

// A point of the picture, at the frame's time.
struct Seen {
    enum class Thing { kSky, kObject, kBody } thing = Thing::kSky;
    std::size_t index = 0;  // number of the object or the body
    Vec3d world;            // place [m]; of the sky: direction
};

class Follower {
  public:
    Follower(const MovingFrame& moving, const Instants& instants)
        : moving_(moving), middle_(instants.middle), before_(instants.before), after_(instants.after) {}

    // Returns false if it cannot be projected at one of the ends.
    bool displacement_px(const Seen& seen, Vec2d& out) const {
        Vec2d from, to;
        if (!project(seen, before_, from) || !project(seen, after_, to)) return false;
        out = {to.x - from.x, to.y - from.y};
        return std::isfinite(out.x) && std::isfinite(out.y);
    }

  private:
    const MovingFrame& moving_;
    const WorldSnapshot &middle_, &before_, &after_;

    bool project(const Seen& seen, const WorldSnapshot& at, Vec2d& out) const {
        const Vec3d to_thing =
            seen.thing == Seen::Thing::kSky ? seen.world : carried_m(seen, at) - at.camera.position_world_m;
        const Vec3d d = transposed(to_matrix(at.camera.world_from_body)) * to_thing;
        if (!(d.z > 1e-3 * length(d))) return false;
        out = moving_.frame.geometry.project_px(d);
        return true;
    }
    Vec3d carried_m(const Seen& seen, const WorldSnapshot& at) const {
        if (seen.thing == Seen::Thing::kBody)
            return with_body(static_cast<BodyId>(seen.index), seen.world, at);
        if (moving_.has_terrain && seen.index + 1 == moving_.plans.size())
            return moving_.terrain_body ? with_body(*moving_.terrain_body, seen.world, at) : seen.world;
        const Pose &then = middle_.objects[seen.index], &now = at.objects[seen.index];
        const Vec3d on_object_m =
            transposed(to_matrix(then.world_from_body)) * (seen.world - then.position_world_m);
        return now.position_world_m + to_matrix(now.world_from_body) * on_object_m;
    }
    Vec3d with_body(BodyId id, Vec3d world_m, const WorldSnapshot& at) const {
        const BodyState &then = middle_.bodies[id], &now = at.bodies[id];
        return now.world_m +
               transposed(now.fixed_from_world) * (then.fixed_from_world * (world_m - then.world_m));
    }
};

// Finds what a ray of the camera at the frame's time meets first.
Seen look(const FrameContext& frame, const WorldSnapshot& world, Vec3d dir) {
    Seen seen{Seen::Thing::kSky, 0, dir};
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const PlacedBody& body : frame.background->disks()) {
        const double distance_m =
            intersect_ellipsoid(body.figure, body.camera_m, body.fixed_from_world * dir);
        if (distance_m < 0 || distance_m >= nearest_m) continue;
        nearest_m = distance_m;
        seen = {Seen::Thing::kBody, index_of(body.id), world.camera.position_world_m + distance_m * dir};
    }
    RayPacket ray;
    HitPacket hit;
    ray.count = 1;
    const Vec3f start = frame.start_of(dir);
    ray.set(0, start, to_float(dir), 0, std::numeric_limits<float>::infinity());
    frame.scene->intersect(ray, Coherence::kCoherent, hit);
    if (hit.object[0] == HitPacket::kMiss || frame.is_point[hit.object[0]]) return seen;
    const Vec3d from_camera_m =
        to_double(start) + static_cast<double>(hit.distance[0]) * dir - frame.camera_m;
    if (length(from_camera_m) >= nearest_m) return seen;
    return {Seen::Thing::kObject, hit.object[0], world.camera.position_world_m + from_camera_m};
}

// Collects displacements: of each thing, and the largest.
class Collection {
  public:
    void add(const Seen& seen, Vec2d displacement_px) {
        largest_px_ = std::max(largest_px_, std::hypot(displacement_px.x, displacement_px.y));
        if (seen.thing != Seen::Thing::kSky && count_ < seen_.size()) {
            seen_[count_] = seen;
            displacements_px_[count_++] = displacement_px;
        }
    }
    void add_largest(Vec2d displacement_px) {
        largest_px_ = std::max(largest_px_, std::hypot(displacement_px.x, displacement_px.y));
    }
    bool nothing() const { return count_ == 0; }
    double largest_px() const { return largest_px_; }
    // Returns the mean of the thing with the most points.
    Vec2d of_most() const {
        std::size_t most = 0;
        Vec2d mean{};
        for (std::size_t i = 0; i < count_; ++i) {
            std::size_t n = 0;
            Vec2d sum{};
            for (std::size_t k = 0; k < count_; ++k)
                if (seen_[k].thing == seen_[i].thing && seen_[k].index == seen_[i].index) {
                    ++n;
                    sum.x += displacements_px_[k].x, sum.y += displacements_px_[k].y;
                }
            if (n <= most) continue;
            most = n;
            mean = {sum.x / static_cast<double>(n), sum.y / static_cast<double>(n)};
        }
        return mean;
    }

  private:
    std::array<Seen, kGridAcross * kGridAcross + 1> seen_;
    std::array<Vec2d, kGridAcross * kGridAcross + 1> displacements_px_;
    std::size_t count_ = 0;
    double largest_px_ = 0;
};

bool in_image(const ImageGeometry& g, Vec2d p) {
    return p.x >= -g.guard_px && p.y >= -g.guard_px && p.x <= g.width_px + g.guard_px &&
           p.y <= g.height_px + g.guard_px;
}

// Adds the object's middle and four places on its outline.
void add_object(const MovingFrame& moving, const WorldSnapshot& world, std::size_t i,
                const Follower& follower, Collection& all) {
    const Mat3d world_from_camera = to_matrix(world.camera.world_from_body);
    const Vec3d middle_m = world.objects[i].position_world_m;
    const bool first = all.nothing();
    for (const Vec2d at : {Vec2d{0, 0}, Vec2d{-1, 0}, Vec2d{1, 0}, Vec2d{0, -1}, Vec2d{0, 1}}) {
        const Vec3d side_m = moving.radii_m[i] * (world_from_camera * Vec3d{at.x, at.y, 0});
        const Seen seen{Seen::Thing::kObject, i, middle_m + side_m};
        const Vec3d d = transposed(world_from_camera) * (seen.world - world.camera.position_world_m);
        Vec2d displacement_px;
        if (!(d.z > 0) || !in_image(moving.frame.geometry, moving.frame.geometry.project_px(d)) ||
            !follower.displacement_px(seen, displacement_px))
            continue;
        if (first && at.x == 0 && at.y == 0)
            all.add(seen, displacement_px);
        else
            all.add_largest(displacement_px);
    }
}

}  // namespace

ImageMotion image_motion(const MovingFrame& moving, const Instants& instants) {
    const WorldSnapshot& middle = instants.middle;
    const ImageGeometry& g = moving.frame.geometry;
    const Mat3d world_from_camera = to_matrix(middle.camera.world_from_body);
    const Follower follower(moving, instants);
    const bool one_line = moving.frame.rays->scan_line_time_s() > 0;
    Collection all;
    Vec2d displacement_px;
    const int rows = one_line ? 1 : kGridAcross;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < kGridAcross; ++x) {
            const double y_px = one_line ? g.center_px().y : (y + 0.5) * g.height_px / kGridAcross;
            const Vec3d dir = normalized(world_from_camera *
                                         g.direction_camera((x + 0.5) * g.width_px / kGridAcross, y_px));
            const Seen seen = look(moving.frame, middle, dir);
            if (seen.thing != Seen::Thing::kSky && follower.displacement_px(seen, displacement_px))
                all.add(seen, displacement_px);
        }
    // The largest one in view comes first: it represents the picture if the grid met nothing.
    std::size_t largest = moving.plans.size();
    for (std::size_t i = 0; i < moving.plans.size(); ++i)
        if (largest == moving.plans.size() || moving.plans[i].size_px > moving.plans[largest].size_px)
            largest = i;
    const std::size_t objects = moving.plans.size() - (moving.has_terrain ? 1 : 0);
    if (largest < objects) add_object(moving, middle, largest, follower, all);
    for (std::size_t i = 0; i < objects; ++i)
        if (i != largest) add_object(moving, middle, i, follower, all);
    if (moving.has_stars)
        for (const double x : {0.0, 0.5, 1.0})
            for (const double y : {0.0, 0.5, 1.0}) {
                if ((x == 0.5) != (y == 0.5)) continue;
                const double y_px = one_line ? g.center_px().y : y * g.height_px;
                const Seen sky{Seen::Thing::kSky, 0,
                               world_from_camera * g.direction_camera(x * g.width_px, y_px)};
                if (follower.displacement_px(sky, displacement_px)) all.add_largest(displacement_px);
            }
    return {all.of_most(), all.largest_px()};
}

void set_drifts(const MovingFrame& moving, const Instants& instants, double per_s,
                std::span<PointSource> points) {
    const Follower follower(moving, instants);
    for (PointSource& point : points) {
        if (point.object == PointSource::kSky) continue;
        const bool is_body = point.object >= PointSource::kFirstBody;
        const std::size_t i = point.object - (is_body ? PointSource::kFirstBody : 0);
        const Vec3d middle_m =
            is_body ? instants.middle.bodies.body[i].world_m : instants.middle.objects[i].position_world_m;
        const Seen object{is_body ? Seen::Thing::kBody : Seen::Thing::kObject, i, middle_m};
        const Seen sky{Seen::Thing::kSky, 0, middle_m - instants.middle.camera.position_world_m};
        Vec2d way_px, sky_way_px;
        if (follower.displacement_px(object, way_px) && follower.displacement_px(sky, sky_way_px))
            point.drift_px_s = {static_cast<float>((way_px.x - sky_way_px.x) * per_s),
                                static_cast<float>((way_px.y - sky_way_px.y) * per_s)};
    }
}

}  // namespace hilcam
