#pragma once
// A case whose result are pictures and what they show.

#include <filesystem>
#include <vector>

#include "emulator/campaign/case_camera.h"
#include "emulator/campaign/case_record.h"
#include "emulator/campaign/keypoints.h"

namespace hilcam {

class PictureCases {
  public:
    // Loads the scene. Throws InputError, DeviceError. The campaign outlives this.
    explicit PictureCases(const CampaignConfig& campaign);

    // Makes a case and writes its files into the campaign's folder, but for the record, which it returns. Throws
    // InputError for a case that cannot be, DeviceError when a file cannot be written.
    CaseRecord make(std::uint64_t number, const std::filesystem::path& folder);

    int loads() const { return camera_.loads(); }

  private:
    const CampaignConfig& campaign_;
    CaseDraw draw_;
    CaseCamera camera_;
    std::vector<KeypointSet> keypoints_;
};

// Names of a picture's files in the campaign's folder; index: from 0.
struct PictureNames {
    std::string stem;  // "000001", of several pictures a case "000001_02"
    std::filesystem::path frame, view, layers, depth, flow, variance;
};
PictureNames picture_names(const CampaignConfig& campaign, std::uint64_t number, std::int64_t index);

}  // namespace hilcam
