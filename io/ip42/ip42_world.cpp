#include "io/ip42/ip42_world.h"

#include <algorithm>
#include <cmath>

#include "render/sky/motion_bounds.h"
#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr const char* kCamera = "camera";

std::string angle_text(double rad) { return plain(std::round(rad / kDegree_rad * 1e3) / 1e3) + " deg"; }

// Returns 0 for the camera's body, 1, 2, ... for objects; nothing for another name.
std::optional<std::uint16_t> thing_number(const std::string& name, const Ip42Bench& bench) {
    const auto at = std::find_if(bench.objects.begin(), bench.objects.end(),
                                 [&](const Ip42Bench::Object& o) { return o.name == name; });
    if (at != bench.objects.end()) return static_cast<std::uint16_t>(at - bench.objects.begin() + 1);
    if (name == kCamera) return 0;
    return {};
}

std::string names_of(const Ip42Bench& bench) {
    std::string names = kCamera;
    for (const Ip42Bench::Object& object : bench.objects) names += ", " + object.name;
    return names;
}

// The rotation of q about an axis (unit vector), -pi..pi, and what is left when it is taken off.
struct Twist {
    double angle_rad = 0, rest_rad = 0;
};
Twist twist_about(Quat q, Vec3d axis) {
    const Vec3d v{q.x, q.y, q.z};
    const double along = dot(v, axis);
    const double angle = 2 * std::atan2(along, q.w);
    const double rest = 2 * std::atan2(length(v - along * axis), std::hypot(along, q.w));
    return {std::remainder(angle, 2 * kPi), rest};
}

}  // namespace

Fields fields(Ip42BodyConfig& c) {
    return {
        required(text("body", c.body, "body of 42: SC[n].B[k], both from 0")),
        text("moves", c.moves,
             "thing that it moves: camera (the body that carries the cameras) or an "
             "object's name"),
        integer("joint", c.joint, {0, 65535},
                "joint of that object that it turns, from 1; 0: it moves the object itself"),
        optional(integer("orbit", c.orbit, {0, 9999}, "reference orbit of its spacecraft in 42 (RefOrb)"),
                 c.has_orbit),
        optional(vector3("place_m", c.place_m, 1, {-1e6, 1e6},
                         "origin of the thing from the spacecraft's centre of mass, in the axes of its B[0]"),
                 c.has_place),
        quaternion("attitude_wxyz", c.attitude, "rotation from the thing's axes to those of the body"),
    };
}

void validate(const Ip42BodyConfig& c) {
    if (!ip42_body_name(c.body)) throw refused_key("body", in_quotes(c.body), "SC[n].B[k], as SC[0].B[1]");
    if (c.joint > 0 && c.has_place)
        throw KeyError("place_m", "has no effect with 'joint': the scenario places the joint");
    if (c.joint > 0 && c.has_orbit) throw KeyError("orbit", "has no effect with 'joint'");
}

void check_bodies(const std::vector<Ip42BodyConfig>& bodies, const Ip42Bench& bench) {
    std::map<std::pair<std::uint16_t, std::int64_t>, std::string> moved;
    const auto key = [](std::size_t i, const char* name) {
        return "bodies." + std::to_string(i) + "." + name;
    };
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const Ip42BodyConfig& c = bodies[i];
        const auto thing = thing_number(c.moves, bench);
        if (!thing) throw refused_key(key(i, "moves"), in_quotes(c.moves), names_of(bench));
        const std::size_t joints = *thing == 0 ? 0 : bench.objects[*thing - std::size_t{1}].joint_axes.size();
        if (c.joint > static_cast<std::int64_t>(joints))
            throw refused_key(key(i, "joint"), std::to_string(c.joint),
                              joints == 0 ? "0, as " + in_quotes(c.moves) + " has no joints"
                                          : "0 to " + std::to_string(joints));
        const auto [other, is_new] = moved.emplace(std::pair{*thing, c.joint}, c.body);
        if (!is_new)
            throw refused_key(key(i, "moves"), in_quotes(c.moves),
                              "another thing, as " + other->second + " moves this one");
    }
    for (std::size_t i = 0; i < bodies.size(); ++i)
        if (bodies[i].joint > 0 && moved.count({*thing_number(bodies[i].moves, bench), 0}) == 0)
            throw KeyError(key(i, "joint"), "needs a body that moves " + in_quotes(bodies[i].moves) +
                                                " itself, against which its angle counts");
}

