#pragma once
// `hilcam bench --error --zoo FOLDER`: measures the errors of a quality over a family of spacecraft.
//
// A scenario with one object at rest, a camera at rest and no lamps is seen in the views of zoo_views.h. Any
// other scenario keeps its own poses, motions and lamps, and the camera goes to places spaced evenly around
// its first object, as with `bench --error`. In each view a frame at the scenario's quality, and one panned
// by a fraction of a pixel, are compared with the reference (zoo_reference.h).

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "emulator/tradeoff/picture_judge.h"
#include "emulator/zoo/grid_energy.h"
#include "emulator/zoo/pan_change.h"
#include "emulator/zoo/surface_blocks.h"
#include "emulator/zoo/zoo_entries.h"
#include "io/cache/cache.h"

namespace hilcam {

struct ZooOptions {
    std::filesystem::path folder;
    bool all_views = false;
    ZooEntriesOptions entries;
    // Half the sensor's noise; its square is a quarter of the noise power that a frame has anyway.
    ReferenceLimits reference{.standard_error_sigma = 0.5, .max_frames = 64};
    std::vector<std::string> reference_set;  // KEY=VALUE for the references, applied last
};

// Figures of a view, or of all views of a member together. Counts and powers are added up, errors in sensor
// noise are taken over all pixels, and centroid and photometry are those of the worst view.
struct ZooFigures {
    NoiseError error;      // error of lit pixels on objects and near them, in sensor noise
    double error_rms = 0;  // without the contribution of the reference's own error
    NoiseError reference;  // standard error of the reference on the same pixels
    BlockCounts blocks;
    GridEnergy grid;
    PanChange pan;
    double false_lights = 0, lost_lights = 0;    // pixels
    std::optional<double> centroid_px;           // empty: no target, or no light from it
    std::optional<double> photometric_fraction;  // magnitude
    double core_ms = 0;                          // processor time of a frame; mean over all views
};

struct ZooViewFigures : ZooFigures {
    std::string name;
    std::vector<std::string> overrides;  // KEY=VALUE with which `hilcam render` shows the view
    int reference_frames = 0;
    double reference_seconds = 0;
};

struct ZooMember {
    std::string name;
    std::string scenario;                // name of its file
    std::vector<std::string> overrides;  // KEY=VALUE that the zoo replaces in the file
    std::int64_t width_px = 0, height_px = 0;
    std::vector<ZooViewFigures> views;
    ZooFigures all;
};

struct ZooBench {
    std::vector<ZooMember> members;
    bool all_views = false;
    std::int64_t picture_px = 0;
    std::vector<std::string> overrides;
};

// Throws InputError, DeviceError. Owner thread.
ZooBench zoo_bench(const ZooOptions& options, const Cache& cache,
                   const std::function<void(const std::string&)>& log);
nlohmann::json zoo_bench_json(const ZooBench& result);
std::string zoo_bench_text(const ZooBench& result);

}  // namespace hilcam
