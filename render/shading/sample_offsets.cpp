#include "render/shading/sample_offsets.h"

#include <cmath>

#include "render/visibility/visibility_buffer.h"

namespace hilcam {

Vec3d direction_seen(const FrameContext& frame, int x_px, int y_px, Vec2f within_px) {
    const int n = frame.samples.buffer_px();
    const auto scale = static_cast<float>(n);
    const Vec2f at{scale * within_px.x, scale * within_px.y};
    const int right = at.x >= 1 ? 1 : 0, down = at.y >= 1 ? 1 : 0;
    if (n == 1) return frame.visibility->direction(x_px, y_px, at);
    return frame.visibility->direction(n * x_px + right, n * y_px + down,
                                       {at.x - static_cast<float>(right), at.y - static_cast<float>(down)});
}

Vec3d direction_through(const FrameContext& frame, int x_px, int y_px, Vec2f within_px) {
    const LinearRays* const rays = frame.rays->linear();
    return rays ? rays->corner + (x_px + static_cast<double>(within_px.x)) * rays->right +
                      (y_px + static_cast<double>(within_px.y)) * rays->down
                : direction_seen(frame, x_px, y_px, within_px);
}

Vec3d eye_m(const FrameContext& frame, int y_px) {
    if (frame.rays->is_still()) return frame.camera_m;
    return frame.camera_m + frame.visibility->moved_m(frame.samples.buffer_px() * y_px);
}

namespace {

// The least cosine to the viewer at which a plane counts as visible, and not as seen edge-on.
constexpr float kMinFacingOfWay = 0.02f;

}  // namespace

SampleOffsets::SampleOffsets(const Tile& tile, const ShadingPoint& at)
    : frame_(tile.frame), at_(at), facing_(dot(at.geometric_normal, at.view_dir)) {
    const int width = tile.box.x1 - tile.box.x0, pixel = static_cast<int>(at.pixel);
    x_px_ = tile.box.x0 + pixel % width, y_px_ = tile.box.y0 + pixel / width;
    eye_m_ = eye_m(frame_, y_px_);
    dir_ = direction_through(frame_, x_px_, y_px_, at.place_px);
    per_dir_m_ = static_cast<double>(at.footprint_m) * frame_.geometry.focal_length_px / length(dir_);
}

Vec3f SampleOffsets::on(const NormalCluster& cluster, int sample) const {
    const Vec3d dir = direction_through(frame_, x_px_, y_px_, frame_.samples.place(sample)),
                normal = to_double(cluster.geometric_normal);
    const double along = dot(dir, normal);
    if (std::abs(along) < static_cast<double>(kMinFacingOfWay) * length(dir)) return cluster.start_m;
    const double way = dot(to_double(cluster.start_m) - eye_m_, normal) / along;
    return to_float(eye_m_ + way * dir);
}

Vec3f SampleOffsets::to(int sample) const {
    if (facing_ < kMinFacingOfWay) return {};
    const Vec3f across =
        to_float(per_dir_m_ * (direction_through(frame_, x_px_, y_px_, frame_.samples.place(sample)) - dir_));
    return across - (dot(across, at_.geometric_normal) / facing_) * at_.view_dir +
           at_.lift_m * at_.geometric_normal;
}

}  // namespace hilcam
