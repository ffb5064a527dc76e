#include "emulator/scenario/app_config.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "emulator/events/event_sequence.h"
#include "emulator/motion/spice_sky.h"
#include "emulator/scenario/free_space.h"
#include "emulator/scenario/lamp_setup.h"
#include "emulator/scenario/listening_ports.h"
#include "emulator/scenario/site.h"
#include "io/config/config_yaml.h"
#include "io/spice/kernel_names.h"
#include "render/visibility/visibility_buffer.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/time_system.h"

namespace hilcam {

Fields fields(StarsConfig& s) {
    return {
        path("catalogue", s.catalogue, s.catalogue_where,
             "CSV in the format of configs/stars/hipparcos.csv; left out: no stars"),
        number("faintest_magnitude", s.faintest_magnitude, 1, {-2, 30},
               "magnitude of the faintest stars shown"),
    };
}

EventWorld event_world(const ScenarioConfig& s) {
    EventWorld world;
    for (const ObjectConfig& object : s.objects) world.objects.push_back(object.name);
    for (std::size_t i = 0; i < kBodyCount; ++i) world.visible[i] = s.bodies[i].visible;
    return world;
}

Fields fields(PluginConfig& p) {
    return {required(
        path("file", p.file,
             "shared library that adds models (render/frame/plugin.h); `hilcam check` also runs its code"))};
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
                         "seed of all random numbers of a run; left out: run and render draw one, all other "
                         "commands use 1"),
                 s.has_seed),
        beside_frames(integer("threads", s.threads, {0, 1024},
                              "number of threads for rendering and the sensor; 0: one per core")),
        section("origin", s.origin, "origin of the world; its axes are ICRF"),
        section("site", s.site,
                "origin of the local axes, on the origin's body; left out: terrain.place, or the origin "
                "itself if it turns with a body"),
        required(section("camera", s.camera, "data sheet of the camera")),
        optional(section("camera_pose", s.camera_pose, "pose of the camera until a command changes it"),
                 s.has_camera_pose),
        section("camera_motion", s.camera_motion,
                "motion of the camera's body until a command changes it; replaces camera_pose"),
        section("leap_seconds", s.leap_seconds, "table of leap seconds; replaces the built-in one"),
        section("spice", s.spice,
                "SPICE kernels of NAIF, which give positions and attitudes (docs/spice.md)"),
        section("earth_orientation", s.origin.earth,
                "orientation of the Earth as measured by the IERS (Bulletin A); left out: UT1 equals UTC, "
                "without polar motion"),
        sections("objects", s.objects, "meshes in the scene; commands number them from 1"),
        section("terrain", s.terrain, "ground from a height map"),
        sections("lamps", s.lamps,
                 "light sources carried by the camera's body or objects; commands number them from 1 "
                 "(docs/lamps.md)"),
        section("sun", s.sun, "light and position of the Sun"),
        section("atmosphere", s.atmosphere, "atmosphere of the Earth"),
        section("earth_surface", s.earth_surface,
                "land, sea, clouds and lights of the Earth (docs/earth.md)"),
        section("stars", s.stars, "stars in the sky"),
        numbers("spectrum_edges_um", s.spectrum_edges_um, 1, {kShortest_um, kLongest_um}, {2, kMaxBins + 1},
                "edges of the spectral bins; beyond 2.5 um bins are thermal"),
        optional(section("rays", s.models.rays,
                         "ray model of the pixels, where it differs from that of the camera's shutter"),
                 s.has_rays),
        text("radiance", s.models.radiance, "radiance model: reflected, emissive, or a plug-in's"),
        sections("plugins", s.plugins, "shared libraries that add models"),
        section("quality", s.quality, "trade-off between speed and accuracy"),
        section("loop", s.loop, "timing of the frame loop"),
        choice("mode", s.mode, {"free_run", "triggered", "lockstep"},
               "start of each frame: the camera's frame rate (free_run), a trigger (triggered), or an "
               "`expose` command, one frame each, in simulated time (lockstep)"),
        sections("more_cameras", s.more_cameras, "further cameras in the same world"),
        beside_frames(sections("faults", s.faults, "faults that the scenario injects")),
        beside_frames(sections("events", s.events, "actions of the scenario at a time or on a condition")),
        beside_frames(section("commands", s.commands, "sources of commands")),
        beside_frames(section("lines", s.lines, "input and output lines of the cameras (docs/lines.md)")),
        beside_frames(
            section("telemetry", s.telemetry, "receivers of unrequested frame reports and housekeeping")),
        beside_frames(section("outputs", s.outputs, "destinations of frames")),
    };
    list.push_back(
        sections("bodies", s.own_bodies,
                 "round bodies of the scenario, up to 8: moons of planets, asteroids (docs/bodies.md)"));
    for (std::size_t i = 0; i < kBodyCount; ++i)
        list.push_back(section(std::string(kBodyNames[i]), s.bodies[i], "look of this body"));
    return list;
}

