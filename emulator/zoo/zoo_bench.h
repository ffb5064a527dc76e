#pragma once
// `hilcam bench --error --zoo FOLDER`: how far off a quality is on a family of spacecraft.
//
// A scenario of one object that stands still, with a camera that does, too, and without lamps is looked at from the views of
// zoo_views.h. Any other scenario keeps its own poses, motions and lamps; the camera stands at places evenly around its
// first object, as with `bench --error`. In each view a frame of the scenario's quality and one that is panned by a fraction of a
// pixel are compared with the reference (zoo_reference.h).

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
    // Half the sensor's noise: its square is a quarter of what a frame has anyway.
    ReferenceLimits reference{.standard_error_sigma = 0.5, .max_frames = 64};
    std::vector<std::string> reference_set;  // KEY=VALUE of the references, after all else
};

// The figures of a view, or of all views of a member together: counts and powers are summed up, errors in sensor noise are over all
// pixels, the centre of light and the light are those of the worst view.
struct ZooFigures {
    NoiseError error;      // error of lit pixels on objects and near them, in sensor noise
    double error_rms = 0;  // without what the reference's own error makes of it
    NoiseError reference;  // the reference's standard error on the same pixels
    BlockCounts blocks;
    GridEnergy grid;
    PanChange pan;
    double false_lights = 0, lost_lights = 0;    // pixels
    std::optional<double> centroid_px;           // none: there is no target, or no light of it
    std::optional<double> photometric_fraction;  // magnitude
    double core_ms = 0;                          // processor time of a frame; of all views, the mean
};

struct ZooViewFigures : ZooFigures {
    std::string name;
    std::vector<std::string> overrides;  // KEY=VALUE with which `hilcam render` shows it
    int reference_frames = 0;
    double reference_seconds = 0;
};

struct ZooMember {
    std::string name;
    std::string scenario;                // its file
    std::vector<std::string> overrides;  // KEY=VALUE that the zoo has in place of the file's
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
