#include "emulator/scenario/initial_world.h"

#include "emulator/scenario/lamp_setup.h"
#include "emulator/scenario/motion_builder.h"
#include "emulator/scenario/site.h"
#include "render/sky/motion_bounds.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"

namespace hilcam {

std::vector<Motion> initial_motions(const ScenarioConfig& scenario, TimeTai time) {
    const Bodies bodies = bodies_at(time, scenario.origin);
    const auto motion_of = [&](const PoseConfig& pose) {
        if (pose.frame == PoseConfig::Frame::kLocal)
            return local_motion_at(pose, site_of(scenario).value(), time, scenario.origin);
        return initial_motion(pose, time, bodies);
    };
    std::vector<Motion> motions = {motion_of(scenario.camera_pose)};
    for (const ObjectConfig& object : scenario.objects) motions.push_back(motion_of(object.pose));
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
                         " is no number or out of its bounds; accepted: places up to " +
                         plain(kFarthestPlace_m) + " m from the origin, velocities up to " +
                         plain(kFastestMotion_m_s) + " m/s");
    return world;
}

}  // namespace hilcam