namespace {

// Returns the name of the rays that the camera's shutter needs.
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

// Rays of a plug-in are free; the program's own must suit the shutter.
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

// Names of outputs.gige.lines are those of Line0, so lines must have others.
void check_line_names(const OutputsConfig& outputs, const std::string& prefix, const LinePlan& plan) {
    const auto* gige = outputs.find<GigeConfig>();
    if (!gige) return;
    for (std::size_t line = 1; line < kLines; ++line) {
        const std::string name = "Line" + std::to_string(line);
        if (plan.is_there[line] &&
            std::find(gige->lines.begin(), gige->lines.end(), name) != gige->lines.end())
            throw refused_key(prefix + "outputs.gige.lines", "'" + name + "', which is a line of 'lines'",
                              "further names of Line0");
    }
}

void check_lines(const ScenarioConfig& s) {
    if (s.mode == CameraMode::kLockstep && s.lines.any())
        throw KeyError(
            "lines", "found with 'mode: lockstep'; accepted: free_run, triggered, as edges are in real time");
    const auto cameras = static_cast<std::int64_t>(1 + s.more_cameras.size());
    const auto check = [&](const std::string& list, std::size_t i, std::int64_t camera, int first) {
        if (camera > cameras)
            throw refused_key("lines." + list + "." + std::to_string(i) + ".camera", std::to_string(camera),
                              std::to_string(first) + " to " + std::to_string(cameras));
    };
    for (std::size_t i = 0; i < s.lines.inputs.size(); ++i) check("inputs", i, s.lines.inputs[i].camera, 0);
    for (std::size_t i = 0; i < s.lines.outputs.size(); ++i)
        check("outputs", i, s.lines.outputs[i].camera, 1);
    check_line_names(s.outputs, "", plan_of(s.lines, 1));
    for (std::size_t i = 0; i < s.more_cameras.size(); ++i)
        check_line_names(s.more_cameras[i].outputs, "more_cameras." + std::to_string(i) + ".",
                         plan_of(s.lines, i + 2));
}

// Files of two cameras have the same names, so two cameras must not share a folder.
void check_folders(const ScenarioConfig& s) {
    std::set<std::string> taken;
    const auto take = [&](const std::string& key, const std::filesystem::path& folder) {
        if (!taken.insert(key + folder.lexically_normal().string()).second)
            throw refused(key, "'" + folder.string() + "' for two cameras", "a folder for each");
    };
    const auto take_all = [&](const OutputsConfig& o) {
        for (const RunFolder& folder : run_folders(o)) take(folder.key + ".folder", folder.folder);
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
            throw refused("commands.vizard.cameras: camera", std::to_string(c.camera),
                          "1 to " + std::to_string(cameras));
    for (const CameraConfig& c : s.more_cameras)
        if (c.thing != 0)
            throw InputError("more_cameras: on: found " + std::to_string(c.thing) +
                             "; accepted with commands.vizard: 0, as its messages place the cameras");
}

void check_ip42(const ScenarioConfig& s) {
    const Ip42Config& c = s.commands.ip42;
    at_key("commands.ip42", [&] { check_bodies(c.bodies, ip42_bench(s)); });
    const std::optional<BodyId> home = s.origin.center();
    if (home && *home != BodyId::kEarth && c.pole_rad.empty())
        throw KeyError("commands.ip42.pole_deg",
                       "is needed with an origin at " + std::string(kBodyNames[index_of(*home)]) +
                           ", as 42's frame N has the axes of that world's pole (docs/42.md)");
}

}  // namespace

std::string governor_off(const ScenarioConfig& s) {
    if (s.loop.levels_fixed) return "loop.levels is fixed";
    if (s.loop.budget_is_of_rate() && !s.loop.holds_rate)
        return "loop.frame_budget_ms is auto, and no frame rate is set";
    if (s.loop.frame_budget_s >= 0 && !(s.loop.frame_budget_s > 0)) return "loop.frame_budget_ms is 0";
    if (s.mode == CameraMode::kLockstep) return "lockstep: the same commands give the same frames";
    return "";
}

RenderQuality render_quality_of(const ScenarioConfig& s) {
    RenderQuality quality = s.quality.render;
    const ImageGeometry image =
        geometry_of(s.camera, static_cast<int>(s.quality.guard_px), static_cast<int>(s.quality.oversampling));
    const std::string rays = models_of(s).rays.model;
    if (!VisibilityBuffer::takes(image) || (rays != "pinhole" && rays != "rolling") ||
        (s.terrain && quality.buffer_samples > 1))
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
    // The radiance image has more rows than the sensor.
    models.rays.line_time_s /= static_cast<double>(s.quality.oversampling);
    return models;
}

void validate(const ScenarioConfig& s) {
    at_key("time_utc", [&] { parse_utc(s.time_utc); });
    at_key("spectrum_edges_um", [&] { SpectralGrid grid(s.spectrum_edges_um); });
    if (SpectralGrid(s.spectrum_edges_um).has_thermal() && s.models.radiance == "reflected")
        throw KeyError(
            "radiance",
            "found 'reflected' with spectrum_edges_um beyond 2.5 um, where surfaces emit; accepted: "
            "emissive");
    if (s.has_camera_pose && s.camera_motion)
        throw KeyError("camera_motion", "a scenario has either 'camera_pose' or 'camera_motion'; found both");
    check_site(s);
    if (s.has_rays) check_rays(s.models.rays, s.camera.shutter);
    if (s.more_cameras.size() > kMaxCameras - 1)
        throw refused("more_cameras", std::to_string(s.more_cameras.size()),
                      "at most " + std::to_string(kMaxCameras - 1));
    for (std::size_t i = 0; i < s.more_cameras.size(); ++i)
        if (const std::int64_t on = s.more_cameras[i].thing; on > static_cast<std::int64_t>(s.objects.size()))
            throw refused_key("more_cameras." + std::to_string(i) + ".on", std::to_string(on),
                              "0 to " + std::to_string(s.objects.size()) + ", the number of objects");
    for (std::size_t i = 0; i < s.events.size(); ++i)
        if (const std::int64_t camera = s.events[i].camera;
            camera > static_cast<std::int64_t>(1 + s.more_cameras.size()))
            throw refused_key("events." + std::to_string(i) + ".camera", std::to_string(camera),
                              "0 to " + std::to_string(1 + s.more_cameras.size()));
    const EventSequence events(s.events, event_world(s), parse_utc(s.time_utc));
    lamp_mounts(s);
    check_folders(s);
    check_listening_ports(s);
    check_lines(s);
    if (s.commands.has_vizard) check_vizard(s);
    if (s.commands.has_ip42) check_ip42(s);
    if (s.mode == CameraMode::kLockstep)
        require_lockstep(s.clock), require_lockstep(s.commands.poses), require_lockstep(s.loop.fail_on);
}

namespace {

// Nadir points to the body that the origin belongs to, unless a pose names another.
void settle_nadir(ScenarioConfig& s) {
    const std::optional<BodyId> home = s.origin.center();
    const auto settle = [&](PoseConfig& pose) {
        if (home && !pose.has_nadir_of) pose.nadir_of = *home;
    };
    settle(s.camera_pose);
    for (ObjectConfig& object : s.objects) settle(object.pose);
}

// The ground of a whole body replaces that body.
void settle_ground(ScenarioConfig& s) {
    if (!s.terrain || !s.terrain->globe) return;
    const std::string& name = s.terrain->globe->body;
    for (std::size_t i = 0; i < kBodyCount; ++i)
        if (kBodyNames[i] == name) s.bodies[i].visible = false;
    for (OwnBodyConfig& own : s.own_bodies)
        if (own.name == name) own.look.visible = false;
}

}  // namespace

namespace {

// Sets the kernels' leap seconds, then those of `leap_seconds`, before any time is computed.
void take_kernels(ScenarioConfig& s) {
    if (s.spice) {
        const std::string warning = load_spice(*s.spice);
        // The scenario's own list replaces the kernels'.
        if (!warning.empty() && !s.leap_seconds) s.warnings.push_back(warning);
    }
    if (!s.spice && s.origin.kind == OriginConfig::Kind::kSpice)
        throw InputError(
            "origin.kind: found 'spice', and the scenario has no kernels; accepted: with 'spice: {kernels: "
            "[...]}'");
}

void use_kernels(ScenarioConfig& s) {
    std::shared_ptr<SpiceKernels> kernels;
    if (s.spice) {
        kernels = s.spice->loaded;
        std::optional<int> origin;
        if (s.origin.kind == OriginConfig::Kind::kSpice)
            origin = require_kernel_code(kernels->set.pool, s.origin.object, "origin.object");
        const bool with_bodies = s.spice->bodies == SpiceConfig::Bodies::kKernels;
        s.origin.source = make_spice_sky(kernels, origin, with_bodies, parse_utc(s.time_utc));
        if (const std::string warning = apply_instrument(*s.spice, s.camera); !warning.empty())
            s.warnings.push_back(warning);
    }
    s.origin.own = load_own_bodies(s.own_bodies, s.time_utc, kernels);
}

}  // namespace

ScenarioConfig load_scenario(const std::filesystem::path& file, std::span<const std::string> overrides) {
    if (has_top_level_key(file, "pitch_um"))
        throw InputError(file.string() +
                         ": is a camera's data sheet; accepted: a scenario, which has it as 'camera: " +
                         file.filename().string() + "'");
    use_leap_seconds({});  // discards those of a previously read scenario
    ScenarioConfig scenario;
    SectionField root = section_of(scenario);
    root.validate = [&scenario] {
        settle_free_space(scenario);
        settle_nadir(scenario);
        settle_ground(scenario);
        validate(scenario);
    };
    scenario.places = KeyPlaces(file.string());
    read_config(file, root, overrides, &scenario.places);
    take_kernels(scenario);
    if (scenario.leap_seconds) {
        const std::string warning = apply_leap_seconds(*scenario.leap_seconds, scenario.time_utc);
        if (!warning.empty()) scenario.warnings.push_back(warning);
    }
    use_kernels(scenario);
    return scenario;
}

}  // namespace hilcam
