#include "emulator/run/render_command.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/plate.h"

namespace hilcam {
namespace {

using testing::HasSubstr;
using Overrides = std::vector<std::string>;

// A picture as OpenEXR's readers have it.
struct Picture {
    Imath::Box2i display, data;
    std::vector<float> values;

    // The mean place of the pixels above half of the brightest one, in the file's own coordinates [px].
    Vec2d centre() const {
        const float most = *std::max_element(values.begin(), values.end());
        const int width = data.max.x - data.min.x + 1;
        Vec2d sum;
        double count = 0;
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (!(values[i] > most / 2)) continue;
            sum.x += data.min.x + static_cast<int>(i) % width + 0.5;
            sum.y += data.min.y + static_cast<int>(i) / width + 0.5;
            ++count;
        }
        return {sum.x / count, sum.y / count};
    }
};

class RenderToFile : public PlateTest {
  protected:
    static Picture read(const std::filesystem::path& file, const char* channel) {
        Imf::InputFile in(file.c_str());
        Picture out{in.header().displayWindow(), in.header().dataWindow(), {}};
        const Imath::V2i size = out.data.size() + Imath::V2i(1, 1);
        out.values.resize(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
        Imf::FrameBuffer buffer;
        buffer.insert(channel, Imf::Slice::Make(Imf::FLOAT, out.values.data(), out.data));
        in.setFrameBuffer(buffer);
        in.readPixels(out.data.min.y, out.data.max.y);
        return out;
    }
    static std::vector<std::string> channels_of(const std::filesystem::path& file) {
        const Imf::InputFile in(file.c_str());
        std::vector<std::string> out;
        for (auto channel = in.header().channels().begin(); channel != in.header().channels().end();
             ++channel)
            out.emplace_back(channel.name());
        return out;
    }
    // A plate in the Sun and a lamp's light.
    ScenarioConfig lit_plate(const std::string& edges_um) {
        return load_scenario(scenario("", "lamps: [{name: flood, intensity_w_sr_um: 100}]\n"),
                             Overrides{"spectrum_edges_um=" + edges_um});
    }
};

// Black columns are left of what is exposed, black rows above it; the guard band is about that.
TEST_F(RenderToFile, EveryStageAndTheTruthPutTheFrameAtTheSamePlace) {
    const auto file = scenario(", black_columns: 3, black_rows: 2");
    for (const int oversampling : {1, 2}) {
        const std::vector<std::string> overrides = {"quality.guard_px=16",
                                                    "objects.0.pose.position_m=[0.05, -0.03, 4]",
                                                    "quality.oversampling=" + std::to_string(oversampling)};
        const ScenarioConfig s = load_scenario(file, overrides);
        render_to_files(s, PictureStage::kRadiance, 0,
                        {.out = folder_ / "radiance.exr", .truth = folder_ / "truth", .overwrite = true});
        render_to_files(s, PictureStage::kElectrons, 0, {.out = folder_ / "electrons.exr"});
        const Picture radiance = read(folder_ / "radiance.exr", "Y"),
                      electrons = read(folder_ / "electrons.exr", "Y"),
                      object = read(folder_ / "truth" / "radiance.truth.exr", "object.ID");
        const Imath::Box2i frame({0, 0}, {66, 65});
        for (const Imath::Box2i& window : {electrons.display, electrons.data, object.display, object.data})
            EXPECT_EQ(window, frame);
        const int m = oversampling;
        EXPECT_EQ(radiance.display, Imath::Box2i({0, 0}, {67 * m - 1, 66 * m - 1}));
        EXPECT_EQ(radiance.data, Imath::Box2i({(3 - 16) * m, (2 - 16) * m}, {83 * m - 1, 82 * m - 1}));
        const Vec2d truth = object.centre(), charge = electrons.centre(), wide = radiance.centre();
        const Vec2d light{wide.x / m, wide.y / m};
        EXPECT_NEAR(truth.x, 3 + 32 + 8, 0.51);
        for (const Vec2d& centre : {light, charge}) {
            EXPECT_NEAR(centre.x, truth.x, 0.3);
            EXPECT_NEAR(centre.y, truth.y, 0.3);
        }
    }
}

// Each bin of the picture is the sum of the layers' bins, one by one in their order, to the last bit.
TEST_F(RenderToFile, LayersOfPartsAddUpToThePicture) {
    const ScenarioConfig s = lit_plate("[0.5, 0.6055, 0.7]");
    const auto file = folder_ / "parts.exr", plain_file = folder_ / "plain.exr";
    render_to_files(s, PictureStage::kRadiance, 0, {.out = file, .parts = true});
    render_to_files(s, PictureStage::kRadiance, 0, {.out = plain_file});
    const std::vector<std::string> names = channels_of(file);
    EXPECT_EQ(names.size(), (kLightParts + 1) * 3);
    // The colour blue has no bin.
    for (const std::string_view part : kLightPartNames)
        for (const char* const channel : {".L_500_605p5nm", ".L_605p5_700nm", ".Y"})
            EXPECT_EQ(std::count(names.begin(), names.end(), std::string(part) + channel), 1)
                << part << channel;
    for (const auto& [bin, layer_bin] :
         {std::pair{"L_0.500_0.606um", ".L_500_605p5nm"}, std::pair{"L_0.606_0.700um", ".L_605p5_700nm"}}) {
        const Picture picture = read(file, bin), plain = read(plain_file, bin);
        std::vector<float> sum(picture.values.size());
        for (std::size_t part = 0; part < kImageParts; ++part) {
            const Picture layer = read(file, (std::string(kLightPartNames[part]) + layer_bin).c_str());
            for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += layer.values[i];
        }
        EXPECT_EQ(sum, picture.values) << bin;
        EXPECT_GT(*std::max_element(sum.begin(), sum.end()), 0) << bin;
        // A pixel adds up two parts of 256 rays in another order: 512 times half a unit in the last place at most.
        for (std::size_t i = 0; i < sum.size(); ++i)
            ASSERT_NEAR(sum[i], plain.values[i], 512 * 6e-8f * plain.values[i]) << bin;
        for (const char* const part : {"direct.sun", "direct.lamps"}) {
            const Picture layer = read(file, (std::string(part) + layer_bin).c_str());
            EXPECT_GT(*std::max_element(layer.values.begin(), layer.values.end()), 0) << part;
        }
    }
}
TEST_F(RenderToFile, LayersOfOneBinAreGrey) {
    const auto file = folder_ / "parts.exr";
    render_to_files(lit_plate("[0.5, 0.7]"), PictureStage::kRadiance, 0, {.out = file, .parts = true});
    std::vector<std::string> expected = {"Y"};
    for (const std::string_view part : kLightPartNames) expected.push_back(std::string(part) + ".Y");
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(channels_of(file), expected);
}

// What cannot be is refused before anything is rendered, and nothing is written.
TEST_F(RenderToFile, PartsAndPixelsThatCannotBeAreRefused) {
    const auto file = scenario();
    const auto refused = [&](PictureStage stage, const RenderFiles& files,
                             const std::string& override = "seed=1") {
        const ScenarioConfig s = load_scenario(file, Overrides{override});
        const std::string error = error_of([&] { render_to_files(s, stage, 0, files); });
        EXPECT_FALSE(std::filesystem::exists(folder_ / "p.exr"));
        EXPECT_FALSE(std::filesystem::exists(folder_ / "p.png"));
        return error;
    };
    const auto exr = folder_ / "p.exr", png = folder_ / "p.png";
    EXPECT_EQ(refused(PictureStage::kFrame, {.out = png, .parts = true}),
              "--parts: they are parts of the light at the lens; accepted with --stage radiance");
    EXPECT_EQ(refused(PictureStage::kRadiance, {.out = exr, .parts = true}, "quality.motion=exact"),
              "--parts and --pixel: quality.motion: found exact, which averages several instants; the light "
              "of one can be "
              "taken apart; accepted: fast, off");
    EXPECT_EQ(refused(PictureStage::kFrame, {.out = png, .pixel = FramePixel{64, 0}}),
              "--pixel 64 0: the frame has no such pixel; accepted: 0 to 63 and 0 to 63");
    for (const auto& [files, option] :
         {std::pair{RenderFiles{.out = {}, .parts = true, .pixel = FramePixel{1, 1}}, std::string("--parts")},
          std::pair{RenderFiles{.out = {}, .view = png, .pixel = FramePixel{1, 1}}, "--view " + png.string()},
          std::pair{RenderFiles{.out = {}, .truth = folder_ / "truth", .pixel = FramePixel{1, 1}},
                    "--truth " + (folder_ / "truth").string()}})
        EXPECT_EQ(refused(option == "--parts" ? PictureStage::kRadiance : PictureStage::kFrame, files),
                  option + ": goes with a picture, and there is none; accepted: --out FILE beside it");
    const ScenarioConfig ground =
        load_scenario(HILCAM_SOURCE_DIR "/configs/scenarios/lunar_landing.yaml",
                      Overrides{"quality.ground_step_px=2", "camera.width_px=64", "camera.height_px=48"});
    EXPECT_EQ(error_of([&] {
                  render_to_files(ground, PictureStage::kFrame, 0, {.out = {}, .pixel = FramePixel{1, 1}});
              }),
              "--pixel: three of four pixels of the ground are interpolated; found quality.ground_step_px: "
              "2; accepted: --set quality.ground_step_px=1");
}

// The report goes to the standard output, beside a picture or alone.
TEST_F(RenderToFile, APixelIsToldWithAndWithoutAPicture) {
    const ScenarioConfig s = load_scenario(scenario(), {});
    const auto told = [&](const std::filesystem::path& out) {
        testing::internal::CaptureStdout();
        render_to_files(s, PictureStage::kFrame, 0, {.out = out, .pixel = FramePixel{31, 31}});
        return testing::internal::GetCapturedStdout();
    };
    const std::string alone = told({}), beside = told(folder_ / "p.png");
    EXPECT_THAT(alone, HasSubstr("pixel 31 31 of "));
    EXPECT_THAT(alone, HasSubstr("  direct.sun "));
    EXPECT_EQ(alone, beside);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "p.png"));
}

