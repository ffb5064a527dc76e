#pragma once
// Turns a simulator's messages into commands of this bench: the time, and the poses of camera and objects.
//
// World: the message's frame N has the world's axes (ICRF; "J2000" is within 0.02 arcsec of it) and another
// origin. Both contain the scenario's central body: world = N - body_N + body_world. When the message lacks
// that body, its centre is assumed at N's origin. With an origin in free space, N is the world.
//
// Time: the epoch in the run's first message + elapsed time, or with `time: scenario` the scenario's start +
// elapsed time.
//
// Camera: the message's position and direction on the spacecraft replace the scenario's mount. The body that
// carries the camera is placed so that the camera is where the message says. Optics and detector are the
// scenario's; a remark reports a field of view or size in the message that differs.
//
// Objects: spacecraft and celestial bodies in the message with the name of an object of the scenario. Others
// are not shown; objects that the message does not name keep their poses.
//
// Sun and planets are the scenario's own (render/sky/bodies.h), with light time, aberration and rotation. A
// remark reports a body that the message puts elsewhere, as the camera sees it, by more than the tolerance.
//
// Motion during an exposure: the message's velocity and no rotation, because the message has no rates.

#include <array>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "io/contract/command.h"
#include "io/vizard/vizard_message.h"
#include "render/sky/bodies.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

// Maps a camera of the simulator to one of the bench.
struct VizardCameraConfig {
    std::int64_t id = 1;
    std::int64_t camera = 1;
};
Fields fields(VizardCameraConfig& config);

enum class VizardTime { kMessage, kScenario };

// The part of the bench that a simulator may use.
struct VizardBench {
    struct Camera {
        Pose body_from_camera;  // pose of its mount on the body that object 0's poses move
        double field_of_view_rad = 0;
        int width_px = 0, height_px = 0;
    };
    TimeTai start;
    OriginConfig origin;
    std::vector<std::string> objects;
    std::vector<Camera> cameras;
};

// A picture to be taken.
struct VizardShot {
    std::uint16_t camera = 0;  // from 1
    TimeTai time;              // middle of the exposure
    std::vector<PoseCommand> poses;
};

class VizardWorld {
  public:
    struct Rules {
        VizardTime time = VizardTime::kMessage;
        double tolerance_rad = 0;
        std::vector<VizardCameraConfig> cameras{};  // empty: in the messages' order
    };
    using Remark = std::function<void(const std::string&)>;
    // remark: gets each remark once per run of the simulator.
    VizardWorld(const Rules& rules, VizardBench bench, Remark remark);

    // Sets the world from a message.
    void take(VizardUpdate update);
    // Forgets the world, because a message could not be read.
    void lose() { known_ = false; }
    // Finds what camera `id` of the simulator shows. Returns false, with a remark, when there is nothing to
    // show.
    bool shot(std::int64_t id, VizardShot& shot);
    // Returns the simulator's first camera; none before a readable SIM_UPDATE.
    std::optional<std::int64_t> first_camera() const {
        if (!known_ || update_.cameras.empty()) return {};
        return update_.cameras.front().id;
    }
    std::int64_t frame_number() const { return update_.frame_number; }
    void remark(const std::string& text) { remark_once(text, text); }

  private:
    // The shift from the message's frame to the world's.
    struct Shift {
        Vec3d position_m, velocity_m_s;
    };
    // Passes on the first remark of each topic, whatever its figures.
    void remark_once(const std::string& topic, const std::string& text);
    bool refuse(const std::string& reason);
    std::size_t bench_camera(std::size_t place, std::int64_t id) const;
    const VizardThing* parent_of(const VizardCamera& camera) const;
    TimeTai time() const { return start_ + update_.elapsed_ns; }
    Shift shift_at(TimeTai time, const Bodies& bodies);
    Motion motion_of(const VizardThing& thing, const Shift& shift);
    void pose_objects(const Shift& shift, std::vector<PoseCommand>& poses);
    void check_camera(const VizardCamera& camera, const VizardBench::Camera& own);
    void check_bodies(const Bodies& bodies, const Shift& shift, Vec3d camera_world_m);

    Rules rules_;
    VizardBench bench_;
    Remark remark_;
    std::set<std::string> said_;
    std::size_t said_in_all_ = 0;
    VizardUpdate update_;
    TimeTai start_;  // start of the simulation
    bool epoch_known_ = false, known_ = false;
};

}  // namespace hilcam