void FirstRemarks::remark(const std::string& topic, const std::string& text) {
    if (said_.size() >= kMost || !said_.insert(topic).second) return;
    remark_(said_.size() == kMost ? "more remarks than these are not shown" : text);
}

Ip42World::Ip42World(Rules rules, Ip42Bench bench, FirstRemarks& remarks)
    : rules_(std::move(rules)), bench_(std::move(bench)), remarks_(remarks) {}

void Ip42World::lacks(const std::string& what) {
    remarks_.remark(what, "42 sends no " + what +
                              ", so its thing stays where it is (prefixes \"SC\" and \"Orb\" in "
                              "Inp_IPC.txt?)");
}

std::vector<Command> Ip42World::commands_of(const Ip42Message& message) {
    bodies_ = bodies_at(message.time, bench_.origin);
    shift_m_ = shift_m_s_ = {};
    if (const auto center = bench_.origin.center()) {
        shift_m_ = bodies_[*center].world_m;
        shift_m_s_ = bodies_[*center].velocity_m_s;
    }
    std::vector<Command> commands;
    for (const Ip42BodyConfig& config : rules_.bodies) {
        if (config.joint > 0) {
            if (const auto joint = joint_of(message, config)) commands.push_back(*joint);
        } else if (const auto pose = pose_of(message, config)) {
            commands.push_back(*pose);
        }
    }
    return commands;
}

// Returns a body that has an attitude; null when the message lacks it.
const Ip42BodyState* Ip42World::body_in(const Ip42Message& message, const std::string& name) {
    const Ip42BodyName at = ip42_body_name(name).value_or(Ip42BodyName{});
    const auto craft = message.spacecraft.find(at.spacecraft);
    if (craft != message.spacecraft.end()) {
        const auto body = craft->second.bodies.find(at.body);
        if (body != craft->second.bodies.end() && body->second.n_from_body) return &body->second;
    }
    lacks(name + ".qn");
    return nullptr;
}

std::optional<Motion> Ip42World::motion_of(const Ip42Message& message, const Ip42BodyConfig& config) {
    const Ip42BodyState* const body = body_in(message, config.body);
    if (!body) return {};
    const std::int64_t number = ip42_body_name(config.body)->spacecraft;
    const std::string craft_name = "SC[" + std::to_string(number) + "]";
    const Ip42BodyState* const body0 = body_in(message, craft_name + ".B[0]");
    if (!body0) return {};
    const Ip42Spacecraft& craft = message.spacecraft.at(number);
    const auto orbit = message.orbits.find(config.orbit);
    if (!craft.position_r_m) return lacks(craft_name + ".PosR"), std::nullopt;
    if (orbit == message.orbits.end() || !orbit->second.position_n_m)
        return lacks("Orb[" + std::to_string(config.orbit) + "].PosN"), std::nullopt;

    const Mat3d& world_from_n = rules_.world_from_n;
    const Mat3d n_from_body0 = to_matrix(*body0->n_from_body);
    const Vec3d lever_n_m = n_from_body0 * config.place_m;
    const Vec3d turning_n_rad_s = n_from_body0 * body0->rate_body_rad_s.value_or(Vec3d{});
    const Vec3d place_n_m = *orbit->second.position_n_m + *craft.position_r_m + lever_n_m;
    const Vec3d velocity_n_m_s = orbit->second.velocity_n_m_s.value_or(Vec3d{}) +
                                 craft.velocity_r_m_s.value_or(Vec3d{}) + cross(turning_n_rad_s, lever_n_m);
    const Quat world_from_body = to_quat(world_from_n) * *body->n_from_body;
    Motion motion;
    motion.time = rules_.lockstep ? message.time : TimeTai{};
    motion.pose = {world_from_n * place_n_m + shift_m_, normalized(world_from_body * config.attitude)};
    motion.velocity_world_m_s = world_from_n * velocity_n_m_s + shift_m_s_;
    motion.rate_body_rad_s = transposed(to_matrix(config.attitude)) * body->rate_body_rad_s.value_or(Vec3d{});
    check_sun(message, craft, config, motion.pose.position_world_m);
    return motion;
}

