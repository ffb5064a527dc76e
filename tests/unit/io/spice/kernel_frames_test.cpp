#include "io/spice/kernel_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/spice/text_kernel.h"
#include "render/sky/bodies.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"
#include "tests/support/spice_writer.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

constexpr const char* kFrames =
    "\\begindata\nFRAME_SHIP = -99000\nFRAME_-99000_NAME = 'SHIP'\nFRAME_-99000_CLASS = "
    "3\nFRAME_-99000_CLASS_ID = -99000\n"
    "FRAME_-99000_CENTER = -99\nCK_-99000_SCLK = -99\nSCLK01_MODULI_99 = ( 10000000 10 "
    ")\nSCLK01_COEFFICIENTS_99 = ( 0 0 1 )\n"
    "FRAME_CAM = -99100\nFRAME_-99100_NAME = 'CAM'\nFRAME_-99100_CLASS = 4\nFRAME_-99100_CLASS_ID = -99100\n"
    "TKFRAME_-99100_RELATIVE = 'SHIP'\nTKFRAME_-99100_SPEC = 'ANGLES'\nTKFRAME_-99100_ANGLES = ( 90 0 0 "
    ")\nTKFRAME_-99100_AXES = ( 1 2 3 )\n"
    "TKFRAME_-99100_UNITS = 'DEGREES'\n";

// A set of kernels with one CK (10 ticks a second), from memory.
std::unique_ptr<KernelSet> set_with(const WrittenArray& array, const char* kind = "CK",
                                    const char* text = kFrames) {
    auto set = std::make_unique<KernelSet>();
    read_text_kernel(text, "t.tf", set->pool);
    set->binaries.push_back(std::make_unique<DafFile>(SpiceWriter(kind).add(array).bytes(), "test.bc"));
    return set;
}
WrittenArray segment(int type, bool rates, std::vector<double> words, double start = 0, double stop = 1000) {
    return {"TEST", start, stop, {-99000, 1, type, rates ? 1 : 0}, std::move(words)};
}

// A turn at 0.01 rad/s about an axis, from another attitude; NAIF's quaternion of it takes J2000 to the ship.
const Vec3d kRate = 0.01 * normalized(Vec3d{1, 2, -0.5});
Quat attitude(double et_s) {
    return from_rotation_vector(et_s * kRate) * from_rotation_vector({0.3, -0.2, 0.9});
}
void append_quaternion(std::vector<double>& words, double et_s, double sign = 1) {
    const Quat q = conjugate(attitude(et_s));
    for (const double v : {q.w, q.x, q.y, q.z}) words.push_back(sign * v);
}

void expect_turn(const KernelSet& set, double et_s, double tolerance_rad, double rate_tolerance,
                 double tolerance_s = 0) {
    KernelFrames frames(set, tolerance_s);
    const int ship = frames.require("SHIP", "test");
    FrameTurn turn;
    ASSERT_TRUE(frames.turn(ship, et_s, turn)) << et_s;
    const Mat3d expected = to_matrix(attitude(et_s));
    for (const auto& [a, b] :
         {std::pair{turn.reference_from_frame.x, expected.x}, {turn.reference_from_frame.y, expected.y}})
        EXPECT_NEAR(length(a - b), 0, tolerance_rad) << et_s;
    EXPECT_NEAR(length(turn.rate_rad_s - kRate), 0, rate_tolerance) << et_s;
}
bool knows(const KernelSet& set, double et_s, double tolerance_s = 0) {
    KernelFrames frames(set, tolerance_s);
    FrameTurn turn;
    return frames.turn(frames.require("SHIP", "test"), et_s, turn);
}

TEST(KernelFrames, InstantsHoldForTheirTolerance) {
    std::vector<double> words;
    for (const double t : {0.0, 10.0, 20.0}) {
        append_quaternion(words, t);
        words.insert(words.end(), {kRate.x, kRate.y, kRate.z});
    }
    words.insert(words.end(), {0, 100, 200, 3});
    const auto set = set_with(segment(1, true, words));
    expect_turn(*set, 10, 1e-14, 1e-16);
    EXPECT_FALSE(knows(*set, 10.5));
    EXPECT_TRUE(knows(*set, 10.5, 1));
    EXPECT_FALSE(knows(*set, 12, 1));
}

