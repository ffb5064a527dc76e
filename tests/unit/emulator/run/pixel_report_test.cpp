#include "emulator/run/pixel_report.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>

#include "emulator/run/still_camera.h"
#include "sensor/optics.h"
#include "tests/support/plate.h"

namespace hilcam {
namespace {

using testing::HasSubstr;
using testing::Not;
using Overrides = std::vector<std::string>;

// What is said of a pixel, and the electrons of its light by the radiance of the picture.
struct Told {
    std::string text;
    double radiance_e = 0;

    // The number on a line of the report; -1: there is no such line.
    double electrons(const std::string& line) const {
        const std::size_t at = text.find("\n  " + line + ' ');
        return at == std::string::npos ? -1 : std::stod(text.substr(at + 4 + line.size()));
    }
};

class PixelReport : public PlateTest {
  protected:
    // A plate that is exactly 16 pixels wide in the middle of 64, and bright enough that a tenth of an electron is nothing.
    static constexpr int kLeft_px = 24;
    ScenarioConfig plate(const std::string& camera, const Overrides& overrides = {}) {
        Overrides all = {"spectrum_edges_um=[0.45, 0.5, 0.58, 0.7]", "camera.exposure_ms=2000",
                         "quality.guard_px=8", "quality.rays_across=0"};
        all.insert(all.end(), overrides.begin(), overrides.end());
        return load_scenario(scenario(camera), all);
    }
    // channel: of the filter over the pixel.
    static Told tell(const ScenarioConfig& s, FramePixel pixel, std::size_t channel = 0) {
        StillCamera camera(s, 0, StillCamera::Light::kRadiance);
        PixelRecord record;
        record.box = radiance_pixels(camera, pixel);
        PartsBuffer buffer = camera.renderer().make_parts_buffer(camera.radiance());
        camera.renderer().keep_parts(&buffer, &record);
        const RadianceImage& radiance = camera.render({1, 1});
        Told told{pixel_report(camera, pixel, record), 0};
        const auto m = static_cast<double>(s.quality.oversampling);
        const Spectrum response = channel_responses(s.camera, camera.grid())[channel];
        for (int plane = 0; plane < radiance.planes(); ++plane)
            for (int y = record.box.y0; y < record.box.y1; ++y)
                for (int x = record.box.x0; x < record.box.x1; ++x)
                    told.radiance_e +=
                        camera.exposure().exposure_s / (m * m) * static_cast<double>(response[plane]) *
                        static_cast<double>(radiance.row(y, plane)[static_cast<std::size_t>(x)]);
        return told;
    }
    // The mean electrons that a pixel gets, the lens's blur and all, without binning.
    static double electrons(const ScenarioConfig& s, int x, int y) {
        StillCamera camera(s);
        camera.render({1, 1});
        return static_cast<double>(camera.expose().row(y)[static_cast<std::size_t>(x)]);
    }
};

// The plate's edge is between two pixels of the frame, wherever the frame's corner is and whatever its pixels are made of.
TEST_F(PixelReport, SumsTheElectronsOfThePixelsRadiance) {
    struct Case {
        const char* camera;
        Overrides overrides;
        int left_px, top_px;  // first pixel of the plate
        double area;          // of a pixel, in the detector's
    };
    for (const Case& c :
         {Case{"", {}, kLeft_px, kLeft_px, 1}, Case{"", {"quality.oversampling=2"}, kLeft_px, kLeft_px, 1},
          Case{", black_columns: 4, black_rows: 2", {}, kLeft_px + 4, kLeft_px + 2, 1},
          Case{", binning_x: 2, binning_y: 2", {}, kLeft_px / 2, kLeft_px / 2, 4},
          Case{", black_columns: 4, black_rows: 2, binning_x: 2, binning_y: 2",
               {"quality.oversampling=2"},
               (kLeft_px + 4) / 2,
               (kLeft_px + 2) / 2,
               4}}) {
        const std::string what = c.camera + (c.overrides.empty() ? "" : ", " + c.overrides[0]);
        const ScenarioConfig s = plate(c.camera, c.overrides);
        const Told inside = tell(s, {c.left_px, c.top_px + 1});
        EXPECT_GT(inside.radiance_e, 1e5) << what;
        EXPECT_NEAR(inside.electrons("sum") / inside.radiance_e, 1, 1e-5) << what;
        EXPECT_EQ(inside.electrons("direct.sun"), inside.electrons("sum")) << what;
        const Told outside = tell(s, {c.left_px - 1, c.top_px + 1}),
                   above = tell(s, {c.left_px, c.top_px - 1});
        EXPECT_EQ(outside.electrons("sum"), 0) << what;
        EXPECT_EQ(above.electrons("sum"), 0) << what;
        // The middle of the plate is as bright in charge: a percent goes into the lens's halo, or off the axis.
        const double charge = electrons(plate(""), 31, 31) * c.area;
        EXPECT_NEAR(inside.electrons("sum") / charge, 1, 0.02) << what;
    }
}

TEST_F(PixelReport, CountsByTheFilterOverThePixel) {
    const ScenarioConfig s = plate(", color_filter: " HILCAM_SOURCE_DIR
                                   "/configs/filters/RGGB.yaml, black_columns: 3, black_rows: 2");
    const std::vector<Spectrum> responses = channel_responses(s.camera, SpectralGrid(s.spectrum_edges_um));
    ASSERT_EQ(responses.size(), 3u);
    double blue_over_red = 0, red = 0;
    for (const auto& [dx, dy, channel] : {std::tuple{0, 0, 0u}, {1, 0, 1u}, {0, 1, 1u}, {1, 1, 2u}}) {
        const Told told = tell(s, {kLeft_px + 4 + 3 + dx, kLeft_px + 4 + 2 + dy}, channel);
        EXPECT_NEAR(told.electrons("sum") / told.radiance_e, 1, 1e-5) << channel;
        if (channel == 0) red = told.electrons("sum");
        if (channel == 2) blue_over_red = told.electrons("sum") / red;
    }
    EXPECT_GT(std::abs(blue_over_red - 1), 0.05);  // or the test could not tell them apart
}

TEST_F(PixelReport, NamesTheSurface) {
    const Told told = tell(plate(""), {31, 31});
    EXPECT_THAT(told.text, HasSubstr("pixel 31 31 of "));
    EXPECT_THAT(told.text, HasSubstr("Sent by what the camera sees:"));
    EXPECT_THAT(told.text, HasSubstr("object 'plate', surface '"));
    EXPECT_THAT(told.text,
                HasSubstr(" of 2 at level of detail 0, 4 m from the camera, fills 100 % of the pixel"));
    EXPECT_THAT(told.text, Not(HasSubstr("Without a surface")));
}

// The renderer has turning parts as objects of their own, behind all others.
TEST_F(PixelReport, NamesATurningPart) {
    write("winged.obj",
          "v -0.05 -0.05 0\nv 0.05 -0.05 0\nv 0.05 0.05 0\nv -0.05 0.05 0\nv -0.05 0.3 0\nv 0.05 0.3 0\n"
          "g body\nusemtl foil\nf 4 6 3\nf 4 5 6\ng wing\nusemtl cells\nf 1 3 2\nf 1 4 3\n");
    const Told told = tell(
        plate("", {"objects.0.mesh=" + (folder_ / "winged.obj").string(), "objects.0.joints=[{node: wing}]"}),
        {31, 31});
    EXPECT_GT(told.electrons("sum"), 0) << told.text;
    EXPECT_THAT(told.text, HasSubstr("object 'plate/wing', surface 'cells'"));
}

TEST_F(PixelReport, SaysOfNothingThatItIsNothing) {
    const Told told = tell(plate(""), {2, 2});
    EXPECT_EQ(told.radiance_e, 0);
    EXPECT_EQ(told.electrons("sum"), 0);
    EXPECT_EQ(std::count(told.text.begin(), told.text.end(), '\n'), 2) << told.text;
}

// A star is no light of a surface. Its electrons are spread over the pixels about it; the pixel that it lies in has all of them here.
// A star 2.3 degrees off the axis, which is 25.7 pixels: at (56.2, 40.8). It is no light of a surface; its pixel has all of it here.
TEST_F(PixelReport, HasThePointsInThePixel) {
    write("one.csv", "ra_deg,dec_deg,v_mag,b_v\n20,87.7,2,0.6\n");
    const auto file = scenario("", "stars: {catalogue: one.csv}\n");
    const ScenarioConfig s =
        load_scenario(file, Overrides{"camera.exposure_ms=10000", "objects.0.pose.position_m=[0, 0, -4]"});
    StillCamera camera(s);
    camera.render({1, 1});
    double all_e = 0;
    for (const float value : camera.expose().all()) all_e += static_cast<double>(value);
    const Told told = tell(s, {56, 40});
    EXPECT_GT(told.electrons("points"), 0) << told.text;
    EXPECT_NEAR(told.electrons("points") / all_e, 1, 0.05)
        << told.text;  // what the lens spreads beyond the frame
    EXPECT_THAT(told.text, HasSubstr("Without a surface of the scene:\n  points "));
}

TEST_F(PixelReport, SaysThatGroundIsGround) {
    const ScenarioConfig s =
        load_scenario(HILCAM_SOURCE_DIR "/configs/scenarios/lunar_landing.yaml",
                      Overrides{"camera.width_px=64", "camera.height_px=48", "camera.pitch_um=88",
                                "terrain.edge_px=6", "quality.guard_px=8", "camera.exposure_ms=10"});
    const Told told = tell(s, {31, 23});
    EXPECT_GT(told.radiance_e, 1e4);
    EXPECT_NEAR(told.electrons("sum") / told.radiance_e, 1, 1e-5);
    EXPECT_THAT(told.text, HasSubstr("Sent by what the camera sees:\n  direct.sun "));
    EXPECT_THAT(told.text, HasSubstr("\n      the ground\n"));
}

TEST_F(PixelReport, RefusesWhatNoLightReaches) {
    const auto refused = [&](const std::string& camera, FramePixel pixel) {
        return error_of([&] { tell(plate(camera), pixel); });
    };
    EXPECT_EQ(refused("", {64, 3}),
              "--pixel 64 3: the frame has no such pixel; accepted: 0 to 63 and 0 to 63");
    EXPECT_EQ(refused("", {3, -1}),
              "--pixel 3 -1: the frame has no such pixel; accepted: 0 to 63 and 0 to 63");
    EXPECT_EQ(refused(", binning_x: 2", {32, 63}),
              "--pixel 32 63: the frame has no such pixel; accepted: 0 to 31 and 0 to 63");
    EXPECT_EQ(
        refused(", black_columns: 3, black_rows: 2", {2, 30}),
        "--pixel 2 30: is a black pixel, which no light reaches; accepted: one beyond 3 black columns and 2 "
        "black rows");
    EXPECT_EQ(
        refused(", color_filter: " HILCAM_SOURCE_DIR "/configs/filters/RGGB.yaml, binning_x: 2, binning_y: 2",
                {3, 3}),
        "--pixel 3 3: is binned of pixels under several filters; accepted: --set camera.binning_x=1 --set "
        "camera.binning_y=1");
}

}  // namespace
}  // namespace hilcam
