#include "emulator/scenario/scenario_warnings.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <functional>
#include <set>

#include "emulator/scenario/initial_world.h"
#include "emulator/scenario/scene_loader.h"
#include "emulator/scenario/site.h"
#include "io/config/config_advice.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

using Lines = std::vector<std::string>;

bool any_camera(const ScenarioConfig& s, const std::function<bool(const OutputsConfig&)>& has) {
    return has(s.outputs) || std::any_of(s.more_cameras.begin(), s.more_cameras.end(),
                                         [&](const CameraConfig& c) { return has(c.outputs); });
}

bool frees_camera(const EventConfig& event) {
    const EventActions actions = actions_of(event);
    return std::any_of(actions.commands.begin(), actions.commands.end(), [](const Command& c) {
        const auto* mode = std::get_if<TriggerModeCommand>(&c);
        return mode && !mode->triggered;
    });
}

// Frames are requested by commands, the preview's button and events; in triggered mode also by GigE Vision's
// software trigger and action commands, which are refused in lockstep, and by edges of lines.
void look_at_askers(const ScenarioConfig& s, Lines& out) {
    if (s.mode == CameraMode::kFreeRun) return;
    const bool lockstep = s.mode == CameraMode::kLockstep;
    const CommandsConfig& c = s.commands;
    const bool port = c.has_udp || c.has_tcp || c.has_unix || c.has_usb || c.has_functionfs || c.has_vizard ||
                      (lockstep && c.has_ip42) || any_camera(s, [&](const OutputsConfig& o) {
                          return o.find<PreviewConfig>() || (!lockstep && o.find<GigeConfig>());
                      });
    const bool event = std::any_of(s.events.begin(), s.events.end(), [&](const EventConfig& e) {
        return actions_of(e).takes_picture() || (!lockstep && frees_camera(e));
    });
    const bool wire = s.lines.udp || std::any_of(s.lines.inputs.begin(), s.lines.inputs.end(),
                                                 [](const LineInputConfig& input) {
                                                     return !input.pin.gpio.empty() || !input.pps.empty();
                                                 });
    if (port || event || wire) return;
    if (lockstep)
        out.push_back(s.places.at(
            "mode",
            "mode: lockstep, and nothing can request a frame: give commands.udp (or tcp, unix, usb, vizard, "
            "ip42), outputs.preview, or an event that exposes; 'hilcam send expose' then takes one"));
    else
        out.push_back(s.places.at(
            "mode",
            "mode: triggered, and nothing can trigger a frame: give commands.udp (or tcp, unix, usb), "
            "outputs.gige, outputs.preview, or an event that exposes; 'hilcam send expose' then takes one"));
}

// Returns the thing that a command is for if the scenario does not have it; otherwise empty.
std::string missing_thing(const Command& command, const ScenarioConfig& s) {
    if (const auto* pose = std::get_if<PoseCommand>(&command); pose && pose->object > s.objects.size())
        return fmt::format("object {}, and there are {}", pose->object, s.objects.size());
    if (const auto* lamp = std::get_if<LampCommand>(&command);
        lamp && (lamp->lamp < 1 || lamp->lamp > s.lamps.size()))
        return fmt::format("lamp {}, and there are {}", lamp->lamp, s.lamps.size());
    const auto* joint = std::get_if<JointCommand>(&command);
    if (!joint) return {};
    if (joint->object < 1 || joint->object > s.objects.size())
        return fmt::format("object {}, and there are {}", joint->object, s.objects.size());
    const ObjectConfig& object = s.objects[joint->object - 1u];
    if (joint->joint >= 1 && joint->joint <= object.joints.size()) return {};
    return fmt::format("joint {} of '{}', which has {}", joint->joint, object.name, object.joints.size());
}

// The log has a line when such an event is refused, which may be hours after the start.
void look_at_actions(const ScenarioConfig& s, Lines& out) {
    for (std::size_t i = 0; i < s.events.size(); ++i)
        for (const Command& command : actions_of(s.events[i]).commands)
            if (const std::string what = missing_thing(command, s); !what.empty())
                out.push_back(
                    s.places.at(fmt::format("events.{}.do", i),
                                fmt::format("events.{}.do: will be refused: it is for {}", i, what)));
}