TEST(KernelFrames, ConstantRatesHoldOverTheirSpans) {
    std::vector<double> words, starts, stops;
    for (int i = 0; i < 150; ++i) {
        append_quaternion(words, 10.0 * i);
        words.insert(words.end(), {kRate.x, kRate.y, kRate.z, 0.1});
        starts.push_back(100.0 * i), stops.push_back(100.0 * i + (i == 70 ? 50 : 100));
    }
    words.insert(words.end(), starts.begin(), starts.end());
    words.insert(words.end(), stops.begin(), stops.end());
    words.push_back(0.5 * (stops[99] + starts[100]));
    const auto set = set_with(segment(2, true, words, 0, 15000));
    for (const double t : {0.0, 3.0, 10.0, 702.0, 1499.0}) expect_turn(*set, t, 1e-13, 1e-16);
    EXPECT_FALSE(knows(*set, 707));
}

TEST(KernelFrames, AStructureTurnsFromInstantToInstantInsideAnInterval) {
    std::vector<double> words, times;
    for (int i = 0; i < 120; ++i) {
        append_quaternion(words, 5.0 * i, i % 2 ? -1 : 1);  // q and -q are the same attitude
        times.push_back(50.0 * i);
    }
    words.insert(words.end(), times.begin(), times.end());
    words.push_back(times[99]);
    words.insert(words.end(), {0, 2000, 2, 120});  // intervals begin at 0 s and 200 s
    const auto set = set_with(segment(3, false, words, 0, 5950));
    for (const double t : {0.0, 2.5, 195.0, 200.0, 203.7, 595.0}) expect_turn(*set, t, 1e-13, 1e-13);
    EXPECT_FALSE(knows(*set, 197));
    EXPECT_FALSE(knows(*set, 596));
}

TEST(KernelFrames, ChebyshevPolynomialsOfQuaternionsHaveCountsOfTheirOwn) {
    // Fitted to the turn on [0, 20] s and [20, 60] s with 12 terms by Chebyshev's nodes.
    std::vector<double> words, starts, directory = {0};
    for (const auto& [from, to] : {std::pair{0.0, 20.0}, {20.0, 60.0}}) {
        constexpr int n = 12;
        const double mid = 5 * (from + to), radius = 5 * (to - from);
        words.insert(words.end(), {mid, radius, n * (1 + 128.0 + 128.0 * 128 + 128.0 * 128 * 128)});
        for (int k = 0; k < 4; ++k)
            for (int j = 0; j < n; ++j) {
                double sum = 0;
                for (int i = 0; i < n; ++i) {
                    const double angle = kPi * (i + 0.5) / n;
                    std::vector<double> q;
                    append_quaternion(q, (mid + radius * std::cos(angle)) / 10);
                    sum += q[static_cast<std::size_t>(k)] * std::cos(j * angle);
                }
                words.push_back(sum * (j == 0 ? 1.0 : 2.0) / n);
            }
        starts.push_back(10 * from), directory.push_back(static_cast<double>(words.size()));
    }
    const auto size = static_cast<double>(words.size());
    words.insert(words.end(), starts.begin(), starts.end());
    for (const double d : directory) words.push_back(d + 1);  // places count from 1
    // Constants, time directory, times, packets' directory, packets, reserved, size and offset of packets.
    words.insert(words.end(), {0, 0, size, 0, 0, size, 2, size + 2, 3, 0, 0, 2, 0, 0, 0, 0, 17});
    const auto set = set_with(segment(4, false, words, 0, 600));
    for (const double t : {0.0, 7.0, 19.9, 20.0, 33.3, 60.0}) expect_turn(*set, t, 1e-12, 1e-12);
    EXPECT_FALSE(knows(*set, 60.5));
}

