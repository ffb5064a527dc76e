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
    std::uint64_t absent = 0;                      // cases without a record, or without a file of theirs
    bool interrupted = false;                      // by a signal; results were not put together
    std::uint64_t before = 0, all = 0;             // cases that had an outcome before; cases that are wanted
    double seconds = 0;                            // that making them took, loading apart
    double load_s = 0;
    std::vector<std::string> failures;  // "000012: why", some of them
    std::uint64_t problems = 0;         // number of them all
};
// Adds a line to the failures, as long as there are few.
void add_problem(CampaignOutcome& outcome, std::string line);

// "31 of 400 done; the same command goes on"
std::string interruption_text(std::uint64_t done, std::uint64_t all);

// Makes what is missing; SIGINT and SIGTERM end it. Throws InputError, DeviceError: the campaign as a whole cannot be; a case that cannot
// be has failed, and the rest goes on.
CampaignOutcome run_campaign(const CampaignConfig& campaign, const CampaignOptions& options);

}  // namespace hilcam
