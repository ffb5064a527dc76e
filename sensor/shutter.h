#pragma once
// The times at which rows are exposed.
//
//   global          all rows at once
//   rolling         each row begins `line_time` after the one above it; the middle row has the frame's time
//   frame_transfer  CCD: all rows at once, then each is shifted under the light, `line_time` per row
//   line_scan       one line with tdi_stages rows that follow the ground. A frame is height_px lines,
//                   line_time apart; the exposure is tdi_stages x line_time

#include <cstdint>

#include "render/vocabulary/config_field.h"

namespace hilcam {

enum class ShutterKind { kGlobal, kRolling, kFrameTransfer, kLineScan };

struct ShutterConfig {
    ShutterKind kind = ShutterKind::kGlobal;
    double line_time_s = 20e-6;
    bool has_line_time = false;
    std::int64_t tdi_stages = 1;
    std::int64_t tdi_phases = 1;  // clock phases; the charge moves in steps of 1 / phases of a pixel
    // Relative difference between the image's speed and the charge's; the image drifts by stages x this [px].
    double tdi_mismatch_fraction = 0;
};
Fields fields(ShutterConfig& config);

}  // namespace hilcam
