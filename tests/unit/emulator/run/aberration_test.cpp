// What a camera in motion sees of the sky, in its pictures' truth, against ERFA.

#include <erfa.h>
#include <erfam.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "emulator/run/still_camera.h"
#include "emulator/run/truth_source.h"
#include "emulator/scenario/scene_loader.h"
#include "render/vocabulary/units.h"
#include "sensor/published_frame.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

constexpr double kFocal_px = 64000;  // 3.2 arcsec a pixel
const Vec3d kCamera_m{6.8e6, 1e5, -2e5};
const char* const kTime = "2026-06-21T00:00:00Z";

class Aberration : public FilesTest {
  protected:
    // The truth of a picture, the camera looking at a direction.
    FrameTruth truth(Vec3d towards, Vec3d velocity_m_s, const std::string& rest = "") {
        write("stars.csv",
              "ra_deg,dec_deg,pm_ra_mas_yr,pm_dec_mas_yr,parallax_mas,v_mag\n" + star_row_ + "\n");
        const auto triple = [](Vec3d v) {
            char text[99];
            std::snprintf(text, sizeof text, "[%.17g, %.17g, %.17g]", v.x, v.y, v.z);
            return std::string(text);
        };
        const auto file = write(
            "sky.yaml",
            std::string("time_utc: ") + kTime +
                "\n"
                "camera: {name: sky, width_px: 64, height_px: 64, pitch_um: 10, focal_length_mm: 640, "
                "f_number: 4,\n"
                "  quantum_efficiency: 0.5, full_well_e: 1000000, gain_dn_e: 0.01, bits: 12, exposure_ms: "
                "1}\n"
                "camera_pose: {attitude: look_at, up: [0.1, 0.2, 0.9], position_m: " +
                triple(kCamera_m) + ", look_at_m: " + triple(kCamera_m + 1e12 * towards) +
                ", velocity_m_s: " + triple(velocity_m_s) +
                "}\nearth: {visible: false}\nstars: {catalogue: stars.csv}\nspectrum_edges_um: [0.5, 0.7]\n" +
                rest);
        const ScenarioConfig s = load_scenario(file, {});
        StillCamera camera(s);
        FrameTruth t = make_truth(s, camera.renderer(), truth_request(s));
        t.raster = raster_of(s.camera, 1, {});
        camera.render({1, 1}, &t);
        return t;
    }
    // Where the picture must have what is seen in a direction.
    static Vec2d place_px(const FrameTruth& t, Vec3d dir) {
        const Vec3d d = transposed(to_matrix(t.camera.world_from_body)) * dir;
        return {32 + kFocal_px * d.x / d.z, 32 + kFocal_px * d.y / d.z};
    }

    std::string star_row_ = "201.29835,-11.16124,-42.5,-31.73,12.44,0.98";  // Spica
};

struct Earth {
    Vec3d position_m, velocity_m_s;  // about the barycentre
};
Earth earth_at(const JulianDate& tt) {
    double heliocentric[2][3], barycentric[2][3];
    eraEpv00(tt.day, tt.fraction, heliocentric, barycentric);
    const auto row = [&](int i, double unit) {
        return Vec3d{unit * barycentric[i][0], unit * barycentric[i][1], unit * barycentric[i][2]};
    };
    return {row(0, kAstronomicalUnit_m), row(1, kAstronomicalUnit_m / 86400)};
}

const Vec3d kVelocities_m_s[] = {{}, {0, 7000, 3000}, {-1e5, 2e5, 2e5}};

