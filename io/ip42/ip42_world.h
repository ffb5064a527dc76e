#pragma once
// Turns 42's messages into commands of this bench: poses of the camera's body and of objects, angles of
// joints.
//
// World: 42's frame N has its origin at the centre of the orbit's world. At the Earth its axes are the mean
// equator and equinox of 2000, which are ICRF within 0.02 arcsec. At other planets they are turned by the
// pole's right ascension and declination, R3(90 deg + ra) R1(90 deg - dec) (Source/42init.c, LoadPlanets):
// `pole_deg`. In free space N is the world.
//
// Place: centre of mass = Orb[k].PosN + SC[n].PosR, and the same for velocities. A thing's own origin is at
// `place_m` from it, in the axes of the spacecraft's body 0.
//
// Attitude: that of the body the thing stands for, times `attitude_wxyz`, the rotation from the thing's axes
// to the body's. A joint's angle is the twist about its axis of its body's attitude relative to that of the
// body its object stands for: q = (object)^-1 (part), angle = 2 atan2(q . axis, w).
//
// Sun and planets are the scenario's own. A remark says when 42's direction of the Sun (svb) differs.

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "io/contract/command.h"
#include "io/ip42/ip42_message.h"
#include "render/sky/bodies.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

// Maps a body of 42 to the thing of the scenario that it moves.
struct Ip42BodyConfig {
    std::string body;
    std::string moves = "camera";
    std::int64_t joint = 0;  // from 1; 0: the thing itself
    std::int64_t orbit = 0;
    Vec3d place_m;
    Quat attitude;
    bool has_place = false, has_orbit = false;
};
Fields fields(Ip42BodyConfig& config);
void validate(const Ip42BodyConfig& config);

// The part of the bench that 42 moves.
struct Ip42Bench {
    struct Object {
        std::string name;
        std::vector<Vec3d> joint_axes;  // in the object's axes
    };
    OriginConfig origin;
    std::vector<Object> objects;
};
// Throws KeyError for a name or joint that the bench does not have, and for a thing that two bodies move. The
// keys begin with "bodies.N".
void check_bodies(const std::vector<Ip42BodyConfig>& bodies, const Ip42Bench& bench);

// Passes on the first remark of each topic, and at most kMost in all.
class FirstRemarks {
  public:
    static constexpr std::size_t kMost = 100;
    using Remark = std::function<void(const std::string&)>;
    explicit FirstRemarks(Remark remark) : remark_(std::move(remark)) {}
    void remark(const std::string& topic, const std::string& text);
    void remark(const std::string& text) { remark(text, text); }

  private:
    Remark remark_;
    std::set<std::string> said_;
};

class Ip42World {
  public:
    struct Rules {
        std::vector<Ip42BodyConfig> bodies{};
        Mat3d world_from_n{};
        double tolerance_rad = 0;
        bool lockstep = false;  // false: poses hold on arrival
    };
    // remarks: outlives the world.
    Ip42World(Rules rules, Ip42Bench bench, FirstRemarks& remarks);

    // Returns the commands that a message means, in the order of the rules. A body that it lacks is named
    // and moves nothing.
    std::vector<Command> commands_of(const Ip42Message& message);
    // Forgets earlier angles, because another run begins.
    void restart() { angles_rad_.clear(); }

  private:
    const Ip42BodyState* body_in(const Ip42Message& message, const std::string& name);
    std::optional<Motion> motion_of(const Ip42Message& message, const Ip42BodyConfig& config);
    std::optional<PoseCommand> pose_of(const Ip42Message& message, const Ip42BodyConfig& config);
    std::optional<JointCommand> joint_of(const Ip42Message& message, const Ip42BodyConfig& config);
    void lacks(const std::string& what);
    void check_sun(const Ip42Message& message, const Ip42Spacecraft& craft, const Ip42BodyConfig& config,
                   Vec3d place_world_m);

    Rules rules_;
    Ip42Bench bench_;
    FirstRemarks& remarks_;
    // State of the orbits' centre in the world at the present message's time.
    Vec3d shift_m_, shift_m_s_;
    Bodies bodies_;
    std::map<const Ip42BodyConfig*, double> angles_rad_;  // last angle of each joint
};

}  // namespace hilcam
