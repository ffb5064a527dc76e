#include "emulator/check/calibration.h"

#include <spdlog/fmt/fmt.h>

#include "render/vocabulary/check.h"
#include "sensor/published_frame.h"

namespace hilcam {
namespace {

constexpr double kFirstPixel_px = 0.5;  // its middle, as this program counts

std::string list(std::span<const double> numbers) { return fmt::format("[{}]", fmt::join(numbers, ", ")); }

bool is_fisheye(const CameraCalibration& c) { return c.distortion.projection == Projection::kFisheye; }

// Coefficients are in OpenCV's order.
std::vector<double> coefficients(const CameraCalibration& c) {
    const LensDistortion& d = c.distortion;
    if (is_fisheye(c)) return {d.k1, d.k2, d.k3, d.k4};
    return {d.k1, d.k2, d.p1, d.p2, d.k3};
}

std::array<double, 9> camera_matrix(const CameraCalibration& c) {
    return {c.focal_length_px.x,
            0,
            c.principal_point_px.x,
            0,
            c.focal_length_px.y,
            c.principal_point_px.y,
            0,
            0,
            1};
}

std::array<double, 9> rows_of(const Mat3d& m) {
    return {m.x.x, m.x.y, m.x.z, m.y.x, m.y.y, m.y.z, m.z.x, m.z.y, m.z.z};
}

// Puts a text in double quotes by the rules of YAML and JSON; names may be any text.
std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return out + "\"";
}

// Returns a name that ROS accepts: letters, digits, underscores.
std::string plain_name(const CameraCalibration& c) {
    std::string out;
    for (const char ch : c.name) {
        const bool plain = (ch >= 'a' && ch <= 'z') || (ch >= 'A' && ch <= 'Z') || (ch >= '0' && ch <= '9');
        out += plain ? ch : '_';
    }
    return out.empty() ? fmt::format("camera{}", c.number) : out;
}

// --- OpenCV

std::string opencv_matrix(const std::string& indent, const std::string& key, int rows,
                          std::span<const double> numbers) {
    return fmt::format(
        "{0}{1}: !!opencv-matrix\n{0}   rows: {2}\n{0}   cols: {3}\n{0}   dt: d\n{0}   data: {4}\n", indent,
        key, rows, numbers.size() / static_cast<std::size_t>(rows), list(numbers));
}

std::string opencv_camera(const CameraCalibration& c, const std::string& indent) {
    std::string out = fmt::format("{0}camera_name: {1}\n{0}image_width: {2}\n{0}image_height: {3}\n", indent,
                                  quoted(c.name), c.width_px, c.height_px);
    out += opencv_matrix(indent, "camera_matrix", 3, camera_matrix(c));
    out += fmt::format("{}fisheye_model: {}\n", indent, is_fisheye(c) ? 1 : 0);
    const std::vector<double> d = coefficients(c);
    return out + opencv_matrix(indent, "distortion_coefficients", static_cast<int>(d.size()), d);
}

// Writes one camera as OpenCV's samples do. With several cameras, each has its own map, with R and T as from
// stereoCalibrate().
std::string opencv_text(std::span<const CameraCalibration> cameras) {
    std::string out = "%YAML:1.0\n---\n";
    if (cameras.size() == 1) return out + opencv_camera(cameras.front(), "");
    out += fmt::format("nr_of_cameras: {}\n", cameras.size());
    for (const CameraCalibration& c : cameras) {
        out += fmt::format("camera_{}:\n", c.number) + opencv_camera(c, "   ");
        const Vec3d t = c.translation_m;
        out += opencv_matrix("   ", "R", 3, rows_of(c.own_from_first));
        out += opencv_matrix("   ", "T", 3, std::array{t.x, t.y, t.z});
    }
    return out;
}

// --- ROS

std::string ros_matrix(const char* key, int rows, std::span<const double> numbers) {
    return fmt::format("{}:\n  rows: {}\n  cols: {}\n  data: {}\n", key, rows,
                       numbers.size() / static_cast<std::size_t>(rows), list(numbers));
}

// Writes sensor_msgs/CameraInfo: K for the raw picture, R and P for a rectified one, which is the camera's
// own picture.
std::string ros_text(std::span<const CameraCalibration> cameras) {
    if (cameras.size() > 1)
        throw InputError(fmt::format(
            "--calibration ros: a CameraInfo is of one camera, found {}; give --camera N", cameras.size()));
    const CameraCalibration& c = cameras.front();
    const std::vector<double> d = coefficients(c);
    const Vec2d f = c.focal_length_px, p = c.principal_point_px;
    return fmt::format("image_width: {}\nimage_height: {}\ncamera_name: {}\n", c.width_px, c.height_px,
                       plain_name(c)) +
           ros_matrix("camera_matrix", 3, camera_matrix(c)) +
           fmt::format("distortion_model: {}\n", is_fisheye(c) ? "equidistant" : "plumb_bob") +
           ros_matrix("distortion_coefficients", 1, d) +
           ros_matrix("rectification_matrix", 3, rows_of(Mat3d{})) +
           ros_matrix("projection_matrix", 3,
                      std::array{f.x, 0.0, p.x, 0.0, 0.0, f.y, p.y, 0.0, 0.0, 0.0, 1.0, 0.0});
}

// --- Kalibr

std::string kalibr_text(std::span<const CameraCalibration> cameras) {
    std::string out;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        const CameraCalibration& c = cameras[i];
        const LensDistortion& d = c.distortion;
        if (!is_fisheye(c) && d.k3 != 0)
            throw InputError(
                fmt::format("--calibration kalibr: camera {} has distortion.k3 {:g}, and Kalibr's radtan "
                            "model has k1, k2, p1, p2 "
                            "alone; accepted: k3 of 0, a fisheye, or another format",
                            c.number, d.k3));
        out += fmt::format("cam{}:\n  camera_model: pinhole\n", i);
        out += fmt::format("  intrinsics: {}\n",
                           list(std::array{c.focal_length_px.x, c.focal_length_px.y, c.principal_point_px.x,
                                           c.principal_point_px.y}));
        out += fmt::format("  distortion_model: {}\n  distortion_coeffs: {}\n",
                           is_fisheye(c) ? "equi" : "radtan",
                           is_fisheye(c) ? list(std::array{d.k1, d.k2, d.k3, d.k4})
                                         : list(std::array{d.k1, d.k2, d.p1, d.p2}));
        out +=
            fmt::format("  resolution: [{}, {}]\n  rostopic: /cam{}/image_raw\n", c.width_px, c.height_px, i);
        if (i == 0) continue;
        // Relative to the previous camera.
        const CameraCalibration& before = cameras[i - 1];
        const Mat3d r = c.own_from_first * transposed(before.own_from_first);
        const Vec3d t = c.translation_m - r * before.translation_m;
        out += "  T_cn_cnm1:\n";
        for (const auto& [row, along] : {std::pair{r.x, t.x}, {r.y, t.y}, {r.z, t.z}})
            out += fmt::format("  - {}\n", list(std::array{row.x, row.y, row.z, along}));
        out += "  - [0.0, 0.0, 0.0, 1.0]\n";
    }
    return out;
}

}  // namespace

