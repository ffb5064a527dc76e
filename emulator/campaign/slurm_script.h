#pragma once
// Runs a campaign as an array job of Slurm: each task makes a chunk of the cases on a file system that all
// nodes share, and a final job puts the results together (slurm.schedmd.com, sbatch(1), "Job Array Support").

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "emulator/campaign/campaign_config.h"

namespace hilcam {

struct SlurmPlan {
    std::string name;                                 // name of the campaign
    std::filesystem::path program, campaign, folder;  // absolute
    std::vector<std::string> overrides;               // values that override the campaign file's
    std::uint64_t count = 1, chunk = 1;               // cases in all, and in one task
    std::vector<std::uint64_t> tasks;                 // tasks with missing cases, from 0
};

// Returns the chunk of cases that one task makes in about task_s on one core.
std::uint64_t chunk_of(double case_s, double task_s);
// Returns the tasks that have at least one of the missing cases.
std::vector<std::uint64_t> tasks_of(const std::vector<std::uint64_t>& missing, std::uint64_t chunk);

// Return the scripts of the array job and of the final job. Slurm restarts a task of the array when its node
// dies.
std::string array_script(const SlurmPlan& plan);
std::string merge_script(const SlurmPlan& plan);

// Writes slurm/array.sh and slurm/merge.sh into the campaign's folder; with `submit`, hands them to sbatch.
// Returns one line for each thing done. Throws InputError when the folder's name has characters that a script
// cannot quote, and DeviceError when a file cannot be written or sbatch refuses.
std::vector<std::string> submit_campaign(const SlurmPlan& plan, bool submit);

}  // namespace hilcam
