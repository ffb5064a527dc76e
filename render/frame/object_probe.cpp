#include "render/frame/object_probe.h"

#include <algorithm>
#include <cmath>

#include "render/light/ray_generators.h"

namespace hilcam {
namespace {

// The sphere fills the picture.
ImageGeometry picture_of(int samples, double radius_m, double distance_m) {
    ImageGeometry geometry;
    geometry.width_px = geometry.height_px = samples;
    // The sphere's silhouette has the tangent of its half angle as radius; 2 % of margin.
    const double sine = std::min(0.999, radius_m / distance_m);
    geometry.focal_length_px = 0.5 * samples / (1.02 * sine / std::sqrt(1 - sine * sine));
    return geometry;
}

constexpr double kMargin = 1.01;  // on the object's radius

}  // namespace

ObjectProbe::ObjectProbe(const FrameView& frame, int most_samples)
    : samples_(most_samples),
      rays_(make_pinhole_rays()),
      mask_(picture_of(most_samples, 1, 2)),
      view_(frame),
      tile_(PathModel::kMaxSamples),
      picture_(static_cast<std::size_t>(most_samples * most_samples)) {
    view_.rays = rays_.get();
    view_.object_mask = &mask_;
}

void ObjectProbe::begin(const FrameView& frame) {
    view_.kept = frame.kept;
    view_.key = frame.key;
    view_.max_depth = frame.max_depth;
    view_.contribution_threshold = frame.contribution_threshold;
    view_.sun_is_disk = frame.sun_is_disk;
    view_.paths_sample_lobes = frame.paths_sample_lobes;
    view_.rays_world_m = frame.rays_world_m;
    view_.camera_m = frame.camera_m;
    std::copy(frame.world_from_body.begin(), frame.world_from_body.end(), view_.world_from_body.begin());
    // The others are in the way only if they are before it, which the points themselves are asked.
    std::fill(view_.is_point.begin(), view_.is_point.end(), std::uint8_t{1});
}

void ObjectProbe::aim(const WorldSnapshot& world, std::size_t i, double distance_m, double radius_m) {
    const Vec3d to_object_m = world.objects[i].position_world_m - world.camera.position_world_m;
    // Turned against the camera's rows, so that an edge along them does not fall on a row of rays.
    const Vec3d up = std::abs(to_object_m.z) < 0.9 * distance_m ? Vec3d{0.31, 0.17, 1} : Vec3d{1, 0.31, 0.17};
    Pose camera = world.camera;
    camera.world_from_body = look_along(to_object_m, up);
    world_from_view_ = to_matrix(camera.world_from_body);
    view_.geometry = picture_of(samples_, radius_m, distance_m);
    view_.start_at_m = world.objects[i].position_world_m - view_.rays_world_m;
    view_.start_before_m = kMargin * radius_m;
    rays_->place(view_.geometry, {world.time, camera, {}, {}});
    mark(camera, world.objects[i], (*view_.objects)[i]->cluster_bounds_m);
}

// Rays are sent where the boxes of its triangles are, unless there are so many that the rays cost less.
void ObjectProbe::mark(const Pose& camera, const Pose& object,
                       std::span<const std::array<Vec3f, 2>> boxes_m) {
    mask_.place(view_.geometry);
    const auto packets = static_cast<std::size_t>(samples_ * samples_ / kPacketSize);
    if (boxes_m.size() > packets)
        mask_.fill();
    else
        mask_.add(camera, object, boxes_m);
}

TileStats ObjectProbe::trace(PathModel& paths) {
    const int edge = tile_edge_px(1);
    TileStats stats;
    for (int y = 0; y < samples_; y += edge)
        for (int x = 0; x < samples_; x += edge) {
            const PixelBox box{x, y, std::min(x + edge, samples_), std::min(y + edge, samples_)};
            const int width = box.x1 - box.x0;
            const std::span<Spectrum> pixels(tile_.data(),
                                             static_cast<std::size_t>(width * (box.y1 - box.y0)));
            std::fill(pixels.begin(), pixels.end(), Spectrum{});
            Tile tile{view_, box, 1, pixels, stats, *facets_};
            paths.trace(tile);
            for (int row = box.y0; row < box.y1; ++row)
                std::copy_n(pixels.begin() + (row - box.y0) * width, width,
                            picture_.begin() + row * samples_ + box.x0);
        }
    stats.covered_px = 0;  // those are not the camera's pixels
    return stats;
}

int ObjectProbe::cells_across(const ObjectPlan& plan) {
    return std::clamp(static_cast<int>(std::ceil(2 * plan.size_px)), 1, kMaxCells);
}

double ObjectProbe::before_m(const ObjectPlan& plan, double radius_m) {
    return plan.distance_m - kMargin * radius_m;
}

std::size_t ObjectProbe::look(const WorldSnapshot& world, std::size_t i, const ObjectPlan& plan,
                              double radius_m, PathModel& paths, Glimpse* glimpses, TileStats& stats) {
    samples_ = plan.point_samples;
    aim(world, i, plan.distance_m, radius_m);
    view_.is_point[i] = 0;
    stats += trace(paths);
    view_.is_point[i] = 1;
    std::size_t count = 0;
    // A sample's solid angle; the picture is a few pixels of the camera, so cosines are 1.
    const double sample_rad = 1 / view_.geometry.focal_length_px;
    const auto solid_angle = static_cast<float>(sample_rad * sample_rad);
    const int cells = std::min(cells_across(plan), samples_);
    for (int cy = 0; cy < cells; ++cy)
        for (int cx = 0; cx < cells; ++cx) {
            Spectrum sum;
            double x_sum = 0, y_sum = 0, light = 0;
            // Row by row: up to 512 x 512 samples are too many for one sum in single precision.
            for (int y = cy * samples_ / cells; y < (cy + 1) * samples_ / cells; ++y) {
                Spectrum row;
                for (int x = cx * samples_ / cells; x < (cx + 1) * samples_ / cells; ++x) {
                    const Spectrum& here = picture_[static_cast<std::size_t>(y * samples_ + x)];
                    const auto amount = static_cast<double>(mean(here, view_.bins));
                    row += here;
                    x_sum += amount * (x + 0.5), y_sum += amount * (y + 0.5), light += amount;
                }
                sum += row;
            }
            if (!(light > 0)) continue;
            const Vec3d at = world_from_view_ * view_.geometry.direction_camera(x_sum / light, y_sum / light);
            glimpses[count++] = {normalized(at), solid_angle * sum};
        }
    return count;
}

}  // namespace hilcam
