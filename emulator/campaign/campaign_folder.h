#pragma once
// The folder of a campaign's results: whose it is, who works in it, which cases are there.
//
//   campaign.txt       all that the cases depend on, a line each (emulator/scenario/scenario_listing.h)
//   campaign.lock      held by whoever works here
//   cases/000001.json  what is kept of a case (case_record.h)
// Everything else is made of the cases, or belongs to one.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "emulator/campaign/campaign_config.h"
#include "io/system/fd.h"

namespace hilcam {

// The numbers of the cases from first to last.
struct CaseRange {
    std::uint64_t first = 1, last = 1;
};

class CampaignFolder {
  public:
    // Makes the folder this campaign's, or finds that it is. shared: others work on other cases of it now.
    // InputError when it is another campaign's, or holds other things, or somebody works in it; DeviceError
    // when it cannot be written. Leftovers of a program that was killed are removed unless it is shared.
    CampaignFolder(const CampaignConfig& campaign, const std::filesystem::path& folder, bool shared);

    const std::filesystem::path& path() const { return folder_; }
    // The cases of the range that have no record, or one that cannot be read, or have lost a file of theirs; with
    // failed, those that have failed, too.
    std::vector<std::uint64_t> missing(const CaseRange& range, bool failed) const;

  private:
    std::filesystem::path folder_;
    Fd lock_;

    void take_lock(bool shared);
    void check_identity(const CampaignConfig& campaign) const;
};

// All that a campaign's cases depend on; not how many there are, nor how long each may take.
std::string campaign_listing(const CampaignConfig& campaign);

}  // namespace hilcam
