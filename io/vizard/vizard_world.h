#pragma once
// A simulator's messages as commands of this bench: which time it is, where the camera and the objects are.
//
// World: the message's frame N has the world's axes (ICRF; "J2000" is within 0.02 arcsec of it) and another
// origin. The scenario's central body is in both: world = N - body_N + body_world. Without that body in the
// message, N's origin is taken for its centre. With an origin in free space N is the world.
//
// Time: epoch of the run's first message + elapsed time, or with `time: scenario` the scenario's start +
// elapsed time.
//
// Camera: the message's own place and direction on its spacecraft count, not the scenario's mount: the body
// that the camera is fixed to is put so that the camera is where the message has it. Its optics and its
// detector are the scenario's; where the message says another field of view or size, a remark does.
//
// Objects: spacecraft and celestial bodies of the message that have the name of an object of the scenario.
// Others are not shown; objects that the message does not name stay where they are.
//
// Sun and planets are the scenario's own (render/sky/bodies.h), as light time, aberration and turning are in
// them. Where the message has one elsewhere than they do, by more than the tolerance and as the camera sees
// it, a remark says so.
//
// Motion during an exposure: the message's velocity, and no turning, as rates are not in it.

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

// Says which of the simulator's cameras is which of the bench's.
struct VizardCameraConfig {
    std::int64_t id = 1;
    std::int64_t camera = 1;
};
Fields fields(VizardCameraConfig& config);

enum class VizardTime { kMessage, kScenario };

// The bench's offer: what a simulator may use.
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
    // `remark` gets each remark once in a run of the simulator.
    VizardWorld(const Rules& rules, VizardBench bench, Remark remark);

    // The world as it is from now on.
    void take(VizardUpdate update);
    // The world is not known any more: what came could not be read.
    void lose() { known_ = false; }
    // Finds what camera `id` of the simulator shows now. False, with a remark, when there is nothing to show.
    bool shot(std::int64_t id, VizardShot& shot);
    // The simulator's first camera; none before a SIM_UPDATE that can be read.
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
    // Those of one topic once, whatever their figures.
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
