// Additional cameras, and the scenario as it is for each camera of a bench.

#include "emulator/scenario/camera_config.h"

#include <cmath>

#include "emulator/scenario/app_config.h"
#include "render/vocabulary/random.h"

namespace hilcam {

namespace {

constexpr AttitudeWords kMountWords{"camera", "that body", "attitude", false};

}  // namespace

Fields fields(CameraConfig& c) {
    Fields list = {
        required(section("camera", c.camera, "data sheet of this camera")),
        integer("on", c.thing, {0, 65535},
                "carrier of this camera. 0: the body of the first camera; another number: that object"),
        vector3("position_m", c.position_m, 1, {-1e6, 1e6}, "position in the carrier's axes"),
    };
    for (Field& field : attitude_keys(c.attitude, kMountWords)) list.push_back(std::move(field));
    list.push_back(beside_frames(section("outputs", c.outputs, "destinations of this camera's frames")));
    return list;
}

void validate(const CameraConfig& c) { check_attitude(c.attitude, kMountWords); }

ScenarioConfig scenario_of_camera(const ScenarioConfig& scenario, std::size_t index) {
    ScenarioConfig own = scenario;
    if (!scenario.more_cameras.empty())
        own.places = own.places.labelled("camera " + std::to_string(index + 1));
    if (index == 0) return own;
    const CameraConfig& more = scenario.more_cameras[index - 1];
    own.camera = more.camera;
    own.mount.position_m = more.position_m;
    own.mount.thing_from_camera = frame_from_body(more.attitude);
    own.mount.thing = static_cast<std::size_t>(more.thing);
    own.outputs = more.outputs;
    const std::string of_camera = "more_cameras." + std::to_string(index - 1) + ".";
    own.places = own.places.with("camera.", of_camera + "camera.").with("outputs", of_camera + "outputs");
    // The scenario's `rays` apply to the first camera; for others they follow from the shutter.
    own.has_rays = false;
    own.models.rays = {};
    return own;
}

std::uint64_t seed_of_camera(const ScenarioConfig& scenario, std::size_t index) {
    return seed_of_nth(static_cast<std::uint64_t>(scenario.seed), index);
}

Ip42Bench ip42_bench(const ScenarioConfig& s) {
    Ip42Bench bench;
    bench.origin = s.origin;
    for (const ObjectConfig& object : s.objects) {
        Ip42Bench::Object& own = bench.objects.emplace_back();
        own.name = object.name;
        for (const JointConfig& joint : object.joints) own.joint_axes.push_back(joint.axis);
    }
    return bench;
}

VizardBench vizard_bench(const ScenarioConfig& s) {
    VizardBench bench;
    bench.start = parse_utc(s.time_utc);
    bench.origin = s.origin;
    for (const ObjectConfig& object : s.objects) bench.objects.push_back(object.name);
    for (std::size_t i = 0; i <= s.more_cameras.size(); ++i) {
        const ScenarioConfig own = scenario_of_camera(s, i);
        const auto [width, height] = frame_size(own.camera);
        // The field is that of the lens without distortion, over all rows of a frame.
        const double half_m = 0.5 * static_cast<double>(height * own.camera.binning_y) * own.camera.pitch_m;
        bench.cameras.push_back({{own.mount.position_m, own.mount.thing_from_camera},
                                 2 * std::atan2(half_m, own.camera.focal_length_m),
                                 width,
                                 height});
    }
    return bench;
}

}  // namespace hilcam