std::optional<PoseCommand> Ip42World::pose_of(const Ip42Message& message, const Ip42BodyConfig& config) {
    const auto motion = motion_of(message, config);
    if (!motion) return {};
    if (const std::string why = impossible_part(*motion); !why.empty()) {
        remarks_.remark(config.body + " impossible", config.body + ": " + why);
        return {};
    }
    PoseCommand pose;
    pose.object = *thing_number(config.moves, bench_);
    pose.motion = *motion;
    pose.alone = rules_.lockstep;
    return pose;
}

std::optional<JointCommand> Ip42World::joint_of(const Ip42Message& message, const Ip42BodyConfig& config) {
    const auto object =
        std::find_if(rules_.bodies.begin(), rules_.bodies.end(),
                     [&](const Ip42BodyConfig& c) { return c.joint == 0 && c.moves == config.moves; });
    const Ip42BodyState* const base = body_in(message, object->body);
    const Ip42BodyState* const part = body_in(message, config.body);
    if (!base || !part) return {};
    const std::uint16_t thing = *thing_number(config.moves, bench_);
    const auto index = static_cast<std::size_t>(config.joint - 1);
    const Vec3d axis = normalized(bench_.objects[thing - std::size_t{1}].joint_axes[index]);

    const Quat n_from_object = *base->n_from_body * object->attitude;
    const Quat n_from_part = *part->n_from_body * config.attitude;
    const Twist twist = twist_about(conjugate(n_from_object) * n_from_part, axis);
    if (twist.rest_rad > rules_.tolerance_rad)
        remarks_.remark(config.body + " axis",
                        config.body + ": it is " + angle_text(twist.rest_rad) +
                            " off a turn about the axis of joint " + std::to_string(config.joint) + " of " +
                            in_quotes(config.moves) + " (attitude_wxyz, the joint's axis)");
    const Vec3d base_n_rad_s = to_matrix(*base->n_from_body) * base->rate_body_rad_s.value_or(Vec3d{});
    const Vec3d part_n_rad_s = to_matrix(*part->n_from_body) * part->rate_body_rad_s.value_or(Vec3d{});
    JointCommand joint;
    joint.object = thing;
    joint.joint = static_cast<std::uint16_t>(config.joint);
    joint.time = rules_.lockstep ? message.time : TimeTai{};
    // The angle nearest to the last, so that nothing turns back between two frames.
    const auto last = angles_rad_.find(&config);
    const double before_rad = last == angles_rad_.end() ? 0 : last->second;
    joint.angle_rad = before_rad + std::remainder(twist.angle_rad - before_rad, 2 * kPi);
    joint.rate_rad_s = dot(transposed(to_matrix(n_from_object)) * (part_n_rad_s - base_n_rad_s), axis);
    if (!is_possible_turn_of_joint(joint.angle_rad, joint.rate_rad_s)) {
        remarks_.remark(config.body + " impossible",
                        config.body + ": it turns faster or further than a joint can");
        return {};
    }
    angles_rad_[&config] = joint.angle_rad;
    return joint;
}

void Ip42World::check_sun(const Ip42Message& message, const Ip42Spacecraft& craft,
                          const Ip42BodyConfig& config, Vec3d place_world_m) {
    if (!craft.sun_body_dir || !bench_.origin.center() || !(length(*craft.sun_body_dir) > 0.5)) return;
    const std::string craft_name = config.body.substr(0, config.body.find('.'));
    const Ip42BodyState* const body0 = body_in(message, craft_name + ".B[0]");
    const Vec3d sun_dir = rules_.world_from_n * (to_matrix(*body0->n_from_body) * *craft.sun_body_dir);
    const double aside_rad = angle_between_rad(sun_dir, bodies_.sun_world_m - place_world_m);
    if (!(aside_rad <= rules_.tolerance_rad))
        remarks_.remark(craft_name + " sun",
                        craft_name + ".svb: 42 has the Sun " + angle_text(aside_rad) +
                            " from where the picture shows it (the scenario's ephemerides)");
}

}  // namespace hilcam