TEST_F(Aberration, AStarIsWhereErfaHasItForTheCamerasWholeVelocity) {
    const JulianDate tt = julian_tt(parse_utc(kTime));
    const double ra = 201.29835 * kDegree_rad, dec = -11.16124 * kDegree_rad;
    for (const Vec3d velocity_m_s : kVelocities_m_s) {
        double pv[2][3] = {{kCamera_m.x, kCamera_m.y, kCamera_m.z},
                           {velocity_m_s.x, velocity_m_s.y, velocity_m_s.z}};
        eraASTROM astrom;
        eraApcs13(tt.day, tt.fraction, pv, &astrom);
        double ra2000, dec2000, pm_ra, pm_dec, parallax, rv, seen_ra, seen_dec;
        eraPmsafe(ra, dec, -42.5e-3 * kArcsecond_rad / std::cos(dec), -31.73e-3 * kArcsecond_rad, 12.44e-3, 0,
                  ERFA_DJ00, -8.75 * 365.25, ERFA_DJ00, 0, &ra2000, &dec2000, &pm_ra, &pm_dec, &parallax,
                  &rv);
        eraAtciq(ra2000, dec2000, pm_ra, pm_dec, parallax, rv, &astrom, &seen_ra, &seen_dec);
        const Vec3d seen{std::cos(seen_dec) * std::cos(seen_ra), std::cos(seen_dec) * std::sin(seen_ra),
                         std::sin(seen_dec)};
        const FrameTruth t =
            truth({std::cos(dec) * std::cos(ra), std::cos(dec) * std::sin(ra), std::sin(dec)}, velocity_m_s);
        // 300 km/s take it out of the field, which is 200 arcsec wide.
        const Vec2d expected_px = place_px(t, seen);
        if (std::abs(expected_px.x - 32) > 31 || std::abs(expected_px.y - 32) > 31) {
            EXPECT_TRUE(t.stars.empty());
            EXPECT_EQ(truth(seen, velocity_m_s).stars.size(), 1u);
            continue;
        }
        ASSERT_EQ(t.stars.size(), 1u);
        // The Sun bends its light by 5 mas there, 0.002 px.
        EXPECT_NEAR(t.stars[0].position_px.x, expected_px.x, 0.003);
        EXPECT_NEAR(t.stars[0].position_px.y, expected_px.y, 0.003);
    }
}

// The way of the light solved by iteration in the barycentric frame, then aberration by the whole velocity
// (ERFA eraAb). hilcam takes the origin's velocity and the camera's one after the other: 1e-3 of the second
// at most.
TEST_F(Aberration, SunMoonAndPlanetsAreWhereTheirLightComesFrom) {
    const TimeTai time = parse_utc(kTime);
    const Earth earth = earth_at(julian_tt(time));
    const Vec3d observer_m = earth.position_m + kCamera_m;
    const auto place_m = [&](std::optional<BodyId> id, TimeTai then) {
        const Vec3d sun_m = earth_at(julian_tt(then)).position_m + sun_from_earth_m(then);
        return id ? sun_m + heliocentric(*id, then).position_m : sun_m;
    };
    for (const Vec3d velocity_m_s : kVelocities_m_s)
        for (const std::optional<BodyId> id :
             {std::optional<BodyId>(), std::optional(BodyId::kMoon), std::optional(BodyId::kMars),
              std::optional(BodyId::kJupiter)}) {
            double light_s = 0;
            Vec3d to_m;
            for (int i = 0; i < 5; ++i) {
                to_m = place_m(id, time + -static_cast<std::int64_t>(light_s * 1e9)) - observer_m;
                light_s = length(to_m) / kSpeedOfLight_m_s;
            }
            const Vec3d seen = aberrated(normalized(to_m), earth.velocity_m_s + velocity_m_s);
            const FrameTruth t =
                truth(seen, velocity_m_s,
                      "mars: {visible: true}\njupiter: {visible: true}\nmoon: {visible: true}\n");
            const std::uint32_t number = id ? truth_id(*id) : kSunId;
            const auto thing = std::find_if(t.things.begin(), t.things.end(),
                                            [&](const SeenThing& s) { return s.id == number; });
            ASSERT_NE(thing, t.things.end());
            ASSERT_TRUE(thing->has_center);
            const Vec2d expected_px = place_px(t, seen);
            const double allowed_px = 0.003 + 1e-3 * length(velocity_m_s) / kSpeedOfLight_m_s * kFocal_px;
            EXPECT_NEAR(thing->center_px.x, expected_px.x, allowed_px) << number << " " << velocity_m_s.x;
            EXPECT_NEAR(thing->center_px.y, expected_px.y, allowed_px) << number << " " << velocity_m_s.x;
        }
}

}  // namespace
}  // namespace hilcam
