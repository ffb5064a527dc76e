#pragma once
// `hilcam campaign`: makes all cases of a campaign, on this machine alone or as one of several.

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
    std::optional<CaseRange> cases;  // makes these cases alone; results are then not put together
    std::size_t jobs = 0;            // cases made at once; 0: one per core
    bool retry = false;              // true: makes failed cases again
    bool merge = false;              // true: makes no case and puts existing ones together
};

struct CampaignOutcome {
    std::uint64_t done = 0, failed = 0, made = 0;  // records of each outcome; cases made by this call
    std::uint64_t absent = 0;                      // cases that lack a record or one of its files
    bool interrupted = false;           // true: a signal ended it, and results were not put together
    std::uint64_t before = 0, all = 0;  // cases with an outcome beforehand; cases wanted in all
    double seconds = 0;                 // time for making the cases, without loading
    double load_s = 0;
    std::vector<std::string> failures;  // "000012: why", for some of the failures
    std::uint64_t problems = 0;         // number of all failures
};
// Adds a line to the outcome's failures unless the list is full, and counts it.
void add_problem(CampaignOutcome& outcome, std::string line);

// "31 of 400 done; the same command goes on"
std::string interruption_text(std::uint64_t done, std::uint64_t all);

// Makes the missing cases; SIGINT and SIGTERM end it. A case that is impossible counts as failed, and the
// others go on. Throws InputError, DeviceError when the campaign as a whole is impossible.
CampaignOutcome run_campaign(const CampaignConfig& campaign, const CampaignOptions& options);

}  // namespace hilcam
