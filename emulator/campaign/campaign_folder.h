#pragma once
// The folder of a campaign's results: which campaign it belongs to, who works in it, and which cases it has.
//
//   campaign.txt       everything that the cases depend on, one entry a line
//                      (emulator/scenario/scenario_listing.h)
//   campaign.lock      locked by each process that works here
//   cases/000001.json  record of a case (case_record.h)
//
// Everything else is derived from the cases, or belongs to one of them.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "emulator/campaign/campaign_config.h"
#include "io/system/fd.h"

namespace hilcam {

// Case numbers, from first to last inclusive.
struct CaseRange {
    std::uint64_t first = 1, last = 1;
};

class CampaignFolder {
  public:
    // Claims the folder for this campaign, or finds that it already belongs to it. shared: other processes
    // may work on other cases of it meanwhile. Removes what a killed program left behind, unless the folder
    // is shared. Throws InputError when the folder belongs to another campaign, holds other things or is in
    // use, and DeviceError when it cannot be written.
    CampaignFolder(const CampaignConfig& campaign, const std::filesystem::path& folder, bool shared);

    const std::filesystem::path& path() const { return folder_; }
    // Returns the cases of the range that have no readable record or have lost one of their files. failed:
    // also returns those that have failed.
    std::vector<std::uint64_t> missing(const CaseRange& range, bool failed) const;

  private:
    std::filesystem::path folder_;
    Fd lock_;

    void take_lock(bool shared);
    void check_identity(const CampaignConfig& campaign) const;
};

// Lists everything that a campaign's cases depend on. The number of cases and their time limit do not belong
// to it.
std::string campaign_listing(const CampaignConfig& campaign);

}  // namespace hilcam
