#include "emulator/scenario/app_config.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "emulator/events/event_sequence.h"
#include "emulator/scenario/free_space.h"
#include "emulator/scenario/lamp_setup.h"
#include "emulator/scenario/listening_ports.h"
#include "emulator/scenario/site.h"
#include "io/config/config_yaml.h"
#include "io/system/plain_number.h"
#include "render/visibility/visibility_buffer.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/time_system.h"
#include "render/vocabulary/units.h"

namespace hilcam {

Fields fields(StarsConfig& s) {
    return {
        path("catalogue", s.catalogue, "CSV in the form of configs/stars/hipparcos.csv; left out: no stars"),
        number("faintest_magnitude", s.faintest_magnitude, 1, {-2, 30},
               "magnitude of the faintest stars shown; fainter ones are left out"),
    };
}

Fields fields(QualityConfig& q) {
    Fields list = fields(q.render);
    list.push_back(integer("guard_px", q.guard_px, {0, 512},
                           "border around the frame that takes the FFT's wrap-around"));
    list.push_back(integer("oversampling", q.oversampling, {1, 8},
                           "number of radiance pixels across one of the detector: detail finer than a pixel "
                           "then aliases as on a real sensor"));
    list.push_back(choice("psf", q.psf, {"auto", "fft"},
                          "method of blurring the picture. auto: by a compact kernel where its transfer "
                          "function is within 0.0025 of the exact one; fft: always exactly"));
    list.push_back(
        choice("motion", q.motion, {"off", "fast", "exact"},
               "treatment of motion during the exposure. off: the middle instant; fast: the middle instant, "
               "blurred along the picture's way; exact: the mean of several instants"));
    list.push_back(number("motion_error_px", q.motion_error_px, 1, {0.01, 16},
                          "exact: greatest movement, in pixels, of anything between two instants"));
    return list;
}

SensorSampling sampling_of(const QualityConfig& q) {
    SensorSampling sampling{static_cast<int>(q.guard_px), ray_grid_of(q.render),
                            static_cast<int>(q.oversampling)};
    sampling.always_fft = q.psf == PsfMethod::kFft;
    return sampling;
}

Fields fields(FaultConfig& f) {
    std::vector<std::string> words;
    for (const FaultKind kind : kAllFaults) words.emplace_back(name_of(kind));
    const auto present = [&f] {
        return static_cast<std::size_t>(std::find(kAllFaults.begin(), kAllFaults.end(), f.kind) -
                                        kAllFaults.begin());
    };
    return {
        required(
            Field{"kind", "kind of fault (docs/faults.md)",
                  ChoiceField{std::move(words), [&f](std::size_t i) { f.kind = kAllFaults[i]; }, present}}),
        number("rate", f.order.rate, 1, {0, 1},
               "share of packets, messages, frames or pixels that it strikes"),
        number("value", f.order.value, 1, {-1e9, 1e9}, "value of the fault; its meaning depends on the kind"),
        number("at_s", f.at_s, 1, {0, 1e7}, "time after the start at which the fault is ordered"),
        integer("from_frame", f.from_frame, {0, 9e15},
                "first frame that the fault strikes; 0: it strikes at once, or with frames from the next "
                "that begins"),
        integer("frames", f.frames, {0, 9e15}, "number of frames that the fault lasts; 0: no end"),
        number("duration_s", f.order.duration_s, 1, {0, 1e7}, "time that the fault lasts; 0: no end"),
    };
}

FaultOrder order_of(const FaultConfig& f) {
    FaultOrder order = f.order;
    order.kind = f.kind;
    order.from_frame = static_cast<std::uint64_t>(f.from_frame);
    order.frames = static_cast<std::uint64_t>(f.frames);
    return order;
}

void validate(const QualityConfig& q) {
    const std::int64_t n = q.render.kept_directions;
    if (n != 16 && n != 60 && n != 256)
        throw InputError("kept_directions: found " + std::to_string(n) + "; accepted: 16, 60, 256");
}

void validate(const FaultConfig& f) {
    if (const std::string_view reason = refusal_of(order_of(f)); !reason.empty())
        throw InputError(std::string(name_of(f.kind)) + ": " + std::string(reason) + "; it " +
                         std::string(meaning_of(f.kind)));
}

Fields fields(CommandsConfig& c) {
    return {
        optional(section("udp", c.udp, "commands over UDP"), c.has_udp),
        optional(section("tcp", c.tcp, "commands over TCP, from several clients"), c.has_tcp),
        optional(section("unix", c.unix_socket, "commands over a Unix socket"), c.has_unix),
        optional(section("usb", c.usb, "commands from a USB device with a bulk pair"), c.has_usb),
        optional(section("functionfs", c.functionfs, "commands received as a USB device (FunctionFS)"),
                 c.has_functionfs),
        optional(section("vizard", c.vizard,
                         "commands from Basilisk, in Vizard's place (docs/vizard.md); needs mode: lockstep"),
                 c.has_vizard),
        section("poses", c.poses, "treatment of poses that stop or whose time goes back"),
    };
}

Fields fields(OutputsConfig& o) {
    return {
        optional(section("gige", o.gige, "frames sent as a GigE Vision camera"), o.has_gige),
        optional(section("v4l2", o.v4l2, "frames fed to a v4l2loopback device"), o.has_v4l2),
        optional(section("uvc", o.uvc, "frames sent as a USB camera, with a USB device controller"),
                 o.has_uvc),
        optional(section("files", o.files, "frames written as pictures"), o.has_files),
        optional(section("preview", o.preview, "web page with the live picture"), o.has_preview),
        optional(section("truth", o.truth, "truth about each frame, known by the renderer (docs/truth.md)"),
                 o.has_truth),
    };
}

EventWorld event_world(const ScenarioConfig& s) {
    EventWorld world;
    for (const ObjectConfig& object : s.objects) world.objects.push_back(object.name);
    for (std::size_t i = 0; i < kBodyCount; ++i) world.visible[i] = s.bodies[i].visible;
    return world;
}

Fields fields(PluginConfig& p) {
    return {required(path("file", p.file, "shared library that adds models (render/frame/plugin.h)"))};
}

ScenarioConfig::ScenarioConfig() {
    for (std::size_t i = 0; i < kBodyCount; ++i) bodies[i] = default_body(static_cast<BodyId>(i));
}

Fields fields(ScenarioConfig& s) {
    Fields list = {
        beside_frames(text("name", s.name, "name of the scenario in reports")),
        required(text("time_utc", s.time_utc,
                      "simulated time at the start, in UTC: 2026-03-20T12:00:00Z; the Z may be left out")),
        beside_frames(section("clock", s.clock, "rate of simulated time")),
        optional(integer("seed", s.seed, {0, 9e15},
                         "seed of all random numbers of a run; without the key, run and render draw a seed "
                         "of their own, and all other commands take 1"),
                 s.has_seed),
        beside_frames(integer("threads", s.threads, {0, 1024},
                              "number of threads that render and sense; 0: one per core")),
        section("origin", s.origin, "choice of the world's origin; the world's axes are ICRF"),
        optional(section("site", s.site,
                         "place of the local axes, on the origin's body; left out: at terrain.place, or at "
                         "an origin that turns"),
                 s.has_site),
        required(section("camera", s.camera, "data sheet of the camera")),
        optional(section("camera_pose", s.camera_pose,
                         "place and attitude of the camera until commands say otherwise"),
                 s.has_camera_pose),
        optional(section("camera_motion", s.camera_motion,
                         "motion of the camera's body until commands say otherwise; replaces camera_pose"),
                 s.has_camera_motion),
        optional(section("leap_seconds", s.leap_seconds, "table of leap seconds; replaces the built-in one"),
                 s.has_leap_seconds),
        section("earth_orientation", s.origin.earth,
                "orientation of the Earth as the IERS measures it (Bulletin A); without it UT1 is UTC and "
                "the pole stands still"),
        sections("objects", s.objects, "meshes in the scene; commands number them from 1"),
        optional(section("terrain", s.terrain, "ground from a height map"), s.has_terrain),
        sections("lamps", s.lamps,
                 "light sources carried by things; commands number them from 1 (docs/lamps.md)"),
        section("sun", s.sun, "light and place of the Sun"),
        section("atmosphere", s.atmosphere, "air of the Earth"),
        optional(section("stars", s.stars, "stars in the sky"), s.has_stars),
        numbers("spectrum_edges_um", s.spectrum_edges_um, 1, {0.2, 2.5}, {2, kMaxBins + 1},
                "edges of the spectral bins"),
        optional(section("rays", s.models.rays,
                         "way in which pixels become rays, where it is not the one of the camera's shutter"),
                 s.has_rays),
        text("radiance", s.models.radiance, "radiance model: reflected | emissive, or a plug-in's"),
        sections("plugins", s.plugins, "shared libraries that add models"),
        section("quality", s.quality, "trade of speed against accuracy"),
        section("loop", s.loop, "timing of the frame loop"),
        choice("mode", s.mode, {"free_run", "triggered", "lockstep"},
               "cause of a frame: the camera's rate (free_run), a trigger (triggered), or an `expose` "
               "command, one frame each, in simulated time (lockstep)"),
        sections("more_cameras", s.more_cameras, "further cameras beside the first, in the same world"),
        beside_frames(sections("faults", s.faults, "faults that strike by themselves")),
        beside_frames(sections("events", s.events,
                               "things that happen by themselves, at a time or when something becomes true")),
        beside_frames(section("commands", s.commands, "sources of commands")),
        beside_frames(optional(
            section("telemetry", s.telemetry, "receivers that get frame reports and housekeeping unasked"),
            s.has_telemetry)),
        beside_frames(section("outputs", s.outputs, "destinations of frames")),
    };
    list.push_back(sections(
        "bodies", s.own_bodies,
        "round bodies of the scenario's own, up to 8: moons of planets, asteroids (docs/bodies.md)"));
    for (std::size_t i = 0; i < kBodyCount; ++i)
        list.push_back(section(std::string(kBodyNames[i]), s.bodies[i], "look of the body of that name"));
    return list;
}

namespace {

// What the camera's shutter makes of its rows.
const char* rays_of(ShutterKind kind) {
    switch (kind) {
        case ShutterKind::kRolling:
            return "rolling";
        case ShutterKind::kLineScan:
            return "pushbroom";
        case ShutterKind::kGlobal:
        case ShutterKind::kFrameTransfer:
            break;
    }
    return "pinhole";
}

// A plug-in's rays may do as they like; the program's own must be those of the shutter.
void check_rays(const RayConfig& rays, const ShutterConfig& shutter) {
    const std::string expected = rays_of(shutter.kind);
    const bool own = rays.model == "pinhole" || rays.model == "rolling" || rays.model == "pushbroom";
    if (!own) return;
    if (rays.model != expected)
        throw KeyError("rays.model", "found " + in_quotes(rays.model) + "; the camera's shutter asks for '" +
                                         expected + "' (leave 'rays' out, or change camera.shutter.kind)");
    if (expected != "pinhole" && std::abs(rays.line_time_s - shutter.line_time_s) > 1e-12)
        throw KeyError("rays.line_time_us", "found " + plain(rays.line_time_s * 1e6) +
                                                "; camera.shutter.line_time_us is " +
                                                plain(shutter.line_time_s * 1e6));
}

// A picture that is asked for is one frame of a world that waits for it, seen from where the message says.
// Files of two cameras have the same names.
void check_folders(const ScenarioConfig& s) {
    std::set<std::string> taken;
    const auto take = [&](const std::string& key, const std::filesystem::path& folder) {
        if (!folder.empty() && !taken.insert(key + folder.lexically_normal().string()).second)
            throw InputError(key + ": found '" + folder.string() +
                             "' for two cameras; accepted: a folder for each");
    };
    const auto take_all = [&](const OutputsConfig& o) {
        if (o.has_files) take("outputs.files.folder", o.files.folder);
        if (o.has_truth) take("outputs.truth.folder", o.truth.folder);
    };
    take_all(s.outputs);
    for (const CameraConfig& c : s.more_cameras) take_all(c.outputs);
}

void check_vizard(const ScenarioConfig& s) {
    if (s.mode != CameraMode::kLockstep)
        throw InputError(
            "commands.vizard needs 'mode: lockstep': one frame for each image that is asked for");
    const std::size_t cameras = 1 + s.more_cameras.size();
    for (const VizardCameraConfig& c : s.commands.vizard.cameras)
        if (c.camera > static_cast<std::int64_t>(cameras))
            throw InputError("commands.vizard.cameras: camera: found " + std::to_string(c.camera) +
                             "; accepted: 1 to " + std::to_string(cameras));
    for (const CameraConfig& c : s.more_cameras)
        if (c.thing != 0)
            throw InputError("more_cameras: on: found " + std::to_string(c.thing) +
                             "; accepted with commands.vizard: 0, as its messages place the cameras");
}

}  // namespace

std::string governor_off(const ScenarioConfig& s) {
    if (!(s.loop.frame_budget_s > 0)) return "loop.frame_budget_ms is 0";
    if (s.mode == CameraMode::kLockstep) return "lockstep: the same commands give the same frames";
    return "";
}

RenderQuality render_quality_of(const ScenarioConfig& s) {
    RenderQuality quality = s.quality.render;
    const ImageGeometry image =
        geometry_of(s.camera, static_cast<int>(s.quality.guard_px), static_cast<int>(s.quality.oversampling));
    if (!VisibilityBuffer::takes(image) || models_of(s).rays.model != "pinhole" || s.has_terrain ||
        quality.noise_budget > 0)
        quality.visibility = "rays";
    return quality;
}

std::vector<RenderQuality> lower_levels(const ScenarioConfig& s) {
    if (!governor_off(s).empty()) return {};
    const RenderQuality first = render_quality_of(s);
    if (s.loop.levels.empty()) return built_in_levels(first);
    std::vector<RenderQuality> levels;
    for (const QualityLevelConfig& level : s.loop.levels) levels.push_back(applied(first, level));
    return levels;
}

SensorSampling sampling_of(const ScenarioConfig& s) {
    QualityConfig quality = s.quality;
    quality.render = render_quality_of(s);
    SensorSampling sampling = sampling_of(quality);
    std::vector<RayGrid>& others = sampling.other_grids;
    for (const RenderQuality& level : lower_levels(s)) {
        const RayGrid grid = ray_grid_of(level);
        if (grid != sampling.samples_per_axis &&
            std::find(others.begin(), others.end(), grid) == others.end())
            others.push_back(grid);
    }
    return sampling;
}

RenderModels models_of(const ScenarioConfig& s) {
    RenderModels models = s.models;
    if (!s.has_rays) models.rays = {rays_of(s.camera.shutter.kind), s.camera.shutter.line_time_s};
    // Rows of the radiance image, of which there are more.
    models.rays.line_time_s /= static_cast<double>(s.quality.oversampling);
    return models;
}

void validate(const ScenarioConfig& s) {
    at_key("time_utc", [&] { parse_utc(s.time_utc); });
    SpectralGrid grid(s.spectrum_edges_um);
    if (s.has_camera_pose && s.has_camera_motion)
        throw KeyError("camera_motion", "a scenario has either 'camera_pose' or 'camera_motion'; found both");
    check_site(s);
    if (s.has_rays) check_rays(s.models.rays, s.camera.shutter);
    if (s.more_cameras.size() > kMaxCameras - 1)
        throw InputError("more_cameras: found " + std::to_string(s.more_cameras.size()) +
                         "; accepted: at most " + std::to_string(kMaxCameras - 1));
    for (std::size_t i = 0; i < s.more_cameras.size(); ++i)
        if (const std::int64_t on = s.more_cameras[i].thing; on > static_cast<std::int64_t>(s.objects.size()))
            throw KeyError("more_cameras." + std::to_string(i) + ".on",
                           "found " + std::to_string(on) + "; accepted: 0 to " +
                               std::to_string(s.objects.size()) + ", the number of objects");
    for (std::size_t i = 0; i < s.events.size(); ++i)
        if (const std::int64_t camera = s.events[i].camera;
            camera > static_cast<std::int64_t>(1 + s.more_cameras.size()))
            throw KeyError("events." + std::to_string(i) + ".camera",
                           "found " + std::to_string(camera) + "; accepted: 0 to " +
                               std::to_string(1 + s.more_cameras.size()));
    const EventSequence events(s.events, event_world(s), parse_utc(s.time_utc));
    lamp_mounts(s);
    check_folders(s);
    check_listening_ports(s);
    if (s.commands.has_vizard) check_vizard(s);
    if (s.mode == CameraMode::kLockstep) require_lockstep(s.clock), require_lockstep(s.commands.poses);
}

namespace {

// Down is towards the body that the world belongs to, unless a pose names another.
void settle_nadir(ScenarioConfig& s) {
    const std::optional<BodyId> home = s.origin.center();
    const auto settle = [&](PoseConfig& pose) {
        if (home && !pose.has_nadir_of) pose.nadir_of = *home;
    };
    settle(s.camera_pose);
    for (ObjectConfig& object : s.objects) settle(object.pose);
}

}  // namespace

ScenarioConfig load_scenario(const std::filesystem::path& file, std::span<const std::string> overrides) {
    if (has_top_level_key(file, "pitch_um"))
        throw InputError(file.string() +
                         ": is a camera's data sheet; accepted: a scenario, which has it as 'camera: " +
                         file.filename().string() + "'");
    use_leap_seconds({});  // those of a scenario that was read before end here
    ScenarioConfig scenario;
    SectionField root = section_of(scenario);
    root.validate = [&scenario] {
        settle_free_space(scenario);
        settle_nadir(scenario);
        validate(scenario);
    };
    read_config(file, root, overrides);
    scenario.origin.own = load_own_bodies(scenario.own_bodies, scenario.time_utc);
    if (scenario.has_leap_seconds) {
        const std::string warning = apply_leap_seconds(scenario.leap_seconds, scenario.time_utc);
        if (!warning.empty()) scenario.warnings.push_back(warning);
    }
    return scenario;
}

}  // namespace hilcam
