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
    double period_s = 0;  // from frame to frame; 0: frames are asked for
    std::optional<FrameTime> frame_time;
    std::vector<std::string> plan;  // a line each, with its reason

    // A frame took longer on this machine than it has. Not a warning: it depends on what else the machine
    // did. Both stages share the cores, also where one frame's rendering overlaps the sensing of the one
    // before.
    bool is_late() const {
        return frame_time && period_s > 0 && frame_time->render_ms + frame_time->sensor_ms > 1e3 * period_s;
    }
};

struct CheckReport {
    std::string scenario;
    TimeTai time;
    std::size_t cameras = 1;            // cameras of the bench; those asked for are below
    std::vector<std::string> warnings;  // remarks on what is probably not meant, a line each
    std::vector<CameraReport> reports;
    std::vector<std::string> maps;  // readings of the maps, a line each
    std::vector<std::string> run;   // seed, loop, governor
    double memory_mb = 0;           // memory with the last camera loaded; 0: not known
};

std::string to_text(const CheckReport& report);
std::string to_json(const CheckReport& report);
// A camera's data sheet, and what is probably not meant in it.
std::string to_json(const CameraSheet& sheet, const std::vector<std::string>& warnings);

}  // namespace hilcam
