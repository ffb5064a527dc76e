#pragma once
// A camera's maps hold what differs from pixel to pixel and stays; they are drawn from its seed or read from
// files.
//
// EMVA 1288 release 4.0 terms: PRNU is the standard deviation of the pixels' gains over their mean, DSNU that
// of their dark signals. All draws are Gaussian and keyed by the pixel's place on the whole sensor, so a
// window shows the pixels that it shows on the real one; gains and dark currents are cut off at zero. A
// line-scan camera has one row of pixels: its maps repeat from line to line, and PRNU and dark pattern are
// means over the TDI stages already.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "render/vocabulary/config_field.h"
#include "render/vocabulary/image.h"

namespace hilcam {

struct FixedPatternConfig {
    std::int64_t seed = 1;
    double dark_current_fraction = 0;  // standard deviation of the pixels' dark currents over their mean
    double row_e = 0;                  // standard deviation of the rows' offsets
    double column_e = 0;               // spread of the columns' offsets
    double column_gain_fraction = 0;   // spread of the columns' gains
    std::filesystem::path prnu_map;    // pictures of the whole sensor: gain of each pixel (mean 1)
    std::filesystem::path offset_map;  // offset of each pixel [e-]
    std::filesystem::path dark_map;    // dark current of each pixel at the operating temperature [e-/s]
};
Fields fields(FixedPatternConfig& config);

// A number for every pixel of the sensor.
using PixelMap = Image<float, struct PixelMapQuantity>;
// The files' pictures; one without a size was not given.
struct DetectorPictures {
    PixelMap prnu, offset_e, dark_e_s;
};

// Pixels that do not work. Hot: more dark current, exponentially distributed. Dead: no response. Telegraph:
// two states of the offset, drawn anew every telegraph_frames frames (random telegraph noise of a trap, its
// dwell time a geometric distribution).
struct DefectsConfig {
    double hot_fraction = 0;
    double hot_e_s = 0;  // mean dark current of a hot pixel, at the operating temperature
    double dead_fraction = 0;
    std::vector<double> dead_columns;  // numbers of columns
    std::vector<double> hot_columns;   // all their pixels are hot
    double telegraph_fraction = 0;
    double telegraph_e = 0;  // between the two states
    std::int64_t telegraph_frames = 8;
};
Fields fields(DefectsConfig& config);

// A pixel with random telegraph noise, in the read-out array.
struct TelegraphPixel {
    int x = 0, y = 0;
    std::uint32_t pixel = 0;  // keys its draws
};

struct CameraModel;

// The read-out array's maps, drawn once. A map of no size is the same for all pixels (gain 1, offset 0).
struct FixedPattern {
    PixelMap gain;                          // gain from light to charge
    PixelMap dark_e_s;                      // mean dark current
    PixelMap offset_e;                      // added to the charge when it is read
    double uniform_dark_e_s = 0;            // when there is no map
    std::vector<TelegraphPixel> telegraph;  // by row
};
// InputError when a picture has another size than the sensor. Owner thread.
FixedPattern draw_fixed_pattern(const CameraModel& camera, const DetectorPictures& pictures);

}  // namespace hilcam
