// The words of data sheets, and that each key which they lead to is one of the camera's.

#include "io/config/data_sheet_words.h"

#include <gmock/gmock.h>

#include "io/config/config_yaml.h"
#include "render/vocabulary/check.h"
#include "sensor/camera_model.h"

namespace hilcam {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string key_of(const char* word) {
    const DataSheetWord* const found = data_sheet_word(word);
    return found ? std::string(found->key) : "none";
}

TEST(DataSheetWords, SpellingAndUnitsDoNotMatter) {
    for (const char* const word :
         {"full_well_capacity", "Full-Well Capacity", "FWC", "fwc_ke", "saturation capacity (e-)"})
        EXPECT_EQ(key_of(word), "camera.full_well_e") << word;
    EXPECT_EQ(key_of("QE"), "camera.quantum_efficiency");
    EXPECT_EQ(key_of("qe_percent"), "camera.quantum_efficiency");
    EXPECT_EQ(key_of("conversion_gain_uv_e"), "camera.gain_dn_e");
    EXPECT_EQ(key_of("temporal_dark_noise"), "camera.read_noise_e");
    EXPECT_EQ(key_of("dynamic_range_db"), "");
    EXPECT_EQ(key_of("framerate"), "camera.frame_rate_hz");
    for (const char* const none : {"", "_", "look_at_m", "focal_lenght_mm"})
        EXPECT_EQ(key_of(none), "none") << none;
}

// What a camera's file with that key is told.
std::string message(const std::string& line) {
    CameraModel camera;
    try {
        read_config_text(line, "cam.yaml", ".", section_of(camera));
    } catch (const InputError& error) {
        return error.what();
    }
    return "taken";
}

TEST(DataSheetWords, AMessageNamesTheKeyAndTheWayToIt) {
    EXPECT_EQ(message("fwc: 13500"),
              "cam.yaml:1:1: fwc: unknown key; a data sheet's word? here it is full_well_e: in electrons: "
              "ke- times 1000");
    EXPECT_THAT(message("conversion_gain: 70"),
                HasSubstr("here it is gain_dn_e: in DN per electron: uV/e- times 2^bits over"));
    EXPECT_THAT(message("sensitivity: 7.7"),
                HasSubstr("there is no key: it follows from quantum_efficiency"));
    // A slip of the pen, and another unit, are told as they are elsewhere.
    EXPECT_THAT(message("full_wel_e: 1"),
                AllOf(HasSubstr("nearest known key: full_well_e"), Not(HasSubstr("data sheet"))));
    EXPECT_THAT(message("exposure_us: 1"), HasSubstr("its unit here is another: exposure_ms"));
}

TEST(DataSheetWords, EveryKeyIsOneOfTheCameras) {
    CameraModel camera;
    std::string known;
    for (const Field& field : fields(camera)) known += " " + field.key + " ";
    for (const char* const word : {"conversion_gain",
                                   "system_gain",
                                   "gain",
                                   "fwc",
                                   "qe",
                                   "spectral_response",
                                   "read_noise",
                                   "ktc",
                                   "dark_current",
                                   "dark_current_doubling",
                                   "prnu",
                                   "dsnu",
                                   "crosstalk",
                                   "pixel_size",
                                   "resolution",
                                   "sensor_size",
                                   "bit_depth",
                                   "black_level",
                                   "fps",
                                   "exposure_time",
                                   "global_shutter",
                                   "line_time",
                                   "f_stop",
                                   "focal_length",
                                   "fov",
                                   "t_stop",
                                   "wfe",
                                   "mtf",
                                   "linearity",
                                   "cte",
                                   "bayer",
                                   "operating_temperature",
                                   "roi",
                                   "model"}) {
        const std::string key = key_of(word);
        ASSERT_TRUE(key.starts_with("camera.")) << word;
        EXPECT_THAT(known, HasSubstr(" " + key.substr(7) + " ")) << word;
    }
}

}  // namespace
}  // namespace hilcam
