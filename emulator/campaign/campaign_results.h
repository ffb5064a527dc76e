#pragma once
// Derives all results from a campaign's records once its cases are complete: index.csv, times.csv, labels,
// shards, the page. Each file is written whole or not at all, and depends on the records alone: putting
// results together twice, or from cases of several machines, gives the same bits except for times.

#include <filesystem>

#include "emulator/campaign/campaign.h"

namespace hilcam {

// Reads the range's records and counts them into the outcome. complete: also writes the results.
void write_results(const CampaignConfig& campaign, const std::filesystem::path& folder,
                   const CaseRange& range, bool complete, CampaignOutcome& outcome);

}  // namespace hilcam
