#pragma once
// The figures of a cloned camera as a list: what the frames show, with one standard deviation, and what stays
// the data sheet's because they do not show it.

#include <optional>
#include <string>
#include <vector>

#include "emulator/clone/clone_measurement.h"

namespace hilcam {

struct CloneFigure {
    std::string key;    // key of the camera file, or a name of that kind
    std::string label;  // for tables
    std::string unit;
    std::optional<Measured> measured;  // nothing: the frames do not tell it
    double sheet = 0;                  // value of the camera of --like
    std::string why;                   // why the frames do not tell it
};
// Returns the figures in the order of the tables.
std::vector<CloneFigure> clone_figures(const CloneMeasurement& clone, const CameraModel& like);
// Returns the figure with that key. HILCAM_CHECK: it exists.
const CloneFigure& figure_of(const std::vector<CloneFigure>& figures, const char* key);

}  // namespace hilcam
