#include <gmock/gmock.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "emulator/scenario/app_config.h"
#include "emulator/scenario/scene_loader.h"
#include "io/config/config_yaml.h"
#include "io/pictures/image_file.h"
#include "render/vocabulary/check.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

TEST(Configs, EveryShippedScenarioLoads) {
    int found = 0;
    for (const auto& entry : std::filesystem::directory_iterator(HILCAM_SOURCE_DIR "/configs/scenarios")) {
        EXPECT_NO_THROW(load_scenario(entry.path(), {})) << entry.path();
        ++found;
    }
    EXPECT_GE(found, 3);
}

TEST(Configs, EveryShippedPartLoads) {
    for (const auto& entry : std::filesystem::directory_iterator(HILCAM_SOURCE_DIR "/configs/cameras")) {
        CameraModel camera;
        EXPECT_NO_THROW(read_config(entry.path(), section_of(camera))) << entry.path();
        EXPECT_FALSE(camera.source.empty()) << entry.path();
    }
    for (const auto& entry : std::filesystem::directory_iterator(HILCAM_SOURCE_DIR "/configs/quality")) {
        QualityConfig quality;
        EXPECT_NO_THROW(read_config(entry.path(), section_of(quality))) << entry.path();
    }
}

// What a camera's file gets wrong is named with its place.
TEST(Configs, AnImpossibleCameraIsRefusedByName) {
    const std::string good =
        "width_px: 64\nheight_px: 64\npitch_um: 5\nfocal_length_mm: 10\nf_number: 4\nquantum_efficiency: "
        "0.5\n"
        "full_well_e: 10000\nbits: 12\n";
    const auto error_of = [&](const std::string& more) -> std::string {
        CameraModel camera;
        try {
            read_config_text(good + more, "camera.yaml", ".", section_of(camera));
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    };
    EXPECT_EQ(error_of("gain_dn_e: 0.3\n"), "no error");
    for (const auto& [more, message] : std::vector<std::pair<std::string, std::string>>{
             {"gain_dn_e: 0\n", "camera.yaml:9:12: gain_dn_e: found '0'"},
             {"", "either gain_dn_e or gain_e_dn; found neither"},
             {"gain_dn_e: 0.3\nread_noise_e: -1\n", "read_noise_e: found '-1'"},
             {"gain_dn_e: 0.3\nquantum_efficency: 0.5\n", "nearest known key: quantum_efficiency"},
             {"gain_dn_e: 0.3\nmeasured_mtf: {mtf: [[0, 1], [50, 1.2]]}\n", "measured_mtf.mtf: found '1.2'"},
             {"gain_dn_e: 0.3\ncontainer_bits: 8\n", "bits 12 do not fit into container_bits 8"},
             {"gain_dn_e: 0.3\ntransmission: [[0.5, 1.5]]\n", "transmission: found '1.5'"},
             {"gain_dn_e: 0.3\nvignetting: [[0.5, 1], [0.5, 0.9]]\n",
              "field_fraction that rises from pair to pair"},
         })
        EXPECT_THAT(error_of(more), HasSubstr(message)) << more;
}

TEST(Configs, AnObjectHasAMeshOrAGenerator) {
    ObjectConfig object;
    EXPECT_THROW(validate(object), InputError);
}

class CameraMaps : public FilesTest {};

TEST_F(CameraMaps, AreReadFromTheirFiles) {
    DnImage gain(64, 64);
    for (std::uint16_t& v : gain.all()) v = 1;
    write_numbers(folder_ / "gain.tiff", gain);
    CameraModel c;
    c.fixed_pattern.prnu_map = folder_ / "gain.tiff";
    const DetectorPictures pictures = load_detector_pictures(c);
    EXPECT_EQ(pictures.prnu.width(), 64);
    EXPECT_EQ(pictures.prnu.row(10)[10], 1.0f);
    EXPECT_EQ(pictures.offset_e.width(), 0);
}

}  // namespace
}  // namespace hilcam
