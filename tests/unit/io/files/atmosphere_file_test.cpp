#include "io/files/atmosphere_file.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>

#include "render/sky/atmosphere_config.h"
#include "render/sky/atmosphere_models.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

const SpectralGrid kAirGrid({0.45, 0.55, 0.65});
constexpr double kGround_m = kEarthEquatorialRadius_m;

class AtmosphereFiles : public FilesTest {
  protected:
    std::string table_error(const std::filesystem::path& file) {
        return error_of([&] { read_atmosphere(file, kAirGrid); });
    }
};

const std::string kAirHeader =
    "sun_zenith_deg,view_zenith_deg,azimuth_deg,height_km,wavelength_um,tau_1,tau_2,path_radiance_sr,sky_"
    "irradiance\n";

// A ray from space to a ground point on the equator: zenith angles of Sun and viewer, azimuth between them.
struct Ray {
    Vec3d origin, dir, sun;
    double distance;
};
Ray ray_to_ground(double sun_deg, double view_deg, double azimuth_deg) {
    const double s = sun_deg * kDegree_rad, v = view_deg * kDegree_rad, a = azimuth_deg * kDegree_rad;
    const Vec3d ground{kGround_m, 0, 0};
    const Vec3d to_viewer{std::cos(v), std::sin(v), 0};
    return {ground + 1e6 * to_viewer,
            -to_viewer,
            {std::cos(s), std::sin(s) * std::cos(a), std::sin(s) * std::sin(a)},
            1e6};
}

// The precomputed atmosphere written as a table and read again looks the same on the grid and between its
// points.
TEST_F(AtmosphereFiles, ATableSaysWhatItWasMadeFrom) {
    AtmosphereConfig config;
    const auto truth = make_precomputed_atmosphere({config, kAirGrid});
    std::string text = kAirHeader;
    for (int sun = 0; sun <= 70; sun += 10)
        for (int view = 0; view <= 70; view += 10)
            for (int azimuth = 0; azimuth <= 180; azimuth += 20) {
                const Ray ray = ray_to_ground(sun, view, azimuth);
                const auto sight = truth->look(ray.origin, ray.dir, ray.distance, ray.sun);
                const Vec3d ground{kGround_m, 0, 0};
                for (const auto& [um, bin] : {std::pair{0.45, 0}, {0.5499, 0}, {0.5501, 1}, {0.65, 1}})
                    text += std::to_string(sun) + "," + std::to_string(view) + "," + std::to_string(azimuth) +
                            ",800," + std::to_string(um) + "," +
                            std::to_string(truth->sun_transmittance(ground, ray.sun)[bin]) + "," +
                            std::to_string(sight.transmittance[bin]) + "," +
                            std::to_string(sight.radiance_sr[bin]) + "," +
                            std::to_string(truth->sky_irradiance(ground, ray.sun)[bin]) + "\n";
            }
    AtmosphereTable table = read_atmosphere(write("t.csv", text), kAirGrid);
    const auto air = make_table_atmosphere({config, kAirGrid, &table});
    for (const auto& [sun, view, azimuth] :
         {std::array{20.0, 30.0, 40.0}, {15.0, 35.0, 70.0}, {62.0, 48.0, 110.0}}) {
        const Ray ray = ray_to_ground(sun, view, azimuth);
        const auto seen = air->look(ray.origin, ray.dir, ray.distance, ray.sun);
        const auto right = truth->look(ray.origin, ray.dir, ray.distance, ray.sun);
        for (int b = 0; b < 2; ++b) {
            EXPECT_NEAR(seen.transmittance[b] / right.transmittance[b], 1, 0.01);
            EXPECT_NEAR(seen.radiance_sr[b] / right.radiance_sr[b], 1, 0.04)
                << sun << " " << view << " " << azimuth;
            EXPECT_NEAR(air->sky_irradiance({kGround_m, 0, 0}, ray.sun)[b] /
                            truth->sky_irradiance({kGround_m, 0, 0}, ray.sun)[b],
                        1, 0.02);
        }
        EXPECT_EQ(air->missing(ray.origin, ray.dir, ray.distance, ray.sun), "");
    }
    EXPECT_EQ(air->rays_outside(), 0u);
    const Ray low = ray_to_ground(75, 30, 0);
    EXPECT_THAT(air->missing(low.origin, low.dir, low.distance, low.sun),
                HasSubstr("zenith angle of the Sun of 75.0"));
    air->look(low.origin, low.dir, low.distance, low.sun);
    EXPECT_EQ(air->rays_outside(), 1u);
    // What misses the ground is clear.
    EXPECT_EQ(
        air->look(low.origin, {0, 1, 0}, std::numeric_limits<double>::infinity(), low.sun).transmittance[0],
        1);
}

