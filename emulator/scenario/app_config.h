#pragma once
// A scenario file: the world, the camera, the quality, the sources of commands and the outputs of frames.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "emulator/events/event_condition.h"
#include "emulator/events/event_config.h"
#include "emulator/scenario/camera_config.h"
#include "emulator/scenario/commands_config.h"
#include "emulator/scenario/fault_config.h"
#include "emulator/scenario/lamp_config.h"
#include "emulator/scenario/motion_config.h"
#include "emulator/scenario/object_config.h"
#include "emulator/scenario/outputs.h"
#include "emulator/scenario/own_body_config.h"
#include "emulator/scenario/quality_config.h"
#include "emulator/scenario/quality_ladder.h"
#include "emulator/scenario/spice_config.h"
#include "emulator/world/clock.h"
#include "emulator/world/world_state.h"
#include "io/commands/telemetry.h"
#include "io/config/key_places.h"
#include "io/lines/lines_config.h"
#include "render/earth/earth_config.h"
#include "render/frame/render_quality.h"
#include "render/sky/atmosphere_config.h"
#include "render/sky/bodies.h"
#include "render/sky/body_photometry.h"
#include "render/sky/sun.h"
#include "sensor/camera_model.h"
#include "sensor/exposure.h"

namespace hilcam {

struct StarsConfig {
    std::filesystem::path catalogue;  // empty: no stars
    std::string catalogue_where;      // place of the key in the scenario
    double faintest_magnitude = 8;
};
Fields fields(StarsConfig& stars);

// The cause of the camera's frames (frame_starter.h).
enum class CameraMode { kFreeRun, kTriggered, kLockstep };

struct PluginConfig {
    std::filesystem::path file;
};
Fields fields(PluginConfig& plugin);

struct ScenarioConfig {
    ScenarioConfig();

    std::string name;
    KeyPlaces places;                   // not a key: where each key is given, for warnings
    std::vector<std::string> warnings;  // not a key: possible mistakes found while reading, one line each
    std::string time_utc = "2026-01-01T00:00:00Z";
    ClockConfig clock;
    std::int64_t seed = 1;
    bool has_seed = false;      // true: stated in the file, or settled by settle_seed()
    bool is_used_once = false;  // not a key: true keeps derived data out of the cache
    std::int64_t threads = 0;
    OriginConfig origin;              // includes the key `earth_orientation`
    std::optional<PlaceConfig> site;  // origin of local axes (site.h)
    CameraModel camera;
    PoseConfig camera_pose;
    bool has_camera_pose = false;
    std::optional<MotionConfig> camera_motion;
    std::optional<LeapSecondsConfig> leap_seconds;
    std::optional<SpiceConfig> spice;
    std::vector<ObjectConfig> objects;
    std::optional<TerrainConfig> terrain;
    std::vector<LampConfig> lamps;
    SunConfig sun;
    std::array<BodyConfig, kBodyCount> bodies;
    std::vector<OwnBodyConfig> own_bodies;
    AtmosphereConfig atmosphere;
    EarthConfig earth_surface;
    std::optional<StarsConfig> stars;
    std::vector<double> spectrum_edges_um = {0.40, 0.52, 0.62, 0.75, 0.95};
    RenderModels models;
    bool has_rays = false;
    std::vector<PluginConfig> plugins;
    QualityConfig quality;
    LoopConfig loop;
    CameraMode mode = CameraMode::kFreeRun;
    Mount mount;  // mount of this scenario's camera; poses place the first camera directly
    std::vector<CameraConfig> more_cameras;  // at most kMaxCameras - 1
    std::vector<FaultConfig> faults;
    std::vector<EventConfig> events;
    CommandsConfig commands;
    LinesConfig lines;
    std::optional<TelemetryConfig> telemetry;
    OutputsConfig outputs;
};
Fields fields(ScenarioConfig& scenario);
void validate(const ScenarioConfig& scenario);

// Returns the names that events may use.
EventWorld event_world(const ScenarioConfig& scenario);

// Returns what the Vizard side needs to know about the bench.
VizardBench vizard_bench(const ScenarioConfig& scenario);
// Returns what 42 can move.
Ip42Bench ip42_bench(const ScenarioConfig& scenario);

// Returns the scenario as it is for one of its cameras. index: from 0.
ScenarioConfig scenario_of_camera(const ScenarioConfig& scenario, std::size_t index);
// Returns the seed of the camera's noise; cameras of one bench have different noise.
std::uint64_t seed_of_camera(const ScenarioConfig& scenario, std::size_t index);

// Says why the governor does not run: it has no budget, it is turned off, or frames must not depend on the
// machine's speed. Empty: it runs.
std::string governor_off(const ScenarioConfig& scenario);
// Returns the qualities below the configured one that the governor may choose; empty when it does not run.
std::vector<RenderQuality> lower_levels(const ScenarioConfig& scenario);
// Returns the quality as the scenario's first camera can have it. Rays replace the visibility buffer for a
// lens that bends straight lines too much (VisibilityBuffer::takes), for rays other than pinhole and rolling,
// and for terrain with more than one sample a pixel.
RenderQuality render_quality_of(const ScenarioConfig& scenario);
// Returns how the radiance images of all quality levels are sampled.
SensorSampling sampling_of(const ScenarioConfig& scenario);

// Returns the models to render with. Rays follow from the camera's shutter, unless the scenario sets them.
RenderModels models_of(const ScenarioConfig& scenario);

// Reads and checks a scenario; possible mistakes are in its `warnings`. Also sets the whole program's leap
// seconds to those of the scenario (use_leap_seconds), so call it before other threads ask for a time. Throws
// InputError.
ScenarioConfig load_scenario(const std::filesystem::path& file, std::span<const std::string> overrides);

}  // namespace hilcam