// A run's frames and another picture's labels stay; the same picture may be rendered again.
TEST_F(RenderToFile, NothingOfARunOrOfAnotherPictureIsLost) {
    const ScenarioConfig s = load_scenario(scenario(), {});
    const auto render = [&](const char* out, const char* truth, bool overwrite = false) {
        return error_of([&] {
            render_to_files(s, PictureStage::kFrame, 0,
                            {.out = folder_ / out,
                             .truth = *truth ? folder_ / truth : std::filesystem::path(),
                             .overwrite = overwrite});
        });
    };
    write("frame_00000007.png", "of a run");
    EXPECT_THAT(render("frame_00000007.png", ""), HasSubstr("frame_00000007.png: is a frame of a run"));
    EXPECT_EQ(render("frame_00000008.png", ""), "no error");
    EXPECT_EQ(render("view.png", ""), "no error");
    EXPECT_EQ(render("view.png", ""), "no error");

    std::filesystem::create_directory(folder_ / "labels");
    write("labels/truth.jsonl", "of a run\n");
    EXPECT_EQ(render("view.png", "labels"), "no error");
    EXPECT_EQ(std::filesystem::file_size(folder_ / "labels/truth.jsonl"), 9u);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "labels/view.truth.exr"));
    EXPECT_THAT(
        render("view.png", "labels"),
        HasSubstr("labels/view.truth.jsonl: is the truth of a picture that is there already; accepted: "
                  "another name, or --overwrite"));
    EXPECT_EQ(render("view.png", "labels", true), "no error");

    std::ifstream in(folder_ / "labels/view.truth.jsonl");
    std::vector<nlohmann::json> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(nlohmann::json::parse(line));
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_EQ(lines[0]["run"]["id"].get<std::string>().size(), 16u);
    EXPECT_EQ(lines[0]["run"]["seed"].get<int>(), 1);
    EXPECT_EQ(lines[1]["frame"].get<int>(), 1);
}