TEST_F(AtmosphereFiles, WhatATableLacksIsNamed) {
    const std::string rows = "10,0,0,800,0.45,0.8,0.9,0.02,0.1\n10,0,0,800,0.65,0.8,0.9,0.02,0.1\n";
    EXPECT_EQ(table_error(write("good.csv", kAirHeader + rows)), "no error");
    EXPECT_THAT(table_error(folder_ / "none.csv"), HasSubstr("none.csv: no such file"));
    EXPECT_THAT(table_error(write("a.csv", "angle,tau\n1,2\n")), HasSubstr("a.csv:1: found 'angle,tau'"));
    EXPECT_THAT(table_error(write("b.csv", kAirHeader + rows + "20,0,0,800,0.45,0.8\n")),
                HasSubstr("b.csv:4: found 6 columns"));
    EXPECT_THAT(table_error(write("c.csv", kAirHeader + rows + "95,0,0,800,0.45,0.8,0.9,0.02,0.1\n")),
                HasSubstr("c.csv:4: sun_zenith_deg: found '95'; accepted: a number from 0 to 90"));
    EXPECT_THAT(table_error(write("d.csv", kAirHeader + rows + "20,0,0,800,0.45,1.2,0.9,0.02,0.1\n")),
                HasSubstr("d.csv:4: a transmittance is not within 0 to 1: tau_1 1.2"));
    EXPECT_THAT(
        table_error(write(
            "e.csv",
            kAirHeader + rows + "20,30,0,800,0.45,0.8,0.9,0.02,0.1\n20,30,0,800,0.65,0.8,0.9,0.02,0.1\n")),
        HasSubstr(
            "e.csv: has no geometry sun_zenith_deg 10, view_zenith_deg 30, azimuth_deg 0, height_km 800"));
    EXPECT_THAT(
        table_error(write(
            "f.csv", kAirHeader + "10,0,0,800,0.45,0.8,0.9,0.02,0.1\n10,0,0,800,0.60,0.8,0.9,0.02,0.1\n")),
        HasSubstr("the curve reaches from 0.450 to 0.600 um"));
}

// A run in MODTRAN's layout, made by hand from known quantities: E = 0.18 W cm^-2 um^-1, tau_1 = 0.7, tau_2 =
// 0.8, albedo 0.3, sky 0.12, Sun at 60 degrees.
TEST_F(AtmosphereFiles, AModtranRunGivesItsQuantitiesBack) {
    const double e = 0.18, tau_1 = 0.7, tau_2 = 0.8, mu = 0.5, albedo = 0.3, sky = 0.12, path = 0.005;
    const double direct = albedo / kPi * mu * e * tau_1 * tau_2;
    const double ground = direct + albedo / kPi * sky * e * tau_2;
    std::string run =
        " MM  2 3 2 1\n some card\n"
        "   WAVLEN(NM) TOT_TRANS PTH_THRML THRML_SCT SURF_EMIS SOL_SCAT SING_SCAT GRND_RFLT DRCT_RFLT "
        "TOTAL_RAD REF_SOL SOL@OBS DEPTH TOA_SUN\n"
        "   (units)\n";
    for (const char* nm : {"440.0", "550.0", "660.0"})
        run += std::string("  ") + nm + " " + std::to_string(tau_2) + " 0 0 0 " + std::to_string(path * e) +
               " 0 " + std::to_string(ground) + " " + std::to_string(direct) + " 0 " +
               std::to_string(e * tau_1 * tau_2) + " " + std::to_string(e) + " 0.2 " + std::to_string(e) +
               "\n";
    run += " -9999.\n";
    write("tape7.scn", run);
    const auto index = write(
        "runs.csv", "sun_zenith_deg,view_zenith_deg,azimuth_deg,height_km,file\n60,20,90,800,tape7.scn\n");
    const AtmosphereTable table = read_atmosphere(index, kAirGrid);
    ASSERT_EQ(table.cells.size(), 1u);
    EXPECT_NEAR(table.cells[0].tau_1[0], tau_1, 1e-4);
    EXPECT_NEAR(table.cells[0].tau_2[1], tau_2, 1e-5);
    EXPECT_NEAR(table.cells[0].radiance_sr[0], path, 1e-4 * path);
    EXPECT_NEAR(table.cells[0].sky[0], sky, 1e-3);
    write("cut.scn", run.substr(0, 60));
    EXPECT_THAT(
        table_error(write(
            "cut.csv", "sun_zenith_deg,view_zenith_deg,azimuth_deg,height_km,file\n60,20,90,800,cut.scn\n")),
        HasSubstr("cut.scn:"));
}

