// Orbits, attitudes and element sets in the dialects that people file in public trackers: the files of ../shared/cases, each
// with a right value that does not depend on hilcam (its folder's make.py says how it was made). Prints a line for each.

#include <gmock/gmock.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "emulator/motion/ephemeris.h"
#include "emulator/motion/trajectories.h"
#include "render/sky/earth_frames.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kOneSecond_ns = 1'000'000'000;
const TimeTai kStart = parse_utc("2026-03-20T12:00:00Z");

std::filesystem::path shared_cases() {
    const char* const shared = std::getenv("HILCAM_SHARED");
    return std::filesystem::path(shared ? shared : HILCAM_SOURCE_DIR "/../shared") / "cases";
}

// A circle of 7000 km about the Earth, inclined by 51.6 deg, node at 10 deg; metres.
StateVector circle(double t) {
    const double a = 7e6, i = 51.6 * kDegree_rad, n = 10 * kDegree_rad;
    const double rate = std::sqrt(398600.4418e9 / (a * a * a)), u = rate * t, v = rate * a;
    const auto turned = [&](double x, double y) {
        return Vec3d{x * std::cos(n) - y * std::cos(i) * std::sin(n),
                     x * std::sin(n) + y * std::cos(i) * std::cos(n), y * std::sin(i)};
    };
    return {turned(a * std::cos(u), a * std::sin(u)), turned(-v * std::sin(u), v * std::cos(u))};
}

