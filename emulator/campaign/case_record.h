#pragma once
// The record of a case: a JSON file, written after all other files of the case. A case with a record is done
// or has failed. A case that stopped because the machine ran out of disk, memory or time has no record.

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "emulator/campaign/case_plan.h"

namespace hilcam {

struct CaseRecord {
    CasePlan plan;
    bool done = false;
    std::string reason;                                               // why it failed; empty: it did not
    nlohmann::ordered_json frames = nlohmann::ordered_json::array();  // truth and labels of each picture
    // Files of its pictures, with their sizes in bytes.
    std::vector<std::pair<std::string, std::uint64_t>> files;
    nlohmann::ordered_json figures = nlohmann::ordered_json::object();  // numbers by name, for the index
    // Times of making it. They are the only part that differs when the case is made again.
    double draw_s = 0, render_s = 0, sensor_s = 0, files_s = 0, all_s = 0;
    double cpu_s = 0;  // processor time of its process, over all threads
    std::string begun_utc, host;
};

std::filesystem::path record_file(const std::filesystem::path& folder, std::uint64_t number);
// Throws DeviceError when the file cannot be written.
void write_record(const std::filesystem::path& folder, const CaseRecord& record);
// Returns nothing when the case has no record. Throws InputError for a file that is not a record.
std::optional<CaseRecord> read_record(const std::filesystem::path& folder, std::uint64_t number);
// Returns what is wrong with the case's files ("images/000003.png is missing"); empty: all are there with
// their recorded sizes.
std::string lost_file(const std::filesystem::path& folder, const CaseRecord& record);

// Thrown when the case itself went wrong and would do so again: its program failed, or it took too long.
struct CaseFailure : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace hilcam