// MODTRAN 3's and 4's own layout: names of two words, numbers by places. The quantities: tau_1 0.80, tau_2 0.85, path 0.02 sr^-1, a ground
// of 0.3 under the Sun at 30 degrees.
class ModtranFour : public AtmosphereFiles {
  protected:
    static std::string field(const char* format, double value) {
        char text[40];
        std::snprintf(text, sizeof text, format, value);
        return text;
    }
    // Rows of tape7: F7.0, F11.6, eight of E11.3, two of E9.2, F8.3; of tape7.scn: F12.6, F7.4, and blanks where thermal scattering and
    // depth are not computed.
    static std::string run(bool scan, const std::string& suffix = "") {
        std::string out =
            scan ? " card\n WAVLEN MCRN  TRANS  PTH THRML  THRML SCT  SURF EMIS   SOL SCAT  SING SCAT  GRND "
                   "RFLT  DRCT RFLT  TOTAL RAD  REF SOL  SOL@OBS   DEPTH\n"
                 : " card\n  FREQ   TOT TRANS  PTH THRML  THRML SCT  SURF EMIS   SOL SCAT  SING SCAT  GRND "
                   "RFLT  DRCT RFLT  TOTAL RAD  REF SOL  SOL@OBS   DEPTH\n";
        const double sun = 2e-5, direct = 0.3 / kPi * 0.8660254 * sun * 0.8 * 0.85;
        for (const double nm : {700.0, 550.0, 400.0}) {
            out += scan ? field("%12.6f", nm * 1e-3) + field("%7.4f", 0.85)
                        : field("%7.0f", 1e7 / nm) + field("%11.6f", 0.85);
            out += field("%11.4E", 0) + (scan ? std::string(11, ' ') : field("%11.4E", 0));
            for (const double v :
                 {0.0, 0.02 * sun, 0.016 * sun, 1.1 * direct, direct, 0.02 * sun + 1.1 * direct})
                out += field("%11.4E", v);
            out += field("%9.2E", sun * 0.8 * 0.85) + field("%9.2E", sun) +
                   (scan ? "" : field("%8.3f", 0.16)) + suffix + "\n";
        }
        return out + "-9999.\n";
    }
    AtmosphereTable::Cell cell_of(const std::string& text) {
        write("tape7", text);
        return read_atmosphere(write("runs.csv", kIndex), kAirGrid).cells.at(0);
    }
    std::string refusal_of(const std::string& text) {
        write("tape7", text);
        return table_error(write("runs.csv", kIndex));
    }
    const std::string kIndex =
        "sun_zenith_deg,view_zenith_deg,azimuth_deg,height_km,file\n30,0,0,800,tape7\n";
};

TEST_F(ModtranFour, NamesOfTwoWordsAndBlankFieldsAreRead) {
    // Two digits of the Sun's irradiance are 0.4 % of tau_1.
    for (const bool scan : {false, true}) {
        const AtmosphereTable::Cell cell = cell_of(run(scan));
        for (int b = 0; b < 2; ++b) {
            EXPECT_NEAR(cell.tau_2[b], 0.85, 1e-4) << scan;
            EXPECT_NEAR(cell.tau_1[b], 0.80, 0.004) << scan;
            EXPECT_NEAR(cell.radiance_sr[b], 0.02, 1e-4) << scan;
            EXPECT_NEAR(cell.sky[b], 0.1 * 0.8660254 * 0.8, 1e-3) << scan;
        }
    }
    EXPECT_NEAR(cell_of(run(true, "\r")).tau_2[0], 0.85, 1e-4);
}

// Fields that touch, that overflow (***) and that leave out the exponent's letter, as Fortran writes them.
TEST_F(ModtranFour, FieldsAreThoseOfFortran) {
    std::string text = run(false);
    for (std::size_t at; (at = text.find("   0.160")) != std::string::npos;) text.replace(at, 8, "********");
    for (std::size_t at; (at = text.find(" 0.0000E+00 0.0000E+00")) != std::string::npos;)
        text.replace(at, 22, " 0.0000-100-1.0000E-30");
    EXPECT_NEAR(cell_of(text).tau_1[0], 0.80, 0.004);
    // A row that ends early, and one whose numbers are elsewhere, are no rows of these columns.
    const std::string whole = run(false);
    EXPECT_THAT(refusal_of(whole.substr(0, whole.rfind("   0.160") - 25)), HasSubstr("has no number"));
    std::string moved = whole;
    moved.replace(moved.find("  14286   0.850000 "), 19, "14286 0.850000     ");
    moved.replace(moved.find("   0.160\n"), 8, "");
    EXPECT_THAT(refusal_of(moved), HasSubstr("tape7:3: "));
}

}  // namespace
}  // namespace hilcam