// Lamps, motions and events refer to the first of several objects with the same name.
void look_at_names(const ScenarioConfig& s, Lines& out) {
    std::set<std::string> names;
    for (std::size_t i = 0; i < s.objects.size(); ++i)
        if (const std::string& name = s.objects[i].name; !names.insert(name).second)
            out.push_back(s.places.at(fmt::format("objects.{}.name", i),
                                      fmt::format("objects.{}.name: another object is also named '{}'; "
                                                  "lamps, motions and events refer to that one",
                                                  i, name)));
}

void look_at_faults(const ScenarioConfig& s, Lines& out) {
    std::set<FaultKind> told;
    std::vector<const OutputsConfig*> outputs = {&s.outputs};
    for (const CameraConfig& camera : s.more_cameras) outputs.push_back(&camera.outputs);
    const auto look = [&](FaultKind kind, const char* by) {
        const std::string what = lacking_output(outputs, s.commands, kind);
        if (what.empty() || !told.insert(kind).second) return;
        out.push_back(s.places.at(by, fmt::format("{}: the fault '{}' ({}) has no effect without {}", by,
                                                  name_of(kind), meaning_of(kind), what)));
    };
    for (const FaultConfig& fault : s.faults) look(fault.kind, "faults");
    for (const EventConfig& event : s.events)
        for (const Command& command : actions_of(event).commands)
            if (const auto* fault = std::get_if<FaultCommand>(&command); fault && !fault->clear_all)
                look(fault->order.kind, "events");
}

bool same_turn(const Quat& a, const Quat& b) { return a.w == b.w && a.x == b.x && a.y == b.y && a.z == b.z; }

bool is_inside(const BodyState& body, const Figure& figure, Vec3d place_world_m) {
    const Vec3d p = body.fixed_from_world * (place_world_m - body.world_m);
    const double stretch = figure.equatorial_radius_m / figure.polar_radius_m;
    return length(Vec3d{p.x, p.y, stretch * p.z}) < figure.equatorial_radius_m;
}

// Says where the camera is that is inside a body, and what may have been intended.
std::string report_inside(const ScenarioConfig& s, std::size_t camera, std::size_t body,
                          const WorldSnapshot& world) {
    const Vec3d from_centre_m = world.camera.position_world_m - world.bodies.body[body].world_m;
    std::string line = fmt::format(
        "camera {} begins inside the body '{}', {:.6g} km from its centre: it sees "
        "nothing else",
        camera + 1, kBodyNames[body], length(from_centre_m) * 1e-3);
    if (s.origin.center() == static_cast<BodyId>(body) && !s.origin.turns())
        line += fmt::format(
            "; the world's origin is that centre{}: set it with 'origin'",
            static_cast<BodyId>(body) == BodyId::kEarth ? " unless the scenario says otherwise" : "");
    if (length(from_centre_m) * 1e3 > kFigures[body].equatorial_radius_m)
        line += ", give positions in metres if these are kilometres";
    return line + fmt::format(", move camera_pose, or set {}.visible: false", kBodyNames[body]);
}

void look_at_cameras(const ScenarioConfig& bench, Lines& out) {
    const TimeTai start = parse_utc(bench.time_utc);
    for (std::size_t camera = 0; camera <= bench.more_cameras.size(); ++camera) {
        const ScenarioConfig s = scenario_of_camera(bench, camera);
        const WorldSnapshot world = snapshot_at(s, start, start);
        for (std::size_t i = 0; i < kBodyCount; ++i)
            if (s.bodies[i].visible &&
                is_inside(world.bodies.body[i], kFigures[i], world.camera.position_world_m))
                out.push_back(bench.places.at(s.camera_motion ? "camera_motion" : "camera_pose",
                                              report_inside(s, camera, i, world)));
    }
}

// A rover may be in a basin some kilometres below the ellipsoid.
constexpr double kDeep = 0.95;

