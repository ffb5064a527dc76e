#pragma once
// This makes the views of a member of the zoo into scenarios, and has the camera that takes them.

#include <optional>
#include <string>
#include <vector>

#include "emulator/run/still_camera.h"
#include "emulator/zoo/zoo_views.h"

namespace hilcam {

// A shot is what a view changes of a member's scenario.
struct ZooShot {
    std::string name;
    std::optional<ZooStand> stand;  // stands of the camera and the target
    double exposure_factor = 1;     // on the scenario's
    std::optional<Pose>
        camera_body;  // without a stand: where the camera's body is; none: where the scenario has it
};

// camera: of that scenario, as loaded.
std::vector<ZooShot> zoo_shots(const ScenarioConfig& scenario, const StillCamera& camera, bool all_views);

// A camera that goes from shot to shot.
class ZooCamera {
  public:
    explicit ZooCamera(const ScenarioConfig& scenario)
        : scenario_(scenario), shown_(scenario), camera_(scenario) {}

    void take(const ZooShot& shot);
    // The scenario with the shot's poses and exposure.
    const ScenarioConfig& shown() const { return shown_; }
    StillCamera& camera() { return camera_; }

  private:
    ScenarioConfig scenario_, shown_;
    StillCamera camera_;
};
// Returns the scenario as a shot has it.
ScenarioConfig scenario_of_shot(const ScenarioConfig& scenario, const ZooShot& shot);
// Returns what --set must replace for `hilcam render` to show the shot: KEY=VALUE.
std::vector<std::string> overrides_of_shot(const ScenarioConfig& scenario, const ZooShot& shot);

// The surface that a camera sees, its places on the read-out array; none where frames have other pixels than that: binning.
// camera: as it stands.
struct SurfacePixels;
std::optional<SurfacePixels> seen_surface(StillCamera& camera);

}  // namespace hilcam
