#pragma once
// Makes all that comes of a campaign's records once its cases are there: index.csv, times.csv, labels, shards, the
// page. Each file is written whole or not at all, and by the records alone: results that are put together
// twice, or from cases that several machines made, are the same bits, times apart.

#include <filesystem>

#include "emulator/campaign/campaign.h"

namespace hilcam {

// Reads the range's records and counts them into the outcome. complete: writes what is made of them.
void write_results(const CampaignConfig& campaign, const std::filesystem::path& folder,
                   const CaseRange& range, bool complete, CampaignOutcome& outcome);

}  // namespace hilcam
