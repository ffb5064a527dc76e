// Where hilcam's cameras have points of the ground, against what programs for flight pictures publish of their
// own tests: ISIS (DOI-USGS/ISIS3, isis/tests) and USGSCSM (DOI-USGS/usgscsm, tests), both of the USGS. Numbers
// are theirs. An image line and sample of ISIS count from 1 at the middle of the first pixel, those of USGSCSM
// from 0 at its corner, as hilcam's do.

#include <gtest/gtest.h>

#include <array>

#include "render/shading/ray_generators.h"
#include "tests/flight/published_view.h"

namespace hilcam {
namespace {

// MSI on NEAR above Eros, 26 January 2001 (NearMsiCameraTests.cpp, m0155881376f3_2p_cif_dbl.isd): 166.85 mm,
// 16 um, ideal radius r (1 - 7e-5 r^2 / mm^2).
TEST(PublishedCameras, MsiOnNearSeesErosWhereIsisHasIt) {
    constexpr double kFocal_mm = 166.85, kDistortion_mm2 = 7e-5;
    const double c = kDistortion_mm2 * kFocal_mm * kFocal_mm;
    PublishedView view;
    view.geometry = pinhole(537, 412, kFocal_mm / 0.016);
    // The inverse of r = d (1 - c d^2) is d = r (1 + c r^2 + 3 c^2 r^4 + 12 c^3 r^6 ...).
    view.geometry.distortion.k1 = c, view.geometry.distortion.k2 = 3 * c * c;
    view.geometry.distortion.k3 = 12 * c * c * c;
    const Quat spacecraft_from_icrf{0.4067628513123036, 0.36275898951462027, 0.6813844203789747,
                                    -0.4885336938056834};
    // The camera's z is the boresight, x along the samples, y against the lines.
    const Mat3d camera_from_spacecraft{{-0.0014422521585623685, 6.978195915906097e-07, 0.9999989599535716},
                                       {-0.0004838401563600235, -0.9999998829493452, 0.0},
                                       {0.9999988429030381, -0.00048383965314379677, 0.0014422523273789842}};
    view.camera = {{6386.099720457885, -24379.88503831003, -4779.388235790449},
                   from_dcm(camera_from_spacecraft * to_matrix(spacecraft_from_icrf))};
    view.icrf_from_body =
        conjugate(Quat{0.4306097227534315, 0.5539156453082017, -0.21250109257371436, 0.6801441098825962});
    struct Seen {
        double sample, line, latitude_deg, longitude_deg;
    };
    constexpr std::array<Seen, 5> kSeen{{{34, 34, -17.686235689292037, 36.717548917904146},
                                         {504, 34, -25.741437596768307, 34.216663871981211},
                                         {504, 379, -29.649628167745398, 38.194196619380435},
                                         {34, 379, -20.18045520120209, 40.577715588340105},
                                         {268.5, 206, -22.852443468381061, 37.504660702426833}}};
    for (const Seen& seen : kSeen) {
        const Vec2d place =
            view.place_px(on_ellipsoid({17000, 5500, 5500}, seen.latitude_deg, seen.longitude_deg));
        EXPECT_NEAR(place.x, seen.sample - 0.5, kTarget_px) << seen.sample << ' ' << seen.line;
        EXPECT_NEAR(place.y, 412 - (seen.line - 0.5), kTarget_px) << seen.sample << ' ' << seen.line;
    }
}

// simpleFramerISD.json and FrameCameraTests.cpp: 50 mm, 10 px/mm, 990 m above a ball of 10 m.
TEST(PublishedCameras, AFramerSeesThePointsOfUsgscsm) {
    PublishedView view;
    view.geometry = pinhole(15, 15, 500);
    view.camera = {{1000, 0, 0}, conjugate(Quat{0.0, -0.707106781186547, 0.0, 0.707106781186547})};
    struct Seen {
        double line, sample;
        Vec3d ground;
    };
    const std::array<Seen, 6> seen{{{7.5, 7.5, {10.0, 0, 0}},
                                    {7.5, 6.5, {9.80194018, 0, 1.98039612}},
                                    {15.0, 0.0, {0.44979759, -14.99325304, 14.99325304}},
                                    {0.0, 15.0, {0.44979759, 14.99325304, -14.99325304}},
                                    {0.0, 0.0, {0.44979759, 14.99325304, 14.99325304}},
                                    {15.0, 15.0, {0.44979759, -14.99325304, -14.99325304}}}};
    for (const Seen& s : seen) {
        const Vec2d place = view.place_px(s.ground);
        EXPECT_NEAR(place.x, s.sample, 1e-6) << s.line << ' ' << s.sample;
        EXPECT_NEAR(place.y, s.line, 1e-6) << s.line << ' ' << s.sample;
    }
}

// constVelocityLineScan.json and LineScanCameraTests.cpp: 50 mm, 10 px/mm, 20 m/s at 1 km, a line in 0.1 s. Line
// 8 is at -0.05 s, and the line of pixels half a pixel beside the boresight, which is a tilt here.
TEST(PublishedCameras, ALineScannerSeesThePointsOfUsgscsm) {
    const auto rays = make_pushbroom_rays(0.1);
    const Vec3d forward = normalized(Vec3d{0.5 / 500, 0, 1});
    const Motion motion{{}, {{-1, 0, -1000}, look_along(forward, {-1, 0, 0})}, {20, 0, 0}, {}};
    rays->place(pinhole(16, 16, 500), motion);
    struct Seen {
        double line, sample;
        Vec3d ground_body;
    };
    const std::array<Seen, 2> seen{{{8, 8, {9.99999500000, 0.0, 0.00999999500}},
                                    {0, 4, {0.04799688020, -7.99961602495, 16.00004799688}}}};
    for (const Seen& s : seen) {
        // body_rotation: x to -z, y to -y, z to -x.
        const Vec3d to_ground =
            Vec3d{-s.ground_body.z, -s.ground_body.y, -s.ground_body.x} - motion.pose.position_world_m;
        Sighting sighting;
        ASSERT_TRUE(rays->find(normalized(to_ground), length(to_ground), sighting));
        EXPECT_NEAR(sighting.position_px.x, s.sample, kTarget_px);
        EXPECT_NEAR(sighting.position_px.y, s.line, kTarget_px);
    }
}

// DistortionTests.cpp, RadTan: 1000 mm, (5, 6) mm.
TEST(PublishedCameras, BrownsTermsAreThoseOfUsgscsm) {
    LensDistortion lens;
    lens.k1 = 0.000031, lens.k2 = -0.000056, lens.p1 = 1.3e-5, lens.p2 = -1.7e-6, lens.k3 = 2.9e-8;
    const Vec2d place = lens.distorted({5.0 / 1000, 6.0 / 1000});
    EXPECT_NEAR(1000 * place.x, 5.0000006007539586, 1e-8);
    EXPECT_NEAR(1000 * place.y, 6.0000016383447505, 1e-8);
}

// DistortionTests.cpp, DawnFc: 8.4e-6 / mm^2, (10, 10) mm; the Framing Camera's 150.07 mm.
TEST(PublishedCameras, DawnsFramingCameraDistortsAsInUsgscsm) {
    constexpr double kFocal_mm = 150.07;
    LensDistortion lens;
    lens.k1 = 8.4e-6 * kFocal_mm * kFocal_mm;
    const Vec2d place = lens.distorted({10 / kFocal_mm, 10 / kFocal_mm});
    EXPECT_NEAR(kFocal_mm * place.x, 10.0168, 1e-9);
    EXPECT_NEAR(kFocal_mm * place.y, 10.0168, 1e-9);
}

// DistortionTests.cpp, LroLrocNac: the camera's line of pixels, ideal place y / (1 + 1.81e-5 y^2 / mm^2); its 7 um.
TEST(PublishedCameras, LrocsNarrowAngleCameraDistortsAsInUsgscsm) {
    constexpr double kFocal_mm = 1000, kPitch_mm = 0.007;
    const double c = 1.81e-5 * kFocal_mm * kFocal_mm;
    LensDistortion lens;
    lens.k1 = c, lens.k2 = 2 * c * c, lens.k3 = 5 * c * c * c;  // the inverse, as a series
    const Vec2d place = lens.distorted({0, 17.6237922244 / kFocal_mm});
    EXPECT_NEAR(kFocal_mm * place.y / kPitch_mm, 17.724 / kPitch_mm, kTarget_px);
}

}  // namespace
}  // namespace hilcam
