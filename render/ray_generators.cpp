#include "render/ray_generators.h"

#include <cmath>
#include <cstdint>

namespace hilcam {
namespace {

class PinholeRays final : public RayGenerator {
  public:
    void place(const ImageGeometry& geometry, const Motion& camera) override {
        geometry_ = geometry;
        world_from_camera_ = to_matrix(camera.pose.world_from_body);
        const double corner = -geometry.guard_px;
        linear_.corner = direction(corner, corner);
        linear_.right = direction(corner + 1, corner) - linear_.corner;
        linear_.down = direction(corner, corner + 1) - linear_.corner;
    }
    void generate(std::span<const Vec2d> points_px, std::span<CameraRay> rays) const override {
        for (std::size_t i = 0; i < points_px.size(); ++i)
            rays[i] = {{},
                       direction(points_px[i].x - geometry_.guard_px, points_px[i].y - geometry_.guard_px)};
    }
    const LinearRays* linear() const override { return geometry_.distortion.none() ? &linear_ : nullptr; }

  private:
    ImageGeometry geometry_;
    Mat3d world_from_camera_;
    LinearRays linear_;

    Vec3d direction(double x_px, double y_px) const {
        return world_from_camera_ * geometry_.direction_camera(x_px, y_px);
    }
};

// A pose per row; a row's pose is worked out once for the rays that follow each other in it.
class RowRays final : public RayGenerator {
  public:
    RowRays(double line_time_s, bool moves_over_sensor)
        : line_time_s_(line_time_s), rolling_(moves_over_sensor) {}

    void place(const ImageGeometry& geometry, const Motion& camera) override {
        geometry_ = geometry;
        camera_ = camera;
    }
    void generate(std::span<const Vec2d> points_px, std::span<CameraRay> rays) const override {
        double row = -1;
        Vec3d moved_m;
        Mat3d world_from_camera;
        for (std::size_t i = 0; i < points_px.size(); ++i) {
            const double y = points_px[i].y - geometry_.guard_px;
            if (i == 0 || std::floor(y) != row) {
                row = std::floor(y);
                const double dt_s = (row + 0.5 - 0.5 * geometry_.height_px) * line_time_s_;
                const Pose pose = propagate(camera_, camera_.time + std::llround(dt_s * 1e9));
                moved_m = pose.position_world_m - camera_.pose.position_world_m;
                world_from_camera = to_matrix(pose.world_from_body);
            }
            // A line camera has one row, at the middle of the field.
            const double on_sensor = rolling_ ? y : geometry_.center_px().y + (y - row - 0.5);
            rays[i] = {moved_m, world_from_camera * geometry_.direction_camera(
                                                        points_px[i].x - geometry_.guard_px, on_sensor)};
        }
    }
    bool is_still() const override { return false; }

  private:
    double line_time_s_;
    bool rolling_;
    ImageGeometry geometry_;
    Motion camera_;
};

}  // namespace

std::unique_ptr<RayGenerator> make_pinhole_rays() { return std::make_unique<PinholeRays>(); }
std::unique_ptr<RayGenerator> make_rolling_rays(double line_time_s) {
    return std::make_unique<RowRays>(line_time_s, true);
}
std::unique_ptr<RayGenerator> make_pushbroom_rays(double line_time_s) {
    return std::make_unique<RowRays>(line_time_s, false);
}

}  // namespace hilcam