template <class Work>
std::string refusal_of(const Work& work) {
    try {
        work();
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

class PublicOrbits : public testing::Test {
  protected:
    std::filesystem::path folder_ = shared_cases();
    void SetUp() override {
        if (!std::filesystem::exists(folder_)) GTEST_SKIP() << folder_ << " is not there";
    }
    // The greatest distance of an ephemeris from places that are told, between its states and on them.
    template <class Right>
    double farthest_m(const std::string& file, double until_s, const Right& right) const {
        const auto trajectory = make_oem(load_oem(folder_ / "ccsds" / file), file);
        double most = 0;
        for (double t = 0; t <= until_s; t += 7.5) {
            const WorldFrame frame(kStart + static_cast<std::int64_t>(t * 1e9), {});
            most = std::max(most, length(trajectory->at({frame, {}}).position_m - right(t)));
        }
        std::printf("ccsds/%s: farthest from the right place %.6f m\n", file.c_str(), most);
        return most;
    }
};

struct Circle {
    const char* file;
    double until_s, tolerance_m;
};
// The remainders of the methods: LINEAR h^2/8 of 8.1 m/s^2; LAGRANGE's is the same with degree 1; HERMITE of two states
// (h rate)^4 / 384; those of more states are below the files' micrometres, at the ends of LAGRANGE 5 0.4 mm.
constexpr std::array kCircles = {Circle{"stk_mixed_case.oem", 1200, 0.02},
                                 Circle{"lower_case_values.oem", 1200, 1e-3},
                                 Circle{"gmat_order_2.oem", 1200, 0.4},
                                 Circle{"hermite_1.oem", 1200, 0.4},
                                 Circle{"hermite_even_8.oem", 1200, 1e-3},
                                 Circle{"lagrange_1.oem", 1200, 3700},
                                 Circle{"linear.oem", 1200, 3700},
                                 Circle{"bom.oem", 1200, 1e-3},
                                 Circle{"crlf_bom.oem", 1200, 1e-3},
                                 Circle{"tabs.oem", 1200, 1e-3},
                                 Circle{"doy.oem", 1200, 1e-3},
                                 Circle{"no_fraction_z.oem", 1200, 1e-3},
                                 Circle{"fortran_d_exponent.oem", 1200, 1e-3},
                                 Circle{"unsaid_4min.oem", 4800, 0.2},
                                 Circle{"unknown_keyword.oem", 1200, 1e-3},
                                 Circle{"units_in_brackets.oem", 1200, 1e-3},
                                 Circle{"v3_header.oem", 1200, 1e-3},
                                 Circle{"oem.xml", 600, 1e-3},
                                 Circle{"duplicate_epoch.oem", 600, 0.02},
                                 Circle{"time_tai.oem", 1200, 1e-3},
                                 Circle{"time_tt.oem", 1200, 1e-3},
                                 Circle{"time_gps.oem", 1200, 1e-3},
                                 Circle{"degree_more_than_states.oem", 180, 1e-3},
                                 Circle{"time_tdb.oem", 1200, 15}};  // written as TT: 1.6 ms of 7.5 km/s

TEST_F(PublicOrbits, EphemeridesAreWhereTheirClosedFormIs) {
    const Mat3d icrf = icrf_from_eme2000();
    for (const Circle& c : kCircles)
        EXPECT_LT(farthest_m(c.file, c.until_s, [&](double t) { return icrf * circle(t).position_m; }),
                  c.tolerance_m)
            << c.file;
    // IAU 2006/2000A at 12:00 (ERFA's eraPnm06a) against 1976/1980: 0.073 arcsec.
    const Mat3d true_from_icrf{{0.9999793795935101, -0.0058899913713400, -0.0025589821070297},
                               {0.0058898781393997, 0.9999826531765716, -0.0000517826916644},
                               {0.0025592427164260, 0.0000367095311130, 0.9999967244591998}};
    EXPECT_LT(farthest_m("tod.oem", 1200,
                         [&](double t) { return transposed(true_from_icrf) * circle(t).position_m; }),
              3);
    // Precession since 2000 makes 44.5 km; the equinoxes of TEME and J2000 at 2000 are 14 arcsec apart (nutation).
    EXPECT_LT(farthest_m("teme_of_2000.oem", 1200, [&](double t) { return icrf * circle(t).position_m; }),
              600);
    EXPECT_NEAR(farthest_m("teme_of_date.oem", 1200, [&](double t) { return icrf * circle(t).position_m; }),
                44.5e3, 500);
}

TEST_F(PublicOrbits, EphemeridesThatCannotBeReadSayWhy) {
    const auto refusal = [&](const std::string& file) {
        const std::string what = refusal_of([&] { make_oem(load_oem(folder_ / "ccsds" / file), file); });
        std::printf("ccsds/%s: refused: %s\n", file.c_str(), what.c_str());
        return what;
    };
    EXPECT_THAT(refusal("mrt_time.oem"), HasSubstr(":10: found 'MRT'; accepted: TIME_SYSTEM of UTC"));
    EXPECT_THAT(refusal("barycentre_center.oem"), HasSubstr("CENTER_NAME: found 'EARTH BARYCENTER'"));
    EXPECT_THAT(refusal("opm.opm"), HasSubstr(":1: found 'CCSDS_OPM_VERS = 2.0'; accepted: CCSDS_OEM_VERS"));
}

// A turn about z of 6 deg/s from the identity on; nine digits.
TEST_F(PublicOrbits, AttitudesAreTheirClosedForm) {
    for (const char* file : {"aem_plain.aem", "aem_sign_flips.aem", "aem_sign_flips_hermite.aem",
                             "aem_lower_case.aem", "aem_v1_quaternion_rate.aem", "aem_star_tracker_frame.aem",
                             "aem_instrument_frame.aem", "aem_hermite_1.aem", "aem_lagrange_1.aem"}) {
        const std::vector<AemSegment> segments = load_aem(folder_ / "ccsds" / file);
        double max_rad = 0;
        for (double t = 0; t <= 120; t += 2.5) {
            const TimeTai time = kStart + static_cast<std::int64_t>(t * 1e9);
            const Quat right = from_rotation_vector({0, 0, 6 * t * kDegree_rad});
            const Quat q =
                conjugate(right) * interpolate_attitude(segment_of(segments, time), time).reference_from_body;
            max_rad = std::max(max_rad, 2 * length(Vec3d{q.x, q.y, q.z}));
        }
        std::printf("ccsds/%s: farthest from the right attitude %.6f deg\n", file, max_rad / kDegree_rad);
        // Quaternions 30 deg of half angle apart. Degree 1: a chord that is walked evenly, 0.27 deg off. Degree 5:
        // 0.5236^6 16.9 / 720 of them in the first and last interval, 0.055 deg of the turn.
        const bool line = std::string(file).find("_1.aem") != std::string::npos;
        EXPECT_LT(max_rad, (line ? 0.27 : 0.056) * kDegree_rad) << file;
    }
}

TEST_F(PublicOrbits, ElementSetsOfEveryDialectAreTheSamePlace) {
    const auto place = [&](const std::string& file, const std::string& satellite, TleChecksum checksum) {
        const std::vector<ElementSet> sets = load_element_sets(folder_ / "tle" / file, checksum);
        const WorldFrame frame(kStart + 3600 * kOneSecond_ns, {});
        return make_tle(choose_element_set(sets, satellite, kStart, file), 86400)->at({frame, {}}).position_m;
    };
    const Vec3d right = place("plain.tle", "", TleChecksum::kVerify);
    struct Case {
        const char *file, *satellite;
        TleChecksum checksum = TleChecksum::kVerify;
    };
    for (const Case& c :
         {Case{"omm.xml", "100001"}, Case{"omm.kvn", "A0001"}, Case{"omm.csv", "100001"},
          Case{"alpha5.tle", "100001"}, Case{"spaces_number.tle", "04859"},
          Case{"no_checksum.tle", "", TleChecksum::kIgnore}, Case{"crlf_trailing.tle", ""},
          Case{"bom.tle", "SAT"}, Case{"ndd_plus_exponent.tle", ""}, Case{"epoch_space_day.tle", ""},
          Case{"name_starts_with_1.tle", ""}, Case{"name_starts_with_2.tle", ""}, Case{"hash_name.tle", ""},
          Case{"tabs_lower.tle", ""}}) {
        std::string what;
        double apart_m = -1;
        what = refusal_of([&] { apart_m = length(place(c.file, c.satellite, c.checksum) - right); });
        std::printf("tle/%s: %s%.6f m from the place of plain.tle\n", c.file, what.c_str(), apart_m);
        // Elements are read to the last digit; B* of one case is 0, which is 0.6 m after an hour.
        if (what.empty())
            EXPECT_LT(apart_m, std::string(c.file) == "ndd_plus_exponent.tle" ? 1 : 1e-6) << c.file;
        else
            ADD_FAILURE() << c.file << ": " << what;
    }
}

// These have other elements than plain.tle, or are there to be read alone.
TEST_F(PublicOrbits, OtherDialectsOfElementSetsAreRead) {
    for (const char* file : {"bstar_plus_sign.tle", "bstar_positive_exp.tle", "angles_leading_dot.tle",
                             "plus_signs.tle", "long_name.tle"})
        EXPECT_EQ(load_element_sets(folder_ / "tle" / file).size(), 1u) << file;
}

TEST_F(PublicOrbits, ElementSetsThatCannotBeReadSayWhy) {
    const auto refusal = [&](const std::string& file) {
        const std::string what = refusal_of(
            [&] { choose_element_set(load_element_sets(folder_ / "tle" / file), "", kStart, file); });
        std::printf("tle/%s: refused: %s\n", file.c_str(), what.c_str());
        return what;
    };
    EXPECT_THAT(refusal("ephemeris_type_4.tle"), HasSubstr("ephemeris type 4 (SGP4-XP)"));
    EXPECT_THAT(refusal("nbsp.tle"), HasSubstr("nbsp.tle:1: the line has U+00A0, a non-breaking blank"));
    EXPECT_THAT(refusal("no_checksum.tle"), HasSubstr("checksum: ignore takes lines without their checksum"));
}

}  // namespace
}  // namespace hilcam
