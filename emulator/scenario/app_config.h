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
#include "emulator/scenario/lamp_config.h"
#include "emulator/scenario/motion_config.h"
#include "emulator/scenario/object_config.h"
#include "emulator/scenario/own_body_config.h"
#include "emulator/scenario/quality_ladder.h"
#include "emulator/world/clock.h"
#include "emulator/world/pose_watch.h"
#include "emulator/world/world_state.h"
#include "io/commands/commands_functionfs.h"
#include "io/commands/commands_tcp.h"
#include "io/commands/commands_udp.h"
#include "io/commands/commands_unix.h"
#include "io/commands/commands_usb.h"
#include "io/commands/telemetry.h"
#include "io/files/sink_files.h"
#include "io/gige/sink_gige.h"
#include "io/preview/sink_preview.h"
#include "io/truth/truth_config.h"
#include "io/uvc/sink_uvc.h"
#include "io/v4l2/sink_v4l2.h"
#include "io/vizard/commands_vizard.h"
#include "render/frame/renderer.h"
#include "render/sky/atmosphere_config.h"
#include "render/sky/bodies.h"
#include "render/sky/body_light.h"
#include "render/sky/sun.h"
#include "sensor/camera_model.h"
#include "sensor/chain.h"

namespace hilcam {

struct StarsConfig {
    std::filesystem::path catalogue;  // empty: no stars
    double faintest_magnitude = 8;
};
Fields fields(StarsConfig& stars);

// What is shown of the world's motion while the shutter is open (exposure_renderer.h).
enum class MotionQuality { kOff, kFast, kExact };

// How the picture gets its point spread function. kAuto: by a compact kernel where that is as accurate
// (sensor/convolution/compact_kernel.h).
enum class PsfMethod { kAuto, kFft };

struct QualityConfig {
    RenderQuality render;
    std::int64_t guard_px = 28;
    std::int64_t oversampling = 1;
    PsfMethod psf = PsfMethod::kAuto;
    MotionQuality motion = MotionQuality::kFast;
    double motion_error_px = 0.25;
};
Fields fields(QualityConfig& quality);
void validate(const QualityConfig& quality);
// How the radiance images of that quality are made.
SensorSampling sampling_of(const QualityConfig& quality);

// What makes the camera take frames (frame_starter.h).
enum class CameraMode { kFreeRun, kTriggered, kLockstep };

// A fault on demand (io/contract/fault.h) that the scenario orders by itself.
struct FaultConfig {
    FaultKind kind = FaultKind::kPacketDrop;
    FaultOrder order;
    double at_s = 0;  // after the start, CLOCK_MONOTONIC
    std::int64_t from_frame = 0, frames = 0;
};
Fields fields(FaultConfig& fault);
void validate(const FaultConfig& fault);
FaultOrder order_of(const FaultConfig& fault);

struct CommandsConfig {
    bool has_udp = false, has_tcp = false, has_unix = false, has_usb = false, has_functionfs = false,
         has_vizard = false;
    UdpCommandConfig udp;
    TcpCommandConfig tcp;
    UnixCommandConfig unix_socket;
    UsbCommandConfig usb;
    FunctionFsConfig functionfs;
    VizardConfig vizard;
    PoseRules poses;
};
Fields fields(CommandsConfig& commands);

struct OutputsConfig {
    bool has_gige = false, has_v4l2 = false, has_uvc = false, has_files = false, has_preview = false,
         has_truth = false;
    GigeConfig gige;
    V4l2Config v4l2;
    UvcConfig uvc;
    FilesConfig files;
    PreviewConfig preview;
    TruthConfig truth;
};
Fields fields(OutputsConfig& outputs);

// All of a bench: telemetry numbers them by a byte, from 1.
inline constexpr std::size_t kMaxCameras = 255;

// A camera beside the first, on the same body or on an object: a stereo pair, a star tracker.
struct CameraConfig {
    CameraModel camera;
    Vec3d position_m;  // with `attitude` its mount
    AttitudeForms attitude;
    std::int64_t thing = 0;
    OutputsConfig outputs;
};
Fields fields(CameraConfig& camera);
void validate(const CameraConfig& camera);

struct PluginConfig {
    std::filesystem::path file;
};
Fields fields(PluginConfig& plugin);

struct ScenarioConfig {
    ScenarioConfig();

