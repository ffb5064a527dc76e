#include "emulator/scenario/initial_world.h"

#include "emulator/scenario/lamp_setup.h"
#include "emulator/scenario/motion_builder.h"
#include "emulator/scenario/site.h"
#include "render/sky/motion_bounds.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"

namespace hilcam {

namespace {

// Nadir has no direction at the centre of its own body.
std::string undefined_nadir(const ScenarioConfig& s, const PoseConfig& pose) {
    if (attitude_of(pose) != PoseConfig::Attitude::kNadir) return {};
    const std::string body(kBodyNames[index_of(pose.nadir_of)]);
    return ": the attitude nadir points to the centre of the body '" + body +
           "', and the position is there, or right above its pole" +
           (s.places.of("origin") == s.places.of("")
                ? "; is 'origin' missing? Without it the world's origin is the Earth's centre"
                : "");
}

}  // namespace

std::vector<Motion> initial_motions(const ScenarioConfig& scenario, TimeTai time) {
    const Bodies bodies = bodies_at(time, scenario.origin);
    const auto motion_of = [&](const PoseConfig& pose, const std::string& key) {
        if (pose.frame == PoseConfig::Frame::kLocal)
            return local_motion_at(pose, site_of(scenario).value(), time, scenario.origin);
        try {
            return initial_motion(pose, time, bodies);
        } catch (const InputError& error) {
            const std::string nadir = undefined_nadir(scenario, pose);
            throw InputError(
                scenario.places.at(key, key + (nadir.empty() ? ": " + std::string(error.what()) : nadir)));
        }
    };
    std::vector<Motion> motions = {motion_of(scenario.camera_pose, "camera_pose")};
    for (std::size_t i = 0; i < scenario.objects.size(); ++i)
        motions.push_back(motion_of(scenario.objects[i].pose, "objects." + std::to_string(i) + ".pose"));
    return motions;
}

std::vector<Joint> joints_of(const ScenarioConfig& scenario) {
    std::vector<Joint> joints;
    for (std::size_t i = 0; i < scenario.objects.size(); ++i)
        for (const JointConfig& joint : scenario.objects[i].joints)
            joints.push_back({i, joint.pivot_m, normalized(joint.axis), joint.angle_rad, joint.rate_rad_s});
    return joints;
}

WorldSnapshot snapshot_at(const ScenarioConfig& scenario, TimeTai start, TimeTai time) {
    WorldState state(initial_motions(scenario, start), scenario.origin, joints_of(scenario), scenario.mount,
                     load_motion_sources(scenario), lamp_mounts(scenario));
    WorldSnapshot world;
    world.objects.resize(state.placed_objects());
    ShownCommand shown;
    state.sample(time, world, shown);
    if (const std::string what = state.first_impossible(); !what.empty())
        throw InputError("the motion of " + what +
                         " is not a number or exceeds its limits; accepted: places up to " +
                         plain(kFarthestPlace_m) + " m from the origin, velocities up to " +
                         plain(kFastestMotion_m_s) + " m/s");
    return world;
}

}  // namespace hilcam