void look_at_objects(const ScenarioConfig& s, Lines& out) {
    const TimeTai start = parse_utc(s.time_utc);
    const WorldSnapshot world = snapshot_at(s, start, start);
    for (std::size_t k = 0; k < s.objects.size(); ++k) {
        const Pose& pose = world.objects[k];
        const std::string key = fmt::format("objects.{}.{}", k, s.objects[k].motion ? "motion" : "pose");
        for (std::size_t i = 0; i < kBodyCount; ++i) {
            const Vec3d centre_m = world.bodies.body[i].world_m;
            const Vec3d raised_m = centre_m + (pose.position_world_m - centre_m) / kDeep;
            if (s.bodies[i].visible && is_inside(world.bodies.body[i], kFigures[i], raised_m))
                out.push_back(s.places.at(
                    key, fmt::format("{}: object '{}' is inside the body '{}', {:.6g} km from its centre",
                                     key, s.objects[k].name, kBodyNames[i],
                                     length(pose.position_world_m - centre_m) * 1e-3)));
        }
        for (std::size_t other = 0; other < k; ++other)
            if (s.objects[k].has_mesh && s.objects[other].mesh == s.objects[k].mesh &&
                s.objects[other].scale == s.objects[k].scale &&
                length(world.objects[other].position_world_m - pose.position_world_m) == 0 &&
                same_turn(world.objects[other].world_from_body, pose.world_from_body))
                out.push_back(s.places.at(
                    key, fmt::format(
                             "{}: object '{}' has the mesh and the pose of '{}': either of them may be seen",
                             key, s.objects[k].name, s.objects[other].name)));
    }
}

bool gives_light(const LampConfig& lamp) {
    const std::vector<double>& curve = lamp.spectral_intensity_w_sr_um.value;
    const double most = lamp.has_intensity ? lamp.intensity_w_sr
                        : curve.empty()    ? 0
                                           : *std::max_element(curve.begin(), curve.end());
    return most * lamp.level > 0;
}

void look_at_lamps(const ScenarioConfig& s, Lines& out) {
    for (std::size_t i = 0; i < s.lamps.size(); ++i)
        if (const std::string key = fmt::format("lamps.{}", i); s.lamps[i].lit && !gives_light(s.lamps[i]))
            out.push_back(s.places.at(
                key, fmt::format("{}: lamp '{}' is lit and gives no light: its intensity or level is 0", key,
                                 s.lamps[i].name)));
}

// A camera of a bench without any output was probably forgotten; a scenario without any output is for
// `render`.
void look_at_outputs(const ScenarioConfig& s, Lines& out) {
    const auto shows = [](const OutputsConfig& o) { return o.any(); };
    if (s.commands.has_vizard || !any_camera(s, shows)) return;
    for (std::size_t i = 0; i < s.more_cameras.size(); ++i)
        if (!shows(s.more_cameras[i].outputs))
            out.push_back(s.places.at(
                fmt::format("more_cameras.{}", i),
                fmt::format("more_cameras.{}.outputs: camera {} has none, so its frames go nowhere", i,
                            i + 2)));
    if (!shows(s.outputs))
        out.push_back(s.places.at("outputs", "outputs: camera 1 has none, so its frames go nowhere"));
}

void look_at_shutter(const std::string& section, const ShutterConfig& shutter, const KeyPlaces& places,
                     Lines& out) {
    const std::string key = section + ".shutter.line_time_us";
    if (shutter.has_line_time && shutter.kind == ShutterKind::kGlobal)
        out.push_back(places.at(key, key + ": has no effect with kind: global"));
}

void look_at_shutters(const ScenarioConfig& s, Lines& out) {
    look_at_shutter("camera", s.camera.shutter, s.places, out);
    for (std::size_t i = 0; i < s.more_cameras.size(); ++i)
        look_at_shutter(fmt::format("more_cameras.{}.camera", i), s.more_cameras[i].camera.shutter, s.places,
                        out);
}

