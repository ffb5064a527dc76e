#pragma once
// Makes cases that consist of pictures and their labels.

#include <filesystem>
#include <vector>

#include "emulator/campaign/case_camera.h"
#include "emulator/campaign/case_record.h"
#include "emulator/campaign/keypoints.h"

namespace hilcam {

class PictureCases {
  public:
    // Loads the scene. The campaign must outlive this object. Throws InputError, DeviceError.
    explicit PictureCases(const CampaignConfig& campaign);

    // Makes a case, writes its files into the campaign's folder and returns its record, which it does not
    // write. Throws InputError for an impossible case, DeviceError when a file cannot be written.
    CaseRecord make(std::uint64_t number, const std::filesystem::path& folder);

    int loads() const { return camera_.loads(); }

  private:
    const CampaignConfig& campaign_;
    CaseDraw draw_;
    CaseCamera camera_;
    std::vector<KeypointSet> keypoints_;
};

// File names of a picture in the campaign's folder; index: from 0.
struct PictureNames {
    std::string stem;  // "000001", or "000001_02" if a case has several pictures
    std::filesystem::path frame, view, layers, depth, flow, variance;
};
PictureNames picture_names(const CampaignConfig& campaign, std::uint64_t number, std::int64_t index);

}  // namespace hilcam
