#pragma once
// The record of a case, a file of JSON each, written once all else of the case is there: a case that has a
// record is done, or has failed. A case that failed for want of disk, memory or time of the machine has none.

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
    std::string reason;                                               // why it has failed; empty: it has not
    nlohmann::ordered_json frames = nlohmann::ordered_json::array();  // truth and labels of each picture
    std::vector<std::pair<std::string, std::uint64_t>> files;  // those of its pictures, with their bytes
    nlohmann::ordered_json figures = nlohmann::ordered_json::object();  // numbers by name, for the index
    // The times of its making, the one part that another making of the case has otherwise.
    double draw_s = 0, render_s = 0, sensor_s = 0, files_s = 0, all_s = 0;
    double cpu_s = 0;  // processor time of its process, all threads
    std::string begun_utc, host;
};

std::filesystem::path record_file(const std::filesystem::path& folder, std::uint64_t number);
// DeviceError when it cannot be written.
void write_record(const std::filesystem::path& folder, const CaseRecord& record);
// Nothing where there is none; InputError for a file that is no record.
std::optional<CaseRecord> read_record(const std::filesystem::path& folder, std::uint64_t number);
// Returns what is wrong with the case's files ("images/000003.png is missing"); empty: all are there, in their sizes.
std::string lost_file(const std::filesystem::path& folder, const CaseRecord& record);

// Thrown where the case itself went wrong, as it would again: its program, its time.
struct CaseFailure : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace hilcam