TEST(KernelFrames, InterpolatedQuaternionsOfEverySubtypeFollowTheTurn) {
    for (int subtype = 0; subtype < 4; ++subtype) {
        std::vector<double> words, times;
        for (int i = 0; i < 110; ++i) {
            const double t = 2.0 * i, h = 1e-4;
            append_quaternion(words, t);
            if (subtype == 0 || subtype == 2) {
                std::vector<double> a, b;
                append_quaternion(a, t - h), append_quaternion(b, t + h);
                for (std::size_t k = 0; k < 4; ++k) words.push_back((b[k] - a[k]) / (2 * h));
            }
            if (subtype >= 2) words.insert(words.end(), {kRate.x, kRate.y, kRate.z});
            if (subtype == 2) words.insert(words.end(), {0, 0, 0});
            times.push_back(20.0 * i);
        }
        words.insert(words.end(), times.begin(), times.end());
        words.push_back(times[99]);
        words.insert(words.end(), {0, 0.1, double(subtype), subtype % 2 ? 8.0 : 4.0, 1, 110});
        const auto set = set_with(segment(5, subtype >= 2, words, 0, 2180));
        for (const double t : {0.0, 1.0, 77.7, 200.0, 218.0}) expect_turn(*set, t, 1e-9, 1e-8);
        EXPECT_FALSE(knows(*set, 218.5));
    }
}

TEST(KernelFrames, FramesStandOnEachOther) {
    std::vector<double> words;
    append_quaternion(words, 0), append_quaternion(words, 100);
    words.insert(words.end(), {0, 1000, 0, 1, 2});
    const auto set = set_with(segment(3, false, words));
    KernelFrames frames(*set);
    const int camera = frames.require("CAM", "test");
    FrameTurn turn;
    ASSERT_TRUE(frames.turn(camera, 50, turn));
    // [90]1 takes the camera's vectors to the ship's: its z axis is the ship's y.
    const Vec3d z = turn.reference_from_frame * Vec3d{0, 0, 1}, y = to_matrix(attitude(50)) * Vec3d{0, 1, 0};
    EXPECT_NEAR(length(z - y), 0, 1e-13);
    EXPECT_NEAR(length(turn.rate_rad_s - kRate), 0, 1e-13);
    try {
        frames.require("IAU_TITAN", "attitude.spice.frame");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(
            error.what(),
            HasSubstr("attitude.spice.frame: frame 'IAU_TITAN': no kernel says how body 606 is turned"));
    }
}

TEST(KernelFrames, ACircleOfFramesIsNeverKnown) {
    const auto offset = [](const std::string& name, const std::string& code, const std::string& relative) {
        return "FRAME_" + name + " = " + code + "\nFRAME_" + code + "_NAME = '" + name + "'\nFRAME_" + code +
               "_CLASS = 4\nTKFRAME_" + code + "_RELATIVE = '" + relative + "'\nTKFRAME_" + code +
               "_SPEC = 'QUATERNION'\nTKFRAME_" + code + "_Q = ( 1 0 0 0 )\n";
    };
    const std::string text = "\\begindata\n" + offset("A", "-1", "B") + offset("B", "-2", "A");
    const auto set = set_with(segment(1, false, {1, 0, 0, 0, 0, 1}), "CK", text.c_str());
    KernelFrames frames(*set);
    FrameTurn turn;
    EXPECT_FALSE(frames.turn(frames.require("A", "test"), 0, turn));
}

TEST(KernelFrames, AnAttitudeAgainstASwitchFrameIsNotKnownAndSaysSo) {
    std::vector<double> words;
    append_quaternion(words, 0);
    append_quaternion(words, 100);
    words.insert(words.end(), {0, 1000, 0, 1, 2});
    WrittenArray array = segment(3, false, words);
    array.integers[1] = 5000;
    const auto set = set_with(
        array, "CK", (std::string(kFrames) + "FRAME_5000_CLASS = 6\nFRAME_5000_NAME = 'SWITCHED'\n").c_str());
    KernelFrames frames(*set);
    FrameTurn turn;
    EXPECT_FALSE(frames.turn(frames.require("SHIP", "test"), 50, turn));
    ASSERT_EQ(frames.left_out().size(), 1u);
    EXPECT_THAT(frames.left_out().front(), HasSubstr("frame 'SWITCHED': found class 6"));
}

