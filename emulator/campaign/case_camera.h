#pragma once
// The camera that takes a campaign's pictures: loaded once, and again only for a case whose scene is another.
//
// Keys that only place and set what was loaded (poses, motions, joints, exposure, gain, seed, and the time
// where nothing that was loaded depends on it) are taken over without loading anything. Whatever else a case
// has of its own is loaded for it.

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
    // Reads the campaign's scenario, and loads what it names. Throws InputError, DeviceError.
    explicit CaseCamera(const CampaignConfig& campaign);

    // Becomes the camera of a scenario of these overrides. Throws InputError, DeviceError; the next case finds
    // it ready all the same.
    void take(const std::vector<std::string>& overrides);
    // The same scenario so many seconds later.
    void take_time(double time_offset_s);

    StillCamera& camera() { return *camera_; }
    const StillCamera& camera() const { return *camera_; }
    const ScenarioConfig& scenario() const { return scenario_; }
    std::size_t number() const { return number_; }
    std::size_t target() const { return target_; }
    // Returns the data sheet of the case's camera at its gain and at the campaign's exposure, whatever its own: a sheet
    // takes long to make, so one is kept as long as nothing else of the camera changes.
    const CameraSheet& sheet();
    // Returns how often a scene was loaded.
    int loads() const { return loads_; }

  private:
    std::filesystem::path file_;
    std::size_t number_, target_;
    bool time_is_free_ = false, has_own_shapes_ = false;
    ScenarioConfig scenario_;
    std::string scene_;  // the overrides that what is loaded depends on
    std::unique_ptr<StillCamera> camera_;
    int loads_ = 0;
    std::optional<CameraSheet> sheet_;
    std::string sheet_listing_;  // camera of that sheet
    double sheet_exposure_s_ = 0;

    ScenarioConfig read(const std::vector<std::string>& overrides) const;
    std::string scene_of(const std::vector<std::string>& overrides) const;
    void load(const ScenarioConfig& scenario, std::string scene);
};

// True when cases have shapes, air or settings of light that no other case has: what is made of those is not worth
// keeping. A size is none: what is made of a mesh serves it in all sizes.
bool draws_own_shapes(const CampaignConfig& campaign);
// True for a key that a loaded camera takes over. time_is_free: nothing that was loaded depends on the time.
bool is_taken_over(const std::string& key, bool time_is_free);

}  // namespace hilcam