// Surfaces at absolute zero are probably forgotten ones.
void look_at_temperatures(const ScenarioConfig& s, Lines& out) {
    const bool thermal = SpectralGrid(s.spectrum_edges_um).has_thermal();
    for (std::size_t i = 0; i < s.objects.size(); ++i) {
        const ObjectConfig& object = s.objects[i];
        const std::string key = fmt::format("objects.{}.temperature_k", i);
        if (!thermal && s.models.radiance == "reflected" && object.temperature_k > 0)
            out.push_back(s.places.at(key, key + ": has no effect with radiance: reflected"));
        if (thermal && !(object.temperature_k > 0))
            out.push_back(s.places.at(
                fmt::format("objects.{}", i),
                fmt::format("{}: not given, so surfaces of '{}' without a temperature of their own emit "
                            "nothing beyond 2.5 um",
                            key, object.name)));
    }
}

// Warns of places and bodies that are named but missing in the scenario.
void look_at_frames(const ScenarioConfig& s, Lines& out) {
    const bool shows_earth = s.bodies[index_of(BodyId::kEarth)].visible;
    const auto warn = [&](bool about, const char* key, const char* text) {
        if (about) out.push_back(s.places.at(key, text));
    };
    warn(s.site && !uses_local_axes(s), "site",
         "site: nothing uses its local axes: give a pose or a motion 'frame: local'");
    warn(s.stars && s.stars->catalogue.empty(), "stars",
         "stars: there are none without stars.catalogue; hipparcos.csv is shipped");
    warn(s.atmosphere.model != "none" && !shows_earth, "atmosphere",
         "atmosphere: has no effect, as the Earth is not shown: earth.visible");
    warn(!s.earth_surface.map.empty() && !shows_earth, "earth_surface",
         "earth_surface: has no effect, as the Earth is not shown: earth.visible");
    warn(!s.earth_surface.map.empty() && !s.bodies[index_of(BodyId::kEarth)].albedo_map.empty(),
         "earth.albedo_map", "earth.albedo_map: has no effect, as earth_surface.map gives the Earth's look");
}

// Returns a distance beyond which no orbit about the body lasts: Hill's sphere of the Earth has 1.5e6 km,
// that of Neptune 1.2e8.
double farthest_of(BodyId body) {
    return index_of(body) >= index_of(BodyId::kJupiter) && index_of(body) <= index_of(BodyId::kNeptune) ? 2e11
                                                                                                        : 2e9;
}

void look_at_length(const ScenarioConfig& s, const std::string& key, double length_m, BodyId body,
                    Lines& out) {
    if (length_m < farthest_of(body)) return;
    const double km = length_m * 1e-3;
    out.push_back(s.places.at(
        key, fmt::format("{} is {:.8g}: that is {:.2g} au from the body '{}'; in metres? here it "
                         "would be {:.6g}",
                         key, km, length_m / kAstronomicalUnit_m, kBodyNames[index_of(body)], km * 1e-3)));
}

void look_at_orbit(const ScenarioConfig& s, const std::string& key, const MotionConfig& motion, Lines& out) {
    if (motion.kind != MotionConfig::Kind::kKepler || !motion.kepler || motion.center >= kBodyCount) return;
    look_at_length(s, key + ".kepler.semi_major_axis_km", motion.kepler->semi_major_axis_m,
                   static_cast<BodyId>(motion.center), out);
}

// Says which rules of an object have no effect, and which surfaces exist; empty: all have an effect.
std::string meaning_of_idle_rules(const LoadedObject& object) {
    if (object.idle_rules.empty()) return {};
    std::vector<std::string> names;
    std::string surfaces, rules;
    for (const LoadedSurface& surface : object.surfaces) {
        if (surface.triangles == 0) continue;
        names.push_back(surface.name);
        if (surfaces.size() < 400) surfaces += (surfaces.empty() ? "" : ", ") + in_quotes(surface.name);
    }
    for (const std::string& rule : object.idle_rules) {
        rules += (rules.empty() ? "" : ", ") + in_quotes(rule);
        if (std::find(names.begin(), names.end(), rule) != names.end())
            rules += " (an earlier rule matches that surface)";
        else if (const std::string nearest = nearest_of(rule, names); !nearest.empty())
            rules += " (the nearest is " + in_quotes(nearest) + ")";
    }
    return "no surface matches its material rules for " + rules + "; the mesh's surfaces: " + surfaces;
}

}  // namespace