CameraCalibration calibration_of(const CameraModel& camera) {
    if (camera.shutter.kind == ShutterKind::kLineScan)
        throw InputError(
            "--calibration: camera.shutter.kind is line_scan, with one line of sight for all rows at "
            "different times, which is no pinhole camera; accepted: global, rolling, frame_transfer");
    const ImageGeometry geometry = geometry_of(camera, 0);
    if (!geometry.distortion.polynomial.none())
        throw InputError(
            "--calibration: camera has distortion_x_mm, distortion_y_mm, and no format has such a "
            "polynomial; accepted: camera.distortion");
    const FrameLayout layout{camera.binning_x, camera.binning_y};
    const FrameRaster raster = raster_of(camera, 1, layout);
    const FrameIntrinsics lens = intrinsics_of(geometry, raster);
    CameraCalibration c;
    c.name = camera.name;
    c.width_px = raster.width_px, c.height_px = raster.height_px;
    c.focal_length_px = lens.focal_length_px;
    c.principal_point_px = {lens.principal_point_px.x - kFirstPixel_px,
                            lens.principal_point_px.y - kFirstPixel_px};
    c.distortion = geometry.distortion;
    return c;
}

std::vector<CameraCalibration> calibrations_of(const ScenarioConfig& scenario, std::size_t camera) {
    std::vector<CameraCalibration> out;
    Mount first;
    std::size_t first_number = 0;
    for (std::size_t i = 0; i <= scenario.more_cameras.size(); ++i) {
        if (camera != 0 && camera != i + 1) continue;
        const ScenarioConfig own = scenario_of_camera(scenario, i);
        out.push_back(calibration_of(own.camera));
        CameraCalibration& c = out.back();
        c.number = i + 1;
        if (out.size() == 1) first = own.mount, first_number = c.number;
        if (own.mount.thing != first.thing)
            throw InputError(
                fmt::format("--calibration: camera {} is not on the body of camera {}, so their relative "
                            "pose is not fixed; give --camera N",
                            c.number, first_number));
        const Quat own_from_thing = conjugate(own.mount.thing_from_camera);
        c.own_from_first = to_matrix(own_from_thing * first.thing_from_camera);
        c.translation_m = to_matrix(own_from_thing) * (first.position_m - own.mount.position_m);
    }
    return out;
}

std::string calibration_text(std::span<const CameraCalibration> cameras, CalibrationFormat format) {
    HILCAM_CHECK(!cameras.empty());
    switch (format) {
        case CalibrationFormat::kOpencv:
            return opencv_text(cameras);
        case CalibrationFormat::kRos:
            return ros_text(cameras);
        case CalibrationFormat::kKalibr:
            return kalibr_text(cameras);
        case CalibrationFormat::kNone:
            break;
    }
    return {};
}

}  // namespace hilcam
