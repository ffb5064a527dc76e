#pragma once
// Maps of a camera's constant differences between pixels, drawn from a seed or read from files.
//
// In the terms of EMVA 1288 release 4.0, PRNU is the relative standard deviation of the pixels' gains, DSNU
// the standard deviation of their dark signals. All draws are Gaussian and keyed by the pixel's position on
// the whole sensor, so a window shows the same pixels as the whole sensor does. Gains and dark currents are
// cut off at zero. A line-scan camera has one row of pixels: its maps repeat from line to line, and its PRNU
// and dark pattern are already means over the TDI stages.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "render/vocabulary/config_field.h"
#include "render/vocabulary/image.h"

namespace hilcam {

struct FixedPatternConfig {
    std::int64_t seed = 1;
    double dark_current_fraction = 0;  // relative standard deviation of the pixels' dark currents
    double row_e = 0;                  // standard deviation of the rows' offsets
    double column_e = 0;               // standard deviation of the columns' offsets
    double column_gain_fraction = 0;   // standard deviation of the columns' gains
    std::filesystem::path prnu_map;    // picture of the whole sensor: each pixel's gain (mean 1)
    std::filesystem::path offset_map;  // each pixel's offset [e-]
    std::filesystem::path dark_map;    // each pixel's dark current at dark_map_c [e-/s]
    double dark_map_c = 0;             // only if has_dark_map_c; else the operating temperature
    bool has_dark_map_c = false;
};
Fields fields(FixedPatternConfig& config);

// A value for every pixel of the sensor.
using PixelMap = Image<float, struct PixelMapQuantity>;
// A defective pixel of one particular sensor, by its place on it.
enum class DefectKind { kHot, kDead, kBlinking };
struct ListedDefect {
    DefectKind kind = DefectKind::kHot;
    int x = 0, y = 0;
    double value =
        0;  // hot: its dark current at dark_map_c [e-/s]; blinking: its two states' difference [e-]
};
// Maps and list from the files; an empty image means that the file was not given.
struct DetectorPictures {
    PixelMap prnu, offset_e, dark_e_s;
    std::vector<ListedDefect> defects;
};

// Pixels that do not work properly. Hot: more dark current, exponentially distributed. Dead: no response.
// Telegraph: the offset has two states, drawn every telegraph_frames frames (random telegraph noise of a
// trap, with geometrically distributed dwell times).
struct DefectsConfig {
    double hot_fraction = 0;
    double hot_e_s = 0;  // mean dark current of a hot pixel, at the operating temperature
    double dead_fraction = 0;
    std::vector<double> dead_columns;  // column numbers
    std::vector<double> hot_columns;   // all pixels of these columns are hot
    double telegraph_fraction = 0;
    double telegraph_e = 0;  // difference between the two states
    std::int64_t telegraph_frames = 8;
    std::filesystem::path list;  // CSV: kind, x, y, value of pixels in addition to those that are drawn
};
Fields fields(DefectsConfig& config);

// A pixel with random telegraph noise, by its position in the read-out array.
struct TelegraphPixel {
    int x = 0, y = 0;
    std::uint32_t pixel = 0;  // key for its random numbers
    float height_e = 0;       // difference between its two states
};

struct CameraModel;

// Maps of the read-out array, drawn once. An empty map is uniform (gain 1, offset 0).
struct FixedPattern {
    PixelMap gain;                          // gain from light to charge
    PixelMap dark_e_s;                      // mean dark current
    PixelMap offset_e;                      // added to the charge when it is read out
    double uniform_dark_e_s = 0;            // used without a map
    std::vector<TelegraphPixel> telegraph;  // in order of rows
};
// Throws InputError when a map has another size than the sensor, or when a listed pixel is outside it. Owner
// thread.
FixedPattern draw_fixed_pattern(const CameraModel& camera, const DetectorPictures& pictures);

}  // namespace hilcam
