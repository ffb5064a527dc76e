#pragma once
// A case that is a run of the bench: `hilcam run`, and the user's program beside it.
//
// The case's folder, runs/000001, gets hilcam.log, program.log and report.json. What the program writes to
// result.json there, numbers by name, becomes columns of the index. The program is started once the camera
// runs, with these words in its arguments and in `run.set` replaced: {case}, {seed}, {slot} (which
// of the cases that run at once, from 1), {case_folder}, {udp_port}, {tcp_port}; and the same as environment
// variables HILCAM_CASE, ... The two ports are free ones of 127.0.0.1, where the scenario has such an input.

#include <cstddef>
#include <filesystem>

#include "emulator/campaign/case_record.h"

namespace hilcam {

// Throws InputError, DeviceError: the case has failed, and why.
CaseRecord make_program_case(const CampaignConfig& campaign, const CasePlan& plan,
                             const std::filesystem::path& folder, std::size_t slot);

}  // namespace hilcam
