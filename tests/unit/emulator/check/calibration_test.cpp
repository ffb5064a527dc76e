// `hilcam check --calibration`: what is written, read again by the words of each format, says where points
// appear; as OpenCV has it and as this program's own projection has it.

#include "emulator/check/calibration.h"

#include <gmock/gmock.h>

#include <regex>

#include "render/vocabulary/check.h"
#include "sensor/published_frame.h"

namespace hilcam {
namespace {

using testing::HasSubstr;
using testing::Not;

std::vector<double> numbers_of(const std::string& list) {
    std::vector<double> out;
    const std::regex number("[-+0-9.e]+");
    for (auto it = std::sregex_iterator(list.begin(), list.end(), number); it != std::sregex_iterator(); ++it)
        out.push_back(std::stod(it->str()));
    return out;
}
// The list behind the n-th place where `key` stands, whatever is written between.
std::vector<double> list_at(const std::string& text, const std::string& key, int n = 0) {
    std::size_t at = text.find(key);
    for (; n > 0; --n) at = text.find(key, at + 1);
    EXPECT_NE(at, std::string::npos) << key;
    const std::size_t begin = text.find('[', at), end = text.find(']', begin);
    return numbers_of(text.substr(begin, end - begin));
}

CameraModel camera() {
    CameraModel c;
    c.name = "left eye";
    c.width_px = 1024, c.height_px = 768;
    c.pitch_m = 5.5e-6, c.focal_length_m = 0.00825;
    return c;
}
// Coefficients stand in the order of OpenCV: k1, k2, p1, p2, k3, or k1 to k4 of a fisheye.
CameraModel with_lens(const std::vector<double>& distortion) {
    CameraModel c = camera();
    c.distortion = distortion;
    c.principal_point_px = {524.25, 376.5};
    return c;
}

// Brown's model with K and D, as a program that reads them has it.
Vec2d as_opencv(Vec3d p, const std::vector<double>& k, const std::vector<double>& d) {
    const double x = p.x / p.z, y = p.y / p.z, r2 = x * x + y * y;
    const double radial = 1 + r2 * (d[0] + r2 * (d[1] + r2 * (d.size() > 4 ? d[4] : 0)));
    return {k[0] * (x * radial + 2 * d[2] * x * y + d[3] * (r2 + 2 * x * x)) + k[2],
            k[4] * (y * radial + d[2] * (r2 + 2 * y * y) + 2 * d[3] * x * y) + k[5]};
}

const std::vector<Vec3d> kPoints_camera_m = {{0, 0, 5}, {1, 0.5, 4}, {-0.8, 0.6, 3}, {0.3, -1, 6}};

TEST(Calibration, PointsAppearWhereTheCameraHasThemButForHalfAPixel) {
    CameraModel model = with_lens({-0.12, 0.03, 0.0007, -0.0004, -0.004});
    model.black_columns = 16, model.black_rows = 4;
    for (const CalibrationFormat format : {CalibrationFormat::kOpencv, CalibrationFormat::kRos}) {
        const std::string text = calibration_text(std::array{calibration_of(model)}, format);
        const auto k = list_at(text, "camera_matrix"), d = list_at(text, "distortion_coefficients");
        ASSERT_EQ(k.size(), 9u);
        ASSERT_EQ(d.size(), 5u);
        const FrameRaster raster = raster_of(model, 1, {});
        for (const Vec3d p : kPoints_camera_m) {
            const Vec2d own = raster.frame_px(geometry_of(model, 0).project_px(p)),
                        theirs = as_opencv(p, k, d);
            EXPECT_NEAR(theirs.x, own.x - 0.5, 1e-6);
            EXPECT_NEAR(theirs.y, own.y - 0.5, 1e-6);
        }
        EXPECT_THAT(text, HasSubstr("image_width: 1040\n"));
        EXPECT_THAT(text, HasSubstr("image_height: 772\n"));
    }
}

// Binned by two, the middle of the first pixel lies a whole pixel of the detector from the corner.
TEST(Calibration, BinnedFramesHaveTheirOwnPixels) {
    CameraModel model = camera();
    model.binning_x = model.binning_y = 2;
    const CameraCalibration c = calibration_of(model);
    EXPECT_EQ(c.width_px, 512);
    EXPECT_NEAR(c.focal_length_px.x, 750, 1e-9);
    EXPECT_NEAR(c.principal_point_px.x, 256 - 0.5, 1e-9);
    EXPECT_NEAR(c.principal_point_px.y, 192 - 0.5, 1e-9);
}

// The same points by OpenCV 4.6: cv2.projectPoints(P, 0, 0, K, D), and cv2.fisheye.projectPoints, with K of
// 1500 px and (523.75, 376), D of the lenses here.
TEST(Calibration, PointsAppearWhereOpenCvHasThem) {
    const auto expect = [](const CameraModel& model, const std::vector<Vec2d>& opencv_px) {
        const std::string text =
            calibration_text(std::array{calibration_of(model)}, CalibrationFormat::kOpencv);
        EXPECT_THAT(list_at(text, "camera_matrix"),
                    testing::Pointwise(testing::DoubleNear(1e-9),
                                       std::vector<double>{1500, 0, 523.75, 0, 1500, 376, 0, 0, 1}));
        const auto d = list_at(text, "distortion_coefficients");
        ASSERT_EQ(d, model.distortion);
        const ImageGeometry geometry = geometry_of(model, 0);
        for (std::size_t i = 0; i < opencv_px.size(); ++i) {
            const Vec2d own = geometry.project_px(kPoints_camera_m[i]);
            EXPECT_NEAR(own.x - 0.5, opencv_px[i].x, 1e-6);
            EXPECT_NEAR(own.y - 0.5, opencv_px[i].y, 1e-6);
        }
    };
    expect(with_lens({-0.12, 0.03, 0.0007, -0.0004, -0.004}), {{523.75, 376.0},
                                                               {895.246074295044, 561.8535058975219},
                                                               {128.67337997256516, 672.3741316872429},
                                                               {598.4408876798547, 127.00161051159549}});
    CameraModel fisheye = with_lens({-0.02, 0.003, -0.0005, 0.0001});
    fisheye.projection = Projection::kFisheye;
    expect(fisheye, {{523.75, 376.0},
                     {888.8807591522966, 558.5653795761483},
                     {138.4365400576312, 664.9850949567766},
                     {597.9626320811456, 128.62455972951486}});
}

CameraConfig mounted(Vec3d position_m, Quat thing_from_camera) {
    CameraConfig out;
    out.camera = camera();
    out.camera.name = "right \"eye\"";
    out.position_m = position_m;
    out.attitude.wxyz = thing_from_camera;
    out.attitude.has_wxyz = true;
    return out;
}

TEST(Calibration, SeveralCamerasStandWhereTheirMountsSay) {
    ScenarioConfig s;
    s.camera = camera();
    // 0.2 m to the right, turned left by 10 degrees.
    const CameraConfig right = mounted({0.2, 0, 0}, from_rotation_vector({0, -0.17453292519943295, 0}));
    const CameraConfig third = mounted({0.1, 0.3, 0.05}, from_rotation_vector({0.1, 0.2, -0.3}));
    s.more_cameras = {right, third};
    const auto cameras = calibrations_of(s, 0);
    ASSERT_EQ(cameras.size(), 3u);
    // A point of the first camera's axes, told in each one's own by hand and by what is written.
    const Vec3d p{0.4, -0.2, 3};
    const auto own = [&](const CameraConfig& c) {
        return to_matrix(conjugate(c.attitude.wxyz)) * (p - c.position_m);
    };
    const std::string opencv = calibration_text(cameras, CalibrationFormat::kOpencv);
    const std::string kalibr = calibration_text(cameras, CalibrationFormat::kKalibr);
    Vec3d chained = p;
    for (int i = 1; i < 3; ++i) {
        const Vec3d wanted = own(i == 1 ? right : third);
        const auto r = list_at(opencv, "   R:", i), t = list_at(opencv, "   T:", i);
        const Mat3d rotation{{r[0], r[1], r[2]}, {r[3], r[4], r[5]}, {r[6], r[7], r[8]}};
        EXPECT_LT(length(rotation * p + Vec3d{t[0], t[1], t[2]} - wanted), 1e-12);
        const std::string block = kalibr.substr(kalibr.find("cam" + std::to_string(i) + ":"));
        const std::size_t rows = block.find("T_cn_cnm1");
        const std::string matrix = block.substr(rows, block.find("[0.0, 0.0, 0.0, 1.0]") - rows);
        std::vector<double> m;
        for (int row = 0; row < 3; ++row)
            for (const double value : list_at(matrix, "  - ", row)) m.push_back(value);
        chained = {m[0] * chained.x + m[1] * chained.y + m[2] * chained.z + m[3],
                   m[4] * chained.x + m[5] * chained.y + m[6] * chained.z + m[7],
                   m[8] * chained.x + m[9] * chained.y + m[10] * chained.z + m[11]};
        EXPECT_LT(length(chained - wanted), 1e-12);
    }
    EXPECT_THAT(opencv, HasSubstr("camera_name: \"right \\\"eye\\\"\""));
    EXPECT_THAT(kalibr, HasSubstr("rostopic: /cam2/image_raw"));
    EXPECT_THAT(calibration_text(calibrations_of(s, 2), CalibrationFormat::kRos),
                HasSubstr("camera_name: right__eye_\n"));
    // One of them alone is where its own axes are.
    EXPECT_THAT(calibration_text(calibrations_of(s, 2), CalibrationFormat::kKalibr), Not(HasSubstr("T_cn")));
}

std::string refusal_of(const ScenarioConfig& s, CalibrationFormat format) {
    try {
        calibration_text(calibrations_of(s, 0), format);
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Calibration, WhatAFormatHasNoPlaceForIsRefused) {
    ScenarioConfig s;
    s.camera = with_lens({0, 0, 0, 0, 0.01});
    EXPECT_EQ(refusal_of(s, CalibrationFormat::kOpencv), "accepted");
    EXPECT_THAT(refusal_of(s, CalibrationFormat::kKalibr), HasSubstr("camera 1 has distortion.k3 0.01"));
    s.camera.distortion = {0.01, 0, 0, 0};
    s.camera.projection = Projection::kFisheye;
    EXPECT_EQ(refusal_of(s, CalibrationFormat::kKalibr), "accepted");
    s.more_cameras.push_back(mounted({}, {}));
    EXPECT_THAT(refusal_of(s, CalibrationFormat::kRos), HasSubstr("found 2; give --camera N"));
    s.more_cameras.back().thing = 1;
    EXPECT_THAT(refusal_of(s, CalibrationFormat::kOpencv),
                HasSubstr("camera 2 is not on the body of camera 1"));
    s.more_cameras.clear();
    s.camera.projection = Projection::kRectilinear, s.camera.distortion_x_mm = {0.1};
    EXPECT_THAT(refusal_of(s, CalibrationFormat::kOpencv),
                HasSubstr("camera has distortion_x_mm, distortion_y_mm, and no format"));
    s.camera.shutter.kind = ShutterKind::kLineScan;
    EXPECT_THAT(refusal_of(s, CalibrationFormat::kOpencv), HasSubstr("no pinhole"));
}

}  // namespace
}  // namespace hilcam
