#pragma once
// A case that is a run: `hilcam run`, with the user's program beside it.
//
// The case's folder, runs/000001, receives hilcam.log, program.log and report.json. Numbers that the program
// writes by name to result.json there become columns of the index. The program starts once the camera runs.
// In its arguments and in `run.set` these words are replaced: {case}, {seed}, {slot} (which of the cases that
// run at once, from 1), {case_folder}, {udp_port}, {tcp_port}. The environment variables HILCAM_CASE, ...
// have the same values. The two ports are free ones of 127.0.0.1; a case has them if the scenario has such an
// input.

#include <cstddef>
#include <filesystem>

#include "emulator/campaign/case_record.h"

namespace hilcam {

// Throws InputError, DeviceError when the case has failed; the message says why.
CaseRecord make_program_case(const CampaignConfig& campaign, const CasePlan& plan,
                             const std::filesystem::path& folder, std::size_t slot);

}  // namespace hilcam
