#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "emulator/scenario/app_config.h"
#include "emulator/scenario/scene_loader.h"
#include "io/config/config_yaml.h"
#include "io/images/image_file.h"
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

CameraModel camera_with(const std::string& line) {
    CameraModel camera;
    read_config_text(
        "width_px: 64\nheight_px: 64\npitch_um: 5\nfocal_length_mm: 10\nf_number: 4\nquantum_efficiency: "
        "0.5\n"
        "full_well_e: 1e4\ngain_dn_e: 0.2\nbits: 12\n" +
            line + "\n",
        "cam.yaml", ".", section_of(camera));
    return camera;
}

// The formulas that stand in configs/filters/generic_rgb.yaml.
double generic_dye(char name, double w_um) {
    const auto band = [&](double at_um) { return std::exp(-0.5 * std::pow((w_um - at_um) / 0.038, 2)); };
    const auto edge = [&](double at_um, double width_um) {
        return 1 / (1 + std::exp(-(w_um - at_um) / width_um));
    };
    const double value = name == 'R'   ? 0.85 * edge(0.590, 0.008)
                         : name == 'G' ? std::max(0.78 * band(0.535), 0.90 * edge(0.800, 0.018))
                                       : std::max(0.80 * band(0.460), 0.90 * edge(0.820, 0.018));
    return std::max(0.03, value);
}

TEST(Configs, ABayerPatternIsNamedByItsWordAndHasTheGenericDyes) {
    const std::pair<const char*, const char*> arrays[] = {
        {"RGGB", "RG GB"}, {"GRBG", "GR BG"}, {"GBRG", "GB RG"}, {"BGGR", "BG GR"}, {"rggb", "RG GB"}};
    for (const auto& [name, pattern] : arrays) {
        const CameraModel camera = camera_with("color_filter: " + std::string(name));
        EXPECT_EQ(camera.color_filter.pattern, pattern);
        ASSERT_EQ(camera.color_filter.filters.size(), 3u);
        for (const ColorFilterConfig& filter : camera.color_filter.filters) {
            ASSERT_GT(filter.transmission.wavelength_um.size(), 30u);
            for (std::size_t i = 0; i < filter.transmission.value.size(); ++i)
                EXPECT_NEAR(filter.transmission.value[i],
                            generic_dye(filter.name[0], filter.transmission.wavelength_um[i]), 0.00501)
                    << filter.name << " at " << filter.transmission.wavelength_um[i];
        }
    }
    EXPECT_TRUE(camera_with("color_filter: mono").color_filter.pattern.empty());
    EXPECT_EQ(camera_with("color_filter: {pattern: BG GR, filters: generic_rgb}").color_filter.filters.size(),
              3u);
}

TEST(Configs, AColourFilterThatIsNoneSaysWhatIs) {
    const auto message = [](const std::string& line) {
        try {
            camera_with(line);
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("taken");
    };
    EXPECT_THAT(message("color_filter: RGGX"), HasSubstr("'hilcam list filters'); nearest: RGGB; "));
    // Stripes, where a mosaic was meant.
    EXPECT_THAT(
        message("color_filter: {pattern: RGGB, filters: generic_rgb}"),
        HasSubstr("found 'RGGB', which is one row; accepted: RG GB; or all of it as color_filter: RGGB"));
    EXPECT_THAT(message("color_filter: {pattern: RG GB}"),
                HasSubstr("'filters: generic_rgb' has R, G and B"));
    EXPECT_THAT(
        message("color_filter: {pattern: RG GB, filters: generic}"),
        HasSubstr("found 'generic'; accepted: a list of mappings, or the path of a file that holds it"));
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
