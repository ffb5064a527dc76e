#include "io/vizard/vizard_message.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <limits>

#include "io/vizard/vizard_geometry.h"
#include "render/vocabulary/units.h"
#include "tests/support/near.h"
#include "tests/support/vizard_wire.h"

namespace hilcam {
namespace {

using testing::HasSubstr;
using vizard_wire::Message;

// The matrix [BN] of MRPs by its own formula, Schaub & Junkins (2018), eq. (3.147):
// [BN] = 1 + (8 [s~]^2 - 4 (1 - s^2) [s~]) / (1 + s^2)^2.
Mat3d dcm_of_mrp(Vec3d s) {
    const double s2 = dot(s, s), scale = 1 / ((1 + s2) * (1 + s2));
    const auto column = [&](Vec3d e) {
        const Vec3d once = cross(s, e);
        return e + scale * (8.0 * cross(s, once) - 4 * (1 - s2) * once);
    };
    return transposed(Mat3d{column({1, 0, 0}), column({0, 1, 0}), column({0, 0, 1})});
}

// --- rotations

TEST(VizardGeometry, AnMrpIsTheTransposedMatrixOfItsDefinition) {
    for (const Vec3d s : {Vec3d{}, Vec3d{0.1, -0.2, 0.3}, Vec3d{0, 0.9, 0}, Vec3d{-2, 1, 0.5}}) {
        const Mat3d found = to_matrix(from_mrp(s)), expected = transposed(dcm_of_mrp(s));
        expect_near(found.x, expected.x, 1e-14);
        expect_near(found.y, expected.y, 1e-14);
        expect_near(found.z, expected.z, 1e-14);
    }
}

TEST(VizardGeometry, AQuarterTurnAboutZTakesTheBodysXToTheFramesY) {
    const Quat n_from_b = from_mrp({0, 0, std::tan(90 * kDegree_rad / 4)});
    expect_near(to_matrix(n_from_b) * Vec3d{1, 0, 0}, {0, 1, 0}, 1e-15);
}

TEST(VizardGeometry, TheShadowSetIsTheSameAttitude) {
    const Vec3d s{0.2, -0.3, 0.6};
    const Quat q = from_mrp(s), shadow = from_mrp(s / -dot(s, s));
    EXPECT_NEAR(std::abs(q.w * shadow.w + q.x * shadow.x + q.y * shadow.y + q.z * shadow.z), 1, 1e-15);
}

// Basilisk: "z point, x horizontal, y vertical (down)" against Vizard's "-x pointing camera, with z vertical
// on the sensor, and y horizontal".
TEST(VizardGeometry, TheCamerasAxesAreVizardsChangedOver) {
    const Mat3d b_from_u = to_matrix(from_mrp({0.3, -0.1, 0.2}));
    const Mat3d b_from_c = to_matrix(body_from_camera({0.3, -0.1, 0.2}));
    expect_near(b_from_c * Vec3d{0, 0, 1}, b_from_u * Vec3d{-1, 0, 0}, 1e-15);  // boresight
    expect_near(b_from_c * Vec3d{1, 0, 0}, b_from_u * Vec3d{0, 1, 0}, 1e-15);   // right
    expect_near(b_from_c * Vec3d{0, 1, 0}, b_from_u * Vec3d{0, 0, -1}, 1e-15);  // down
}

// What the script has set comes back: [UB] = [UC] [CB], as vizInterface makes it.
TEST(VizardGeometry, TheScriptsOwnRotationComesBack) {
    const Vec3d sigma_cb{-0.1, 0.4, 0.25};
    const Mat3d ub = dcm_of_mrp({1. / 3, 1. / 3, -1. / 3}) * dcm_of_mrp(sigma_cb);
    const Quat b_from_u = from_dcm(ub);
    const double scale = 1 / (1 + b_from_u.w);
    const Quat found = body_from_camera({b_from_u.x * scale, b_from_u.y * scale, b_from_u.z * scale});
    const Mat3d expected = transposed(dcm_of_mrp(sigma_cb));
    expect_near(to_matrix(found).x, expected.x, 1e-14);
    expect_near(to_matrix(found).y, expected.y, 1e-14);
    expect_near(to_matrix(found).z, expected.z, 1e-14);
}

TEST(VizardGeometry, AnglesAreRightDownToSmallOnes) {
    EXPECT_NEAR(angle_between_rad(Vec3d{2, 0, 0}, Vec3d{3, 3e-9, 0}), 1e-9, 1e-18);
    EXPECT_DOUBLE_EQ(angle_between_rad(Vec3d{1, 0, 0}, Vec3d{-4, 0, 0}), kPi);
    const Mat3d turned = to_matrix(from_rotation_vector({0, 1e-4, 0}));
    EXPECT_NEAR(turn_between_rad(turned, Mat3d{}), 1e-4, 1e-12);
}

// --- messages

Message full() {
    Message m;
    m.message(1, vizard_wire::time_stamp(17, 2.5e9));
    m.message(2, Message()
                     .text(1, "earth")
                     .numbers(2, {1, 2, 3})
                     .numbers(3, {4, 5, 6})
                     .numbers(4, {0, 1, 0, -1, 0, 0, 0, 0, 1}));
    m.message(3, vizard_wire::spacecraft("bskSat", {7e6, 0, 0}, {0, 7500, 0}, {0, 0, std::sqrt(2.0) - 1})
                     .text(13, "model")
                     .message(5, Message().number(5, 3)));
    m.message(4, vizard_wire::camera(3, "bskSat", {0, 0.2, 2.2}, vizard_wire::kAsTheSpacecraft)
                     .number(3, 55)
                     .integers(4, {512, 256})
                     .integer(5, 1)
                     .text(10, "black")
                     .integer(11, -1));
    m.message(7, Message().number(1, 0.5));
    m.message(8, vizard_wire::epoch());
    return m;
}

std::string refusal_of(const Message& m) { return decode_vizard_update(m.span()).refusal; }

TEST(VizardMessage, ItsPartsAreReadInOurTerms) {
    const auto [u, refusal] = decode_vizard_update(full().span());
    ASSERT_EQ(refusal, "");
    EXPECT_EQ(u.frame_number, 17);
    EXPECT_EQ(u.elapsed_ns, 2'500'000'000);
    ASSERT_TRUE(u.epoch);
    EXPECT_EQ(*u.epoch, parse_utc("2026-03-20T14:00:00.5Z"));
    EXPECT_FALSE(u.is_last);
    ASSERT_EQ(u.bodies.size(), 1u);
    EXPECT_EQ(u.bodies[0].name, "earth");
    expect_near(u.bodies[0].velocity_n_m_s, {4, 5, 6}, 0);
    // The matrix takes N's y to the body's x.
    expect_near(to_matrix(*u.bodies[0].n_from_body) * Vec3d{1, 0, 0}, {0, 1, 0}, 1e-15);
    ASSERT_EQ(u.spacecraft.size(), 1u);
    EXPECT_EQ(u.spacecraft[0].name, "bskSat");
    expect_near(u.spacecraft[0].position_n_m, {7e6, 0, 0}, 0);
    expect_near(u.spacecraft[0].velocity_n_m_s, {0, 7500, 0}, 0);
    expect_near(to_matrix(*u.spacecraft[0].n_from_body) * Vec3d{1, 0, 0}, {0, 1, 0}, 1e-15);
    ASSERT_EQ(u.cameras.size(), 1u);
    const VizardCamera& c = u.cameras[0];
    EXPECT_EQ(c.id, 3);
    EXPECT_EQ(c.parent, "bskSat");
    EXPECT_NEAR(c.field_of_view_rad, 55 * kDegree_rad, 1e-15);
    EXPECT_EQ(c.width_px, 512);
    EXPECT_EQ(c.height_px, 256);
    EXPECT_FALSE(c.wants_depth);
    expect_near(c.position_body_m, {0, 0.2, 2.2}, 0);
    expect_near(to_matrix(c.body_from_camera) * Vec3d{0, 0, 1}, {0, 0, 1}, 1e-15);
}

TEST(VizardMessage, WhatMayBeLeftOutMay) {
    Message m;
    m.message(1, vizard_wire::time_stamp(1, 0));
    m.message(2, Message().text(1, "sun").numbers(2, {1, 2, 3}).numbers(4, std::vector<double>(9, 0)));
    m.message(8, Message().integer(4, 6));  // a day of its default
    m.message(10, Message().integer(3, 1));
    const auto [u, refusal] = decode_vizard_update(m.span());
    ASSERT_EQ(refusal, "");
    EXPECT_FALSE(u.bodies[0].n_from_body);
    EXPECT_EQ(*u.epoch, parse_utc("2019-01-01T06:00:00Z"));
    EXPECT_TRUE(u.is_last);
    EXPECT_TRUE(u.cameras.empty());
}

TEST(VizardMessage, WhatCannotBeIsRefusedByName) {
    EXPECT_EQ(decode_vizard_update({}).refusal, "currentTime is missing");
    const std::uint8_t garbage[] = {0x0A, 0x7F, 1};
    EXPECT_EQ(decode_vizard_update(garbage).refusal, "is no VizMessage (3 bytes)");

    const auto with = [](unsigned field, const Message& part) {
        Message m;
        m.message(1, vizard_wire::time_stamp(1, 1e9)).message(field, part);
        return refusal_of(m);
    };
    using vizard_wire::spacecraft;
    EXPECT_EQ(with(3, spacecraft("a", {1, 2}, {}, {})),
              "spacecraft 'a': position: found 2 numbers; accepted: 3");
    EXPECT_THAT(with(3, spacecraft("a", {1, 2, std::nan("")}, {}, {})), HasSubstr("not finite"));
    EXPECT_THAT(with(3, spacecraft("a", {1e16, 0, 0}, {}, {})), HasSubstr("above 1.5e+15"));
    EXPECT_THAT(with(3, spacecraft("a", {1, 2, 3}, {4e8, 0, 0}, {})), HasSubstr("velocity"));
    EXPECT_EQ(with(3, spacecraft("a\n", {1, 2, 3}, {}, {1, 2})),
              "spacecraft 'a ': rotation: found 2 numbers; accepted: 3 (MRPs) or 9 (a matrix)");
    EXPECT_THAT(with(3, spacecraft("a", {1, 2, 3}, {}, {1, 0, 0, 0, 1, 0, 0, 0, 2})),
                HasSubstr("no rotation"));
    EXPECT_THAT(with(3, spacecraft("a", {1, 2, 3}, {}, {-1, 0, 0, 0, 1, 0, 0, 0, 1})),
                HasSubstr("no rotation"));
    EXPECT_EQ(with(4, vizard_wire::camera(5, "a", {}, {})),
              "camera 5: cameraDir_B: found 0 numbers; accepted: 3");
    EXPECT_THAT(with(4, vizard_wire::camera(5, "a", {}, {0, 0, 0}).number(3, 180)),
                HasSubstr("fieldOfView: found 180 deg"));
    EXPECT_THAT(with(8, Message().integer(2, 13)), HasSubstr("does not exist in UTC"));
    EXPECT_THAT(with(8, Message().number(6, 61)), HasSubstr("does not exist in UTC"));

    Message late;
    late.message(1, vizard_wire::time_stamp(1, std::numeric_limits<double>::infinity()));
    EXPECT_THAT(refusal_of(late), HasSubstr("simTimeElapsed: found inf ns"));
    Message early;
    early.message(1, vizard_wire::time_stamp(1, -1));
    EXPECT_THAT(refusal_of(early), HasSubstr("accepted: 0 to"));
}

// Two bytes are a whole spacecraft: what a few megabytes become must stay small, and be looked through soon.
TEST(VizardMessage, WhatIsFarTooMuchIsRefusedByItsNumber) {
    const auto many = [](unsigned field, int count) {
        Message m;
        for (int i = 0; i < count; ++i) m.text(field, "");
        return refusal_of(m);
    };
    EXPECT_EQ(many(3, 10'001), "found 10001 spacecraft; accepted: up to 10000");
    EXPECT_EQ(many(2, 10'001), "found 10001 bodies; accepted: up to 10000");
    EXPECT_EQ(many(4, 256), "found 256 cameras; accepted: up to 255");
    EXPECT_EQ(many(4, 255), "currentTime is missing");
    EXPECT_EQ(refusal_of(Message().text(9, std::string((8u << 20) - 5, 'x'))), "currentTime is missing");
    EXPECT_EQ(refusal_of(Message().text(9, std::string((8u << 20) - 4, 'x'))),
              "found 8388609 bytes; accepted: up to 8388608");
}

// Two bytes each, or one, would become a hundred, or eight.
TEST(VizardMessage, WhatIsFarTooMuchTakesNoMemory) {
    const auto peak_kib = [] {
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
        return usage.ru_maxrss;
    };
    std::string crowd;
    for (int i = 0; i < 4'000'000; ++i) crowd.append("\x1a\0", 2);  // field 3, empty
    const Message pixels =
        Message().message(4, Message().text(4, std::string((8u << 20) - 100, '\1')));  // packed varints
    const long before_kib = peak_kib();
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(crowd.data());
    EXPECT_EQ(decode_vizard_update({bytes, crowd.size()}).refusal,
              "found 4000000 spacecraft; accepted: up to 10000");
    EXPECT_EQ(refusal_of(pixels), "found 8388508 bytes of resolutions; accepted: up to 1000");
    EXPECT_LT(peak_kib() - before_kib, 50'000);  // 433 000 and 65 000 if both were built
}

TEST(VizardMessage, TheInputSaysWhichMessageItAnswers) {
    EXPECT_EQ(encode_vizard_input(300), Message().integer(1, 300).bytes());
}

}  // namespace
}  // namespace hilcam
