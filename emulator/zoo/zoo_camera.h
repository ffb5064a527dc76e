#pragma once
// Turns the views of a member of the zoo into scenarios, and provides the camera that takes them.

#include <optional>
#include <string>
#include <vector>

#include "emulator/run/still_camera.h"
#include "emulator/zoo/zoo_views.h"

namespace hilcam {

// A shot: the changes that a view makes to a member's scenario.
struct ZooShot {
    std::string name;
    std::optional<ZooStand> stand;    // poses of the camera and the target
    double exposure_factor = 1;       // factor on the scenario's exposure
    std::optional<Pose> camera_body;  // without a stand: pose of the camera's body; empty: as in the scenario
};

// camera: loaded for that scenario.
std::vector<ZooShot> zoo_shots(const ScenarioConfig& scenario, const StillCamera& camera, bool all_views);

// A camera that goes from shot to shot.
class ZooCamera {
  public:
    explicit ZooCamera(const ScenarioConfig& scenario)
        : scenario_(scenario), shown_(scenario), camera_(scenario) {}

    void take(const ZooShot& shot);
    // Returns the scenario with the shot's poses and exposure.
    const ScenarioConfig& shown() const { return shown_; }
    StillCamera& camera() { return camera_; }

  private:
    ScenarioConfig scenario_, shown_;
    StillCamera camera_;
};
// Returns the scenario with the shot's changes.
ScenarioConfig scenario_of_shot(const ScenarioConfig& scenario, const ZooShot& shot);
// Returns KEY=VALUE overrides with which `hilcam render` shows the shot.
std::vector<std::string> overrides_of_shot(const ScenarioConfig& scenario, const ZooShot& shot);

// Returns the surfaces that the camera sees, on the read-out array's pixels; nothing with binning, where
// frames have other pixels. camera: in its present position.
struct SurfacePixels;
std::optional<SurfacePixels> seen_surface(StillCamera& camera);

}  // namespace hilcam
