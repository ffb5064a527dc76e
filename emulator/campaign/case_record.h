#pragma once
// The record of a case, a file of JSON each, written once all else of the case is there: a case that has a
// record is done, or has failed.

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "emulator/campaign/case_plan.h"

namespace hilcam {

struct CaseRecord {
    CasePlan plan;
    bool done = false;
    std::string reason;                                               // why it has failed; empty: it has not
    nlohmann::ordered_json frames = nlohmann::ordered_json::array();  // truth and labels of each picture
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

}  // namespace hilcam