// The frame of a camera of a bench is the frame that the camera takes alone in its place, but for its noise.
TEST_F(RenderToFile, AnyCameraOfABench) {
    const ScenarioConfig s = load_scenario(
        scenario(
            "",
            "more_cameras:\n  - {position_m: [0.05, 0, 0], camera: {name: right, width_px: 32, height_px: "
            "32, pitch_um: 10,\n      focal_length_mm: 6.4, f_number: 8, transmission: 0.01, "
            "quantum_efficiency: 0.5, full_well_e: 20000,\n      gain_dn_e: 0.2, bits: 12, exposure_ms: "
            "20}}\n"),
        {});
    render_to_files(s, PictureStage::kElectrons, 0, {.out = folder_ / "left.exr"}, 1);
    render_to_files(s, PictureStage::kElectrons, 0, {.out = folder_ / "right.exr"}, 2);
    const Picture left = read(folder_ / "left.exr", "Y"), right = read(folder_ / "right.exr", "Y");
    EXPECT_EQ(left.data.max.x, 63);
    EXPECT_EQ(right.data.max.x, 31);
    // 0.05 m at 4 m and 640 px of focal length: 8 px, in pictures of 64 and 32 px.
    EXPECT_NEAR(left.centre().x - 32 - (right.centre().x - 16), 8, 0.3);
}

}  // namespace
}  // namespace hilcam
