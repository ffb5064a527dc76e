#pragma once
// The findings of `hilcam check` about a scenario, and its verdict, as text and as JSON.

#include <optional>
#include <string>
#include <vector>

#include "emulator/check/camera_sheet.h"
#include "emulator/check/first_sight.h"
#include "emulator/check/frame_time.h"
#include "render/vocabulary/units.h"

namespace hilcam {

inline double degrees(double rad) { return rad / kDegree_rad; }

struct CameraReport {
    std::size_t number = 1;
    FirstSight sight;
    CameraSheet sheet;
    double share_in_bins = 0;
    double period_s = 0;  // time between frames; 0: frames come on request
    std::optional<FrameTime> frame_time;
    std::vector<std::string> plan;  // one line for each decision, with its reason

    // True when rendering and sensing one frame took longer on this machine than the frame period. Not a
    // warning, as it depends on the machine's other load. The times are added because both stages share the
    // cores, even while one frame is rendered and the previous one sensed.
    bool is_late() const {
        return frame_time && period_s > 0 && frame_time->render_ms + frame_time->sensor_ms > 1e3 * period_s;
    }
};

struct CheckReport {
    std::string scenario;
    TimeTai time;
    std::size_t cameras = 1;            // cameras of the bench; `reports` has those asked for
    std::vector<std::string> warnings;  // probable mistakes, one line each
    std::vector<CameraReport> reports;
    std::vector<std::string> maps;  // readings of the maps, one line each
    std::vector<std::string> run;   // seed, loop, governor
    double memory_mb = 0;           // memory in use with the last camera loaded; 0: unknown
};

std::string to_text(const CheckReport& report);
std::string to_json(const CheckReport& report);
// Returns a camera's data sheet with the probable mistakes in its file.
std::string to_json(const CameraSheet& sheet, const std::vector<std::string>& warnings);

}  // namespace hilcam