TEST(KernelFrames, AMeasuredPoleIsThatOfTheProgramsOwnFormulas) {
    // Archinal et al. 2018 for Mars and Neptune, as the program has them (render/sky/bodies.cpp); Neptune by terms.
    const char* text =
        "\\begindata\nBODY499_POLE_RA = ( 317.68143 -0.1061 0 )\nBODY499_POLE_DEC = ( 52.88650 -0.0609 0 "
        ")\nBODY499_PM = ( 176.630 350.89198226 0 )\n"
        "BODY899_POLE_RA = ( 299.36 0 0 )\nBODY899_POLE_DEC = ( 43.46 0 0 )\nBODY899_PM = ( 249.978 "
        "541.1397757 0 )\n"
        "BODY899_NUT_PREC_RA = 0.70\nBODY899_NUT_PREC_DEC = -0.51\nBODY899_NUT_PREC_PM = "
        "-0.48\nBODY8_NUT_PREC_ANGLES = ( 357.85 52.316 )\n";
    const auto set = set_with(segment(1, false, {1, 0, 0, 0, 0, 1}), "CK", text);
    KernelFrames frames(*set);
    const TimeTai time = parse_utc("2031-07-01T05:06:07Z");
    for (const auto& [name, id] : {std::pair{"IAU_MARS", BodyId::kMars}, {"IAU_NEPTUNE", BodyId::kNeptune}}) {
        const int frame = frames.require(name, "test");
        FrameTurn turn, later;
        ASSERT_TRUE(frames.turn(frame, set->time.et_s(time), turn));
        ASSERT_TRUE(frames.turn(frame, set->time.et_s(time) + 1, later));
        const Mat3d own = transposed(body_fixed_from_icrf(id, time, EarthOrientation{}));
        // The program takes TT for TDB: 2 ms.
        EXPECT_NEAR(length(turn.reference_from_frame.x - own.x), 0, 5e-7) << name;
        EXPECT_NEAR(length(transposed(turn.reference_from_frame).z - transposed(own).z), 0, 1e-11)
            << name;  // the pole
        const Vec3d x = transposed(turn.reference_from_frame).x,
                    moved = transposed(later.reference_from_frame).x - x;
        EXPECT_NEAR(length(moved - cross(turn.rate_rad_s, x)), 0, 1e-8) << name;
    }
}

TEST(KernelFrames, BinaryOrientationsAreEulersAngles) {
    // Node 1 rad, tilt 0.5 rad, and a turn of 1e-4 rad/s, over 1000 s.
    const WrittenArray array{
        "TEST", 0, 1000, {31006, 1, 2}, {500, 500, 1, 0, 0.5, 0, 0.05, 0.05, 0, 1000, 8, 1}};
    const auto set = set_with(array, "PCK",
                              "\\begindata\nFRAME_PA = 31006\nFRAME_31006_NAME = 'PA'\nFRAME_31006_CLASS = "
                              "2\nFRAME_31006_CLASS_ID = 31006\n");
    KernelFrames frames(*set);
    const int frame = frames.require("PA", "test");
    FrameTurn turn;
    ASSERT_TRUE(frames.turn(frame, 750, turn));
    const Vec3d pole = turn.reference_from_frame * Vec3d{0, 0, 1};
    EXPECT_NEAR(
        length(pole - Vec3d{std::sin(1) * std::sin(0.5), -std::cos(1) * std::sin(0.5), std::cos(0.5)}), 0,
        1e-14);
    EXPECT_NEAR(length(turn.rate_rad_s - 1e-4 * pole), 0, 1e-17);
    const Vec3d node{std::cos(1), std::sin(1), 0};
    EXPECT_NEAR(dot(turn.reference_from_frame * Vec3d{1, 0, 0}, node), std::cos(0.075), 1e-14);
    EXPECT_FALSE(frames.turn(frame, 1001, turn));
}

}  // namespace
}  // namespace hilcam