    std::string name;
    std::vector<std::string> warnings;  // no key: what reading it found that need not be meant, a line each
    std::string time_utc = "2026-01-01T00:00:00Z";
    ClockConfig clock;
    std::int64_t seed = 1;
    bool has_seed = false;  // stated, or settled by settle_seed()
    std::int64_t threads = 0;
    OriginConfig origin;  // with the key `earth_orientation`
    PlaceConfig site;     // where local axes stand (site.h)
    bool has_site = false;
    CameraModel camera;
    PoseConfig camera_pose;
    MotionConfig camera_motion;
    bool has_camera_pose = false, has_camera_motion = false;
    LeapSecondsConfig leap_seconds;
    bool has_leap_seconds = false;
    std::vector<ObjectConfig> objects;
    TerrainConfig terrain;
    bool has_stars = false;
    bool has_terrain = false;
    std::vector<LampConfig> lamps;
    SunConfig sun;
    std::array<BodyConfig, kBodyCount> bodies;
    std::vector<OwnBodyConfig> own_bodies;
    AtmosphereConfig atmosphere;
    StarsConfig stars;
    std::vector<double> spectrum_edges_um = {0.40, 0.52, 0.62, 0.75, 0.95};
    RenderModels models;
    bool has_rays = false;
    std::vector<PluginConfig> plugins;
    QualityConfig quality;
    LoopConfig loop;
    CameraMode mode = CameraMode::kFreeRun;
    Mount mount;  // of the camera that this scenario is about; the first sits where poses say
    std::vector<CameraConfig> more_cameras;  // kMaxCameras - 1 at most
    std::vector<FaultConfig> faults;
    std::vector<EventConfig> events;
    CommandsConfig commands;
    TelemetryConfig telemetry;
    bool has_telemetry = false;
    OutputsConfig outputs;
};
Fields fields(ScenarioConfig& scenario);
void validate(const ScenarioConfig& scenario);

// What events can name.
EventWorld event_world(const ScenarioConfig& scenario);

// What the Vizard side is told of the bench.
VizardBench vizard_bench(const ScenarioConfig& scenario);

// The scenario as one of its cameras has it, counted from 0.
ScenarioConfig scenario_of_camera(const ScenarioConfig& scenario, std::size_t index);
// The seed of its noise: cameras of one bench draw different noise.
std::uint64_t seed_of_camera(const ScenarioConfig& scenario, std::size_t index);

// Why the governor does not run, or empty: it has no budget, or frames must not depend on how fast the
// machine is.
std::string governor_off(const ScenarioConfig& scenario);
// The qualities below the configured one that it may choose; none when it does not run.
std::vector<RenderQuality> lower_levels(const ScenarioConfig& scenario);
// The scenario's quality as its first camera can have it: a visibility buffer needs a lens that leaves
// straight lines straight, rows of one instant, no terrain and no noise budget.
RenderQuality render_quality_of(const ScenarioConfig& scenario);
// How the radiance images of all of them are made.
SensorSampling sampling_of(const ScenarioConfig& scenario);

// The models to render with: rays as the camera's shutter has them, unless the scenario gives its own.
RenderModels models_of(const ScenarioConfig& scenario);

// Reads and checks a scenario; what is worth a warning is in its `warnings`. Throws InputError. From then on
// the whole program's leap seconds are those of this scenario (use_leap_seconds): before other threads ask
// for a time.
ScenarioConfig load_scenario(const std::filesystem::path& file, std::span<const std::string> overrides);

}  // namespace hilcam
