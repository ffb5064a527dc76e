#pragma once
// A scenario file: the world, the camera, the quality, and where commands come from and frames go.

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
    std::string catalogue_where;      // the key's place in the scenario
    double faintest_magnitude = 8;
};
Fields fields(StarsConfig& stars);

// The source that makes the camera take frames (frame_starter.h).
enum class CameraMode { kFreeRun, kTriggered, kLockstep };

struct PluginConfig {
    std::filesystem::path file;
};
Fields fields(PluginConfig& plugin);

struct ScenarioConfig {
    ScenarioConfig();

    std::string name;
    KeyPlaces places;                   // no key: where each key is given, for warnings
    std::vector<std::string> warnings;  // no key: what reading it found that need not be meant, a line each
    std::string time_utc = "2026-01-01T00:00:00Z";
    ClockConfig clock;
    std::int64_t seed = 1;
    bool has_seed = false;      // stated, or settled by settle_seed()
    bool is_used_once = false;  // no key: what loading makes of it is not kept in the cache
    std::int64_t threads = 0;
    OriginConfig origin;              // has the key `earth_orientation`, too
    std::optional<PlaceConfig> site;  // where local axes stand (site.h)
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
    Mount mount;  // mount of the camera that this scenario is about; the first sits where poses say
    std::vector<CameraConfig> more_cameras;  // kMaxCameras - 1 at most
    std::vector<FaultConfig> faults;
    std::vector<EventConfig> events;
    CommandsConfig commands;
    std::optional<TelemetryConfig> telemetry;
    OutputsConfig outputs;
};
Fields fields(ScenarioConfig& scenario);
void validate(const ScenarioConfig& scenario);

// Returns what events can name.
EventWorld event_world(const ScenarioConfig& scenario);

// Returns what the Vizard side is told of the bench.
VizardBench vizard_bench(const ScenarioConfig& scenario);

// The scenario as one of its cameras has it, counted from 0.
ScenarioConfig scenario_of_camera(const ScenarioConfig& scenario, std::size_t index);
// The seed of its noise: cameras of one bench draw different noise.
std::uint64_t seed_of_camera(const ScenarioConfig& scenario, std::size_t index);

// Says why the governor does not run, or empty: it has no budget, it is not wanted, or frames must not depend on how fast
// the machine is.
std::string governor_off(const ScenarioConfig& scenario);
// The qualities below the configured one that it may choose; none when it does not run.
std::vector<RenderQuality> lower_levels(const ScenarioConfig& scenario);
// The scenario's quality as its first camera can have it: a visibility buffer needs a lens that leaves
// straight lines straight, rows of one instant, and no terrain.
RenderQuality render_quality_of(const ScenarioConfig& scenario);
// Returns how the radiance images of all of them are made.
SensorSampling sampling_of(const ScenarioConfig& scenario);

// The models to render with: rays as the camera's shutter has them, unless the scenario gives its own.
RenderModels models_of(const ScenarioConfig& scenario);

// Reads and checks a scenario; what is worth a warning is in its `warnings`. Throws InputError. From then on
// the whole program's leap seconds are those of this scenario (use_leap_seconds): before other threads ask
// for a time.
ScenarioConfig load_scenario(const std::filesystem::path& file, std::span<const std::string> overrides);

}  // namespace hilcam
