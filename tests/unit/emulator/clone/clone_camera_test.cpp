// The text of a cloned camera: what was measured replaces what the other camera's file says.

#include "emulator/clone/clone_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "emulator/scenario/scene_loader.h"
#include "io/config/config_yaml.h"

namespace hilcam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

TEST(CloneCamera, KeysAreTakenOutWithAllTheirLines) {
    const std::string yaml =
        "# yaml-language-server: $schema=x\n# About it.\nname: a\nsource: >-\n  long\n  text\nbits: 12   # "
        "twelve\n"
        "quantum_efficiency: [[0.4, 0.3],\n                     [0.8, 0.2]]\ndefects:\n  hot_fraction: 1\n\n"
        "# Lens.\nf_number: 4\n\"dsnu_e\": 3\n";
    EXPECT_EQ(without_keys(yaml, {"source", "bits", "defects", "dsnu_e"}),
              "# About it.\nname: a\nquantum_efficiency: [[0.4, 0.3],\n                     [0.8, 0.2]]\n"
              "# Lens.\nf_number: 4\n");
}

TEST(CloneCamera, TheFileIsReadBackWithItsMaps) {
    const fs::path folder = fs::temp_directory_path() / ("hilcam_clone_camera_" + std::to_string(getpid()));
    fs::create_directories(folder);
    const std::string yaml =
        "name: like\nsource: somebody's sheet\nwidth_px: 4\nheight_px: 2\npitch_um: 5\nfocal_length_mm: 20\n"
        "f_number: 4\nbits: 12\nquantum_efficiency: 0.5\nfull_well_e: 1000\ngain_e_dn: 2\ndsnu_e: "
        "9\nread_noise_e: 30\n"
        "fixed_pattern:\n  row_e: 5\n";
    std::ofstream(folder / "like.yaml") << yaml;
    CloneSource source{"lab/frames", 640, folder / "like.yaml", {}, {"focal_length_mm=35"}};
    read_config(source.like_file, section_of(source.like), source.overrides);
    CloneMeasurement m;
    m.width = 4, m.height = 2, m.bits = 10, m.temperature_c = 31, m.temperature_told = true;
    m.good = PixelSelection(0, 0, 4, 2);
    m.gain_dn_e = {0.25, 0.0004}, m.offset_dn = {31.5, 0.01}, m.read_noise_e = {4.5, 0.02};
    m.dark_current_e_s = Measured{12.5, 0.1};
    m.offset_e.value = {-3, 1, 2, 0, 0, 0, 0, 0};
    m.gain.value = {1, 1.01, 0.99, 1, 1, 1, 1, 0};
    m.dark_e_s.value = {12, 13, 12, 13, 500, 12, 12, 12};
    m.defects = {
        {DefectKind::kHot, 0, 1, 500}, {DefectKind::kDead, 3, 1, 0}, {DefectKind::kBlinking, 2, 0, 25}};
    m.blinking_frames = {3.2, 0.2};
    write_clone(m, source, folder / "mine.yaml");

    CameraModel c;
    read_config(folder / "mine.yaml", section_of(c));
    EXPECT_EQ(c.name, "like-clone");
    EXPECT_THAT(c.source,
                HasSubstr("hilcam clone of 640 frames in frames; the rest as like: somebody's sheet"));
    EXPECT_DOUBLE_EQ(c.gain_dn_e, 0.25);
    EXPECT_EQ(c.bits, 10);
    EXPECT_DOUBLE_EQ(c.focal_length_m, 0.035);
    EXPECT_EQ(c.dsnu_e, 0);
    EXPECT_EQ(c.fixed_pattern.row_e, 0);
    EXPECT_EQ(c.temperature_c, 31);
    EXPECT_EQ(c.dark_reference_c, 31);
    EXPECT_EQ(c.full_well_e, 1000);
    EXPECT_EQ(c.defects.telegraph_frames, 3);
    const FixedPattern p = draw_fixed_pattern(c, load_detector_pictures(c));
    EXPECT_EQ(p.offset_e.row(0)[0], -3.0f);
    EXPECT_EQ(p.gain.row(0)[1], 1.01f);
    EXPECT_EQ(p.gain.row(1)[3], 0.0f);
    EXPECT_EQ(p.dark_e_s.row(1)[0], 500.0f);
    ASSERT_EQ(p.telegraph.size(), 1u);
    EXPECT_EQ(p.telegraph[0].height_e, 25.0f);

    const std::string text = clone_yaml(m, source, "mine_maps");
    EXPECT_THAT(text, HasSubstr("gain_dn_e: 0.25               # +- 0.0004\n"));
    EXPECT_THAT(text, HasSubstr("# --- What the frames do not tell: as of like\n"));
    EXPECT_THAT(text, HasSubstr("# full_well_e: no flat beyond it\n"));
    EXPECT_THAT(text, HasSubstr("focal_length_mm: 35   # --set\n"));
    EXPECT_THAT(text, Not(HasSubstr("focal_length_mm: 20")));
    EXPECT_THAT(text, Not(HasSubstr("gain_e_dn")));
    fs::remove_all(folder);
}

}  // namespace
}  // namespace hilcam
