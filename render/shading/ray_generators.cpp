#include "render/shading/ray_generators.h"

#include <algorithm>
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
    bool find(Vec3d dir, double, Sighting& seen) const override {
        const Vec3d d = transposed(world_from_camera_) * dir;
        if (!(d.z > 0)) return false;
        seen = {geometry_.project_px(d), {}, 1};
        return geometry_.shows(d, seen.position_px);
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

// A pose per row.
class RowRays : public RayGenerator {
  public:
    explicit RowRays(double line_time_s) : line_time_s_(line_time_s) {}

    void place(const ImageGeometry& geometry, const Motion& camera) override {
        geometry_ = geometry;
        motion_ = {camera, line_time_s_, 0.5 * geometry.height_px};
    }
    // A row's pose is computed once for consecutive rays in it.
    void generate(std::span<const Vec2d> points_px, std::span<CameraRay> rays) const override {
        double row = -1;
        RowPose at;
        for (std::size_t i = 0; i < points_px.size(); ++i) {
            const double y = points_px[i].y - geometry_.guard_px;
            if (i == 0 || std::floor(y) != row) {
                row = std::floor(y);
                at = pose_at(row + 0.5);
            }
            rays[i] = {at.moved_m,
                       at.world_from_camera * geometry_.direction_camera(points_px[i].x - geometry_.guard_px,
                                                                         sensor_row(y, row))};
        }
    }
    bool is_still() const override { return false; }
    double sweep_rad() const override {
        return length(motion_.camera.rate_body_rad_s) * 0.5 * geometry_.padded_height() * line_time_s_;
    }

  protected:
    struct RowPose {
        Vec3d moved_m;
        Mat3d world_from_camera;
    };
    // The pose at the instant of a place down the image; the middle of row i is at i + 0.5.
    RowPose pose_at(double y_px) const {
        const Pose pose = motion_.pose_at(y_px);
        return {pose.position_world_m - motion_.camera.pose.position_world_m,
                to_matrix(pose.world_from_body)};
    }
    // Finds the thing's place on the sensor at that instant. Returns false if it is behind the camera.
    bool project(Vec3d dir, double distance_m, double y_px, Sighting& seen) const {
        const RowPose at = pose_at(y_px);
        const Vec3d d = in_camera(at, dir, distance_m);
        if (!(d.z > 1e-6)) return false;
        seen.position_px = geometry_.project_px(d);
        seen.from_camera_m = at.moved_m;
        return true;
    }
    // True when the lens shows it where project() said. A thing may pass such false places on its way to its
    // row.
    bool lens_shows(Vec3d dir, double distance_m, double y_px, const Sighting& seen) const {
        return geometry_.shows(in_camera(pose_at(y_px), dir, distance_m), seen.position_px);
    }
    // Returns the row of the sensor for a place down the image, in its row.
    virtual double sensor_row(double y_px, double row) const = 0;

    double line_time_s_;
    ImageGeometry geometry_;
    RowMotion motion_;

  private:
    static Vec3d in_camera(const RowPose& at, Vec3d dir, double distance_m) {
        const Vec3d to_thing = std::isinf(distance_m) ? dir : dir - at.moved_m / distance_m;
        return transposed(at.world_from_camera) * to_thing;
    }
};

constexpr int kMaxLensSteps = 32;
constexpr double kFound_px = 1e-4;

class RollingRays final : public RowRays {
  public:
    using RowRays::RowRays;

    const RowMotion* row_motion() const override { return &motion_; }
    // Finds the row y with y = (the thing's place at the instant of y) by the secant method: one step for
    // uniform motion.
    bool find(Vec3d dir, double distance_m, Sighting& seen) const override {
        double y = 0.5 * geometry_.height_px;
        if (!project(dir, distance_m, y, seen)) return false;
        double miss = seen.position_px.y - y;
        double next = seen.position_px.y;
        for (int step = 0; step < kMaxLensSteps && is_near(next); ++step) {
            if (!project(dir, distance_m, next, seen)) return false;
            const double next_miss = seen.position_px.y - next;
            if (std::abs(next_miss) < kFound_px) return lens_shows(dir, distance_m, next, seen);
            if (next_miss == miss) return false;  // it moves along with the rows
            const double after = next - next_miss * (next - y) / (next_miss - miss);
            y = next, miss = next_miss, next = after;
        }
        return false;
    }

  private:
    double sensor_row(double y_px, double) const override { return y_px; }
    // A row is not searched farther than a frame's height beside the image.
    bool is_near(double y_px) const { return std::abs(y_px) < 2.0 * geometry_.padded_height(); }
};

class PushbroomRays final : public RowRays {
  public:
    using RowRays::RowRays;

    double scan_line_time_s() const override { return line_time_s_; }
    // Finds the instant at which the thing crosses the sensor's row. Each line that passes over it collects
    // light for one line time. If it moves by one row of the sensor in s rows of the image, it has s times
    // the light that it would have in a staring camera.
    bool find(Vec3d dir, double distance_m, Sighting& seen) const override {
        double y = 0.5 * geometry_.height_px;
        double miss = 0;
        if (!off_line(dir, distance_m, y, seen, miss)) return false;
        double next = y + 0.25;
        for (int step = 0; step < kMaxLensSteps; ++step) {
            double next_miss = 0;
            if (!off_line(dir, distance_m, next, seen, next_miss)) return false;
            const double speed = (next_miss - miss) / (next - y);  // rows of the sensor per row of the image
            const bool stays = !(std::abs(speed) * 4 * geometry_.padded_height() > 1);
            const bool found = std::abs(next_miss) < kFound_px;
            if ((stays || found) && !lens_shows(dir, distance_m, next, seen)) return false;
            if (stays) return stays_on_line(miss, seen);
            if (found) {
                seen.position_px.y = next - next_miss / speed;
                seen.light_ratio = 1 / std::abs(speed);
                return true;
            }
            y = next, miss = next_miss, next -= next_miss / speed;
            // The extrapolation is limited to the sweep.
            const double reach = 2.0 * geometry_.padded_height();
            next = std::clamp(next, -reach, reach);
            if (next == y) return false;
        }
        return false;
    }

  private:
    double sensor_row(double y_px, double row) const override {
        return geometry_.center_px().y + (y_px - row - 0.5);
    }
    // True if it moves by less than a quarter of a pixel in the whole frame; then it is on the sensor's row
    // or beside it all the time.
    bool stays_on_line(double miss_px, Sighting& seen) const {
        seen.position_px.y = 0.5 * geometry_.height_px;
        seen.light_ratio = geometry_.padded_height();
        return std::abs(miss_px) < 0.5;
    }
    // Finds how far below the sensor's row it is [px].
    bool off_line(Vec3d dir, double distance_m, double y_px, Sighting& seen, double& miss_px) const {
        if (!project(dir, distance_m, y_px, seen)) return false;
        miss_px = seen.position_px.y - geometry_.center_px().y;
        return true;
    }
};

}  // namespace

std::unique_ptr<RayGenerator> make_pinhole_rays() { return std::make_unique<PinholeRays>(); }
std::unique_ptr<RayGenerator> make_rolling_rays(double line_time_s) {
    return std::make_unique<RollingRays>(line_time_s);
}
std::unique_ptr<RayGenerator> make_pushbroom_rays(double line_time_s) {
    return std::make_unique<PushbroomRays>(line_time_s);
}

}  // namespace hilcam
