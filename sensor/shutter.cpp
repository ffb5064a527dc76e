#include "sensor/shutter.h"

namespace hilcam {

Fields fields(ShutterConfig& c) {
    return {
        choice("kind", c.kind, {"global", "rolling", "frame_transfer", "line_scan"},
               "kind of shutter, which determines when each row is exposed"),
        optional(number("line_time_us", c.line_time_s, 1e-6, {1e-3, 1e7},
                        "time from one row to the next; unused by global"),
                 c.has_line_time),
        integer("tdi_stages", c.tdi_stages, {1, 1024}, "line_scan: number of rows summed into each line"),
        integer("tdi_phases", c.tdi_phases, {1, 16}, "line_scan: number of charge steps per pixel"),
        number("tdi_mismatch_fraction", c.tdi_mismatch_fraction, 1, {-0.5, 0.5},
               "line_scan: relative difference between image speed and charge speed"),
    };
}

}  // namespace hilcam
