#pragma once
// `hilcam campaign`: all cases of a campaign, made on this machine or as one of several.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "emulator/campaign/campaign_config.h"
#include "emulator/campaign/campaign_folder.h"

namespace hilcam {

struct CampaignOptions {
    std::filesystem::path out;
    std::optional<CaseRange> cases;  // only these; then results are not put together
    std::size_t jobs = 0;            // cases at once; 0: one per core
    bool retry = false;              // cases that have failed once more
    bool merge = false;              // make no case: put together what there is
};

struct CampaignOutcome {
    std::uint64_t done = 0, failed = 0, made = 0;  // records of each outcome; cases that this call has made
    std::uint64_t absent = 0;                      // cases without a record
    double seconds = 0;                            // that making them took, loading apart
    double load_s = 0;
    std::vector<std::string> failures;  // "000012: why", some of them
};

// Makes what is missing. Throws InputError, DeviceError: the campaign as a whole cannot be; a case that cannot
// be has failed, and the rest goes on.
CampaignOutcome run_campaign(const CampaignConfig& campaign, const CampaignOptions& options);

}  // namespace hilcam
