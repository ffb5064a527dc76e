#include "emulator/campaign/case_record.h"

#include "io/system/durable_file.h"
#include "io/system/input_file.h"
#include "io/system/plain_words.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson json_of_record(const CaseRecord& r) {
    OrderedJson parameters = OrderedJson::object();
    for (const auto& [key, value] : r.plan.parameters) parameters[key] = value;
    OrderedJson files = OrderedJson::object();
    for (const auto& [file, bytes] : r.files) files[file] = bytes;
    return {{"version", 1},
            {"case", r.plan.number},
            {"name", r.plan.name},
            {"split", r.plan.split},
            {"outcome", r.done ? "done" : "failed"},
            {"reason", r.reason},
            {"seed", r.plan.seed},
            {"tries", r.plan.tries},
            {"set", r.plan.overrides},
            {"parameters", parameters},
            {"figures", r.figures},
            {"frames", r.frames},
            {"files", files},
            {"took",
             {{"begun_utc", r.begun_utc},
              {"host", r.host},
              {"all_s", r.all_s},
              {"cpu_s", r.cpu_s},
              {"draw_s", r.draw_s},
              {"render_s", r.render_s},
              {"sensor_s", r.sensor_s},
              {"files_s", r.files_s}}}};
}

}  // namespace

std::filesystem::path record_file(const std::filesystem::path& folder, std::uint64_t number) {
    return folder / "cases" / (case_name(number) + ".json");
}

void write_record(const std::filesystem::path& folder, const CaseRecord& record) {
    write_durably(record_file(folder, record.plan.number),
                  json_of_record(record).dump(-1, ' ', false, OrderedJson::error_handler_t::replace) + '\n');
}

std::optional<CaseRecord> read_record(const std::filesystem::path& folder, std::uint64_t number) {
    const std::filesystem::path file = record_file(folder, number);
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return {};
    const std::string text = read_input_file(file, {256u << 20, "a case's record"});
    try {
        const OrderedJson json = OrderedJson::parse(text);
        CaseRecord r;
        r.plan.number = json.at("case");
        r.plan.name = json.at("name");
        r.plan.split = json.at("split");
        r.done = json.at("outcome") == "done";
        r.reason = json.at("reason");
        r.plan.seed = json.at("seed");
        r.plan.tries = json.at("tries");
        r.plan.overrides = json.at("set").get<std::vector<std::string>>();
        for (const auto& [key, value] : json.at("parameters").items())
            r.plan.parameters.emplace_back(key, value.get<std::string>());
        r.figures = json.at("figures");
        r.frames = json.at("frames");
        for (const auto& [name, bytes] : json.at("files").items())
            r.files.emplace_back(name, bytes.get<std::uint64_t>());
        const OrderedJson& took = json.at("took");
        r.begun_utc = took.at("begun_utc"), r.host = took.at("host");
        r.all_s = took.at("all_s"), r.draw_s = took.at("draw_s"), r.render_s = took.at("render_s");
        r.sensor_s = took.at("sensor_s"), r.files_s = took.at("files_s"), r.cpu_s = took.at("cpu_s");
        if (r.plan.number != number) throw InputError("is of case " + std::to_string(r.plan.number));
        return r;
    } catch (const std::exception& problem) {
        throw InputError(file.string() + ": is no record of a case (" + plain_words(problem) +
                         "); make the case again");
    }
}

std::string lost_file(const std::filesystem::path& folder, const CaseRecord& record) {
    for (const auto& [name, bytes] : record.files) {
        std::error_code error;
        const std::uintmax_t found = std::filesystem::file_size(folder / name, error);
        if (error) return name + " is missing";
        if (found != bytes)
            return name + " has " + std::to_string(found) + " bytes of " + std::to_string(bytes);
    }
    return {};
}

}  // namespace hilcam
