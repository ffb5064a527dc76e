#include "sensor/fixed_pattern.h"

namespace hilcam {

Fields fields(FixedPatternConfig& c) {
    return {
        integer("seed", c.seed, {0, 9e15}, "of the camera's own pattern: another seed, another specimen"),
        number("dark_current_fraction", c.dark_current_fraction, 1, {0, 10},
               "standard deviation of the pixels' dark currents over their mean"),
        number("row_e", c.row_e, 1, {0, 1e5}, "standard deviation of the rows' offsets"),
        number("column_e", c.column_e, 1, {0, 1e5}, "standard deviation of the columns' offsets"),
        number("column_gain_fraction", c.column_gain_fraction, 1, {0, 0.5},
               "standard deviation of the columns' gains"),
        path("prnu_map", c.prnu_map, "TIFF of the sensor's size: gain of each pixel, mean 1"),
        path("offset_map", c.offset_map, "TIFF of the sensor's size: offset of each pixel [e-]"),
        path("dark_map", c.dark_map, "TIFF of the sensor's size: dark current of each pixel [e-/s]"),
    };
}

Fields fields(DefectsConfig& c) {
    return {
        number("hot_fraction", c.hot_fraction, 1, {0, 1}, "of the pixels"),
        number("hot_e_s", c.hot_e_s, 1, {0, 1e9}, "mean of their extra dark current"),
        number("dead_fraction", c.dead_fraction, 1, {0, 1}, "of the pixels"),
        numbers("dead_columns", c.dead_columns, 1, {0, 16383}, {0, 1024}, "counted from 0"),
        numbers("hot_columns", c.hot_columns, 1, {0, 16383}, {0, 1024}, "counted from 0"),
        number("telegraph_fraction", c.telegraph_fraction, 1, {0, 1}, "of the pixels"),
        number("telegraph_e", c.telegraph_e, 1, {0, 1e5}, "between a telegraph pixel's two states"),
        integer("telegraph_frames", c.telegraph_frames, {1, 1e6}, "between two draws of its state"),
    };
}

}  // namespace hilcam