std::string lacking_output(const std::vector<const OutputsConfig*>& outputs, const CommandsConfig& commands,
                           FaultKind kind) {
    const auto number = static_cast<int>(kind);
    const auto any = [&](const auto& has) {
        return std::any_of(outputs.begin(), outputs.end(), [&](const OutputsConfig* o) { return has(*o); });
    };
    const auto lacking = [](bool there, const char* what) {
        return there ? std::string() : std::string(what);
    };
    if (number < 60)
        return lacking(any([](const OutputsConfig& o) { return o.find<GigeConfig>() != nullptr; }),
                       "outputs.gige");
    if (number < 70)
        return lacking(any([](const OutputsConfig& o) { return o.find<V4l2Config>() != nullptr; }),
                       "outputs.v4l2");
    if (number < 80)
        return lacking(commands.has_usb || commands.has_functionfs, "commands.usb or commands.functionfs");
    const auto shows = [](const OutputsConfig& o) {
        return o.any([]<class Config>(const Config&) { return !std::is_same_v<Config, TruthConfig>; });
    };
    return lacking(any(shows) || commands.has_vizard, "any of outputs");
}

std::vector<std::string> idle_run_warnings(const ScenarioConfig& scenario) {
    Lines out;
    look_at_askers(scenario, out);
    look_at_actions(scenario, out);
    look_at_faults(scenario, out);
    look_at_outputs(scenario, out);
    return out;
}

std::vector<std::string> no_output_warnings(const ScenarioConfig& s) {
    if (s.commands.has_vizard || s.telemetry || any_camera(s, [](const OutputsConfig& o) { return o.any(); }))
        return {};
    return {s.places.at("outputs",
                        "outputs: there are none, so the frames of a run go nowhere: give outputs.files, "
                        "outputs.gige, outputs.preview (or --preview 8080), ...")};
}

std::vector<std::string> idle_warnings(const ScenarioConfig& scenario) {
    Lines out;
    look_at_names(scenario, out);
    look_at_shutters(scenario, out);
    look_at_lamps(scenario, out);
    look_at_frames(scenario, out);
    look_at_temperatures(scenario, out);
    return out;
}

std::vector<std::string> length_warnings(const ScenarioConfig& s) {
    Lines out;
    if (s.origin.turns())
        look_at_length(s, "origin.height_km", s.origin.place.height_m, *s.origin.center(), out);
    if (s.camera_motion) look_at_orbit(s, "camera_motion", *s.camera_motion, out);
    for (std::size_t i = 0; i < s.objects.size(); ++i)
        if (s.objects[i].motion)
            look_at_orbit(s, fmt::format("objects.{}.motion", i), *s.objects[i].motion, out);
    return out;
}

std::vector<std::string> place_warnings(const ScenarioConfig& scenario) {
    Lines out;
    look_at_cameras(scenario, out);
    look_at_objects(scenario, out);
    return out;
}

std::vector<std::string> warnings_of(const std::vector<LoadedObject>& objects, const KeyPlaces& places) {
    struct Warning {
        std::string object, key, meaning;
        std::size_t number = 0, others = 0;
    };
    std::vector<Warning> warnings;
    const auto warn = [&](std::size_t i, const char* key, std::string meaning) {
        if (meaning.empty()) return;
        const auto same = std::find_if(warnings.begin(), warnings.end(),
                                       [&](const Warning& w) { return w.meaning == meaning; });
        if (same != warnings.end())
            ++same->others;
        else
            warnings.push_back({objects[i].name, key, std::move(meaning), i});
    };
    for (std::size_t i = 0; i < objects.size(); ++i) {
        warn(i, "materials", meaning_of_idle_rules(objects[i]));
        for (const std::string& look : objects[i].left_out) warn(i, "mesh", look);
    }
    std::vector<std::string> out;
    for (const Warning& w : warnings)
        out.push_back(places.at("objects." + std::to_string(w.number) + "." + w.key,
                                "object '" + w.object + "'" +
                                    (w.others > 0 ? " and " + std::to_string(w.others) + " more" : "") +
                                    ": " + w.meaning));
    return out;
}

}  // namespace hilcam
