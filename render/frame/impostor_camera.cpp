#include "render/frame/impostor_camera.h"

#include <algorithm>
#include <cmath>

#include "render/shading/ray_generators.h"

namespace hilcam {
namespace {

ImageGeometry picture_of(int picture_px, int sphere_px, double radius_m, double distance_m) {
    ImageGeometry geometry;
    geometry.width_px = geometry.height_px = picture_px;
    // The sphere's silhouette has a radius of the tangent of its half angle; 2 % of margin.
    const double sine = std::min(0.999, radius_m / distance_m);
    geometry.focal_length_px = 0.5 * sphere_px / (1.02 * sine / std::sqrt(1 - sine * sine));
    return geometry;
}

constexpr double kProbeMargin = 1.01;  // on the object's radius

}  // namespace

ImpostorCamera::ImpostorCamera(const FrameContext& frame, int picture_px)
    : rays_(make_pinhole_rays()), mask_(picture_of(picture_px, picture_px, 1, 2)), view_(frame) {
    view_.rays = rays_.get();
    view_.object_mask = &mask_;
    view_.visibility = nullptr;
    view_.has_impostors = false;
}

void ImpostorCamera::begin(const FrameContext& frame) {
    view_.indirect = frame.indirect;
    std::copy(frame.is_cached.begin(), frame.is_cached.end(), view_.is_cached.begin());
    view_.key = frame.key;
    view_.max_depth = frame.max_depth;
    view_.contribution_threshold = frame.contribution_threshold;
    view_.sun_is_disk = frame.sun_is_disk;
    view_.paths_sample_lobes = frame.paths_sample_lobes;
    view_.rays_world_m = frame.rays_world_m;
    view_.camera_m = frame.camera_m;
    std::copy(frame.world_from_body.begin(), frame.world_from_body.end(), view_.world_from_body.begin());
    // Other objects matter only if they are in front, which is tested for the points themselves.
    std::fill(view_.is_point.begin(), view_.is_point.end(), std::uint8_t{1});
}

void ImpostorCamera::aim(const WorldSnapshot& world, std::size_t i, double distance_m, double radius_m,
                         int picture_px, int sphere_px) {
    const Vec3d to_object_m = world.objects[i].position_world_m - world.camera.position_world_m;
    // Rotated against the camera's rows, so that an edge along them does not coincide with a row of rays.
    const Vec3d up = std::abs(to_object_m.z) < 0.9 * distance_m ? Vec3d{0.31, 0.17, 1} : Vec3d{1, 0.31, 0.17};
    camera_ = world.camera;
    camera_.world_from_body = look_along(to_object_m, up);
    world_from_view_ = to_matrix(camera_.world_from_body);
    view_.geometry = picture_of(picture_px, sphere_px, radius_m, distance_m);
    view_.start_at_m = world.objects[i].position_world_m - view_.rays_world_m;
    view_.start_before_m = kProbeMargin * radius_m;
    view_.is_point[i] = 0;
    rays_->place(view_.geometry, {world.time, camera_, {}, {}});
    mark(world.objects[i], (*view_.objects)[i]->cluster_bounds_m);
}

// Does nothing if there are so many boxes that rays cost less.
void ImpostorCamera::mark(const Pose& object, std::span<const std::array<Vec3f, 2>> boxes_m) {
    mask_.place(view_.geometry);
    const auto side = static_cast<std::size_t>(view_.geometry.width_px);
    if (boxes_m.size() > side * side / kPacketSize)
        mask_.fill();
    else
        mask_.add(camera_, object, boxes_m);
}

std::size_t ImpostorCamera::find_glimpses(std::span<const Spectrum> picture, int sphere_px, int cells,
                                          Glimpse* glimpses) const {
    const int side = view_.geometry.width_px, first = (side - sphere_px) / 2;
    // A pixel's solid angle; the picture is a few pixels of the camera, so cosines are 1.
    const double pixel_rad = 1 / view_.geometry.focal_length_px;
    const auto solid_angle = static_cast<float>(pixel_rad * pixel_rad);
    const auto begin_of = [&](int cell) { return first + cell * sphere_px / cells; };
    std::size_t count = 0;
    for (int cy = 0; cy < cells; ++cy)
        for (int cx = 0; cx < cells; ++cx) {
            Spectrum sum;
            double x_sum = 0, y_sum = 0, light = 0;
            // Row by row: up to 512 x 512 pixels are too many for one sum in single precision.
            for (int y = begin_of(cy); y < begin_of(cy + 1); ++y) {
                Spectrum row;
                for (int x = begin_of(cx); x < begin_of(cx + 1); ++x) {
                    const Spectrum& here = picture[static_cast<std::size_t>(y * side + x)];
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

int ImpostorCamera::cells_across(const ObjectPlan& plan) {
    return std::max(1, static_cast<int>(std::ceil(2 * plan.size_px)));
}

double ImpostorCamera::before_m(const ObjectPlan& plan, double radius_m) {
    return plan.distance_m - kProbeMargin * radius_m;
}

}  // namespace hilcam
