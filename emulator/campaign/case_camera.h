#pragma once
// The camera that takes a campaign's pictures. It loads the scene once, and again only for a case that needs
// another scene.
//
// A loaded camera takes over new values of keys that only place or set things: poses, motions, joints,
// exposure, gain, seed, and the time if nothing loaded depends on it. Other keys of a case make it load the
// scene again.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emulator/campaign/campaign_config.h"
#include "emulator/check/camera_sheet.h"
#include "emulator/run/still_camera.h"

namespace hilcam {

class CaseCamera {
  public:
    // Reads the campaign's scenario and loads the files it names. Throws InputError, DeviceError.
    explicit CaseCamera(const CampaignConfig& campaign);

    // Takes over the scenario with these overrides. Throws InputError, DeviceError; the camera can then still
    // take the next case.
    void take(const std::vector<std::string>& overrides);
    // Moves the same scenario to another time [s after its start].
    void take_time(double time_offset_s);

    StillCamera& camera() { return *camera_; }
    const StillCamera& camera() const { return *camera_; }
    const ScenarioConfig& scenario() const { return scenario_; }
    std::size_t number() const { return number_; }
    std::size_t target() const { return target_; }
    // Returns the data sheet of the case's camera, at the case's gain and the campaign's exposure. A sheet
    // takes long to compute, so it is kept while nothing but the exposure changes.
    const CameraSheet& sheet();
    // Returns how many times a scene was loaded.
    int loads() const { return loads_; }

  private:
    std::filesystem::path file_;
    std::size_t number_, target_;
    bool time_is_free_ = false, has_own_shapes_ = false;
    ScenarioConfig scenario_;
    std::string scene_;  // overrides that the loaded scene depends on
    std::unique_ptr<StillCamera> camera_;
    int loads_ = 0;
    std::optional<CameraSheet> sheet_;
    std::string sheet_listing_;  // camera that the sheet describes
    double sheet_exposure_s_ = 0;

    ScenarioConfig read(const std::vector<std::string>& overrides) const;
    std::string scene_of(const std::vector<std::string>& overrides) const;
    void load(const ScenarioConfig& scenario, std::string scene);
};

// True when cases have shapes, air or light settings of their own, so that caching what is derived from them
// does not pay. A scale does not count: what is derived from a mesh serves it at all scales.
bool draws_own_shapes(const CampaignConfig& campaign);
// True for a key of which a loaded camera takes over new values. time_is_free: nothing that was loaded
// depends on the time.
bool is_taken_over(const std::string& key, bool time_is_free);

}  // namespace hilcam
