#include "emulator/campaign/campaign_results.h"

#include <algorithm>
#include <memory>

#include "emulator/campaign/case_record.h"
#include "emulator/campaign/label_writer.h"
#include "emulator/campaign/view_draw.h"
#include "emulator/progress/progress.h"
#include "emulator/scenario/app_config.h"
#include "io/files/value_table_file.h"
#include "io/system/durable_file.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

std::string figure_text(const nlohmann::ordered_json& value) {
    if (value.is_boolean()) return value.get<bool>() ? "1" : "0";
    if (value.is_number_float()) return exact_number(value.get<double>());
    return value.dump();
}

// Writes index.csv, which is bit for bit the same when the cases are made again, and times.csv, which is not.
class IndexWriter {
  public:
    explicit IndexWriter(const CampaignConfig& campaign) : parameters_(CaseDraw(campaign).columns()) {
        if (campaign.view) {
            const std::vector<std::string> more = view_columns(*campaign.view);
            parameters_.insert(parameters_.end(), more.begin(), more.end());
        }
    }

    void add(const CaseRecord& record) {
        for (const auto& [name, value] : record.figures.items())
            if (std::find(figures_.begin(), figures_.end(), name) == figures_.end()) figures_.push_back(name);
        Row row{first_fields(record), {}};
        for (const auto& [key, value] : record.plan.parameters)
            row.values.emplace_back(key, csv_field(value));
        for (const auto& [name, value] : record.figures.items())
            row.values.emplace_back("figure " + name, figure_text(value));
        rows_.push_back(std::move(row));
        times_ += record.plan.name + ',' + record.begun_utc + ',' + csv_field(record.host);
        for (const double seconds :
             {record.all_s, record.cpu_s, record.draw_s, record.render_s, record.sensor_s, record.files_s})
            times_ += ',' + exact_number(seconds);
        times_ += '\n';
    }

    void write(const std::filesystem::path& folder) const {
        std::string text = "case,split,outcome,reason,seed,tries";
        for (const std::string& key : parameters_) text += ',' + csv_field(key);
        for (const std::string& name : figures_) text += ',' + csv_field(name);
        text += '\n';
        for (const Row& row : rows_) {
            text += row.first;
            for (const std::string& key : parameters_) text += ',' + row.value(key);
            for (const std::string& name : figures_) text += ',' + row.value("figure " + name);
            text += '\n';
        }
        write_durably(folder / "index.csv", text);
        write_durably(folder / "times.csv",
                      "case,begun_utc,host,all_s,cpu_s,draw_s,render_s,sensor_s,files_s\n" + times_);
    }

  private:
    struct Row {
        std::string first;
        std::vector<std::pair<std::string, std::string>> values;

        std::string value(const std::string& name) const {
            const auto found =
                std::find_if(values.begin(), values.end(), [&](const auto& v) { return v.first == name; });
            return found == values.end() ? std::string() : found->second;
        }
    };
    std::vector<std::string> parameters_, figures_;
    std::vector<Row> rows_;
    std::string times_;

    static std::string first_fields(const CaseRecord& r) {
        return r.plan.name + ',' + r.plan.split + ',' + (r.done ? "done" : "failed") + ',' +
               csv_field(r.reason) + ',' + std::to_string(r.plan.seed) + ',' + std::to_string(r.plan.tries);
    }
};

LabelContext context_of(const CampaignConfig& campaign, const std::filesystem::path& folder) {
    LabelContext context{campaign, folder, {}, {}, load_keypoints(campaign.keypoints), false, 0};
    const ScenarioConfig scenario = scenario_of_camera(load_scenario(campaign.scenario, campaign.set),
                                                       static_cast<std::size_t>(campaign.camera) - 1);
    for (const ObjectConfig& object : scenario.objects) context.objects.push_back(object.name);
    if (scenario.terrain) context.objects.push_back(scenario.terrain->name);
    context.shapes = scenario.objects;
    context.has_colors = campaign.pictures.view && !scenario.camera.color_filter.pattern.empty();
    context.pitch_m = scenario.camera.pitch_m * static_cast<double>(scenario.camera.binning_x);
    return context;
}

std::vector<std::unique_ptr<LabelWriter>> label_writers(const LabelContext& context) {
    std::vector<std::unique_ptr<LabelWriter>> out;
    for (const std::string& word : context.campaign.labels)
        out.push_back(word == "coco"   ? make_coco_labels(context)
                      : word == "bop"  ? make_bop_labels(context)
                      : word == "yolo" ? make_yolo_labels(context)
                                       : make_speed_labels(context));
    if (context.campaign.shard_samples > 0) out.push_back(make_shards(context));
    return out;
}

void count_record(const CaseRecord& record, CampaignOutcome& outcome) {
    ++(record.done ? outcome.done : outcome.failed);
    if (!record.done) add_problem(outcome, record.plan.name + ": " + record.reason);
}

// Returns the record of a case that has all its files. Otherwise returns nothing, with a problem if a record
// exists.
std::optional<CaseRecord> whole_record(const std::filesystem::path& folder, std::uint64_t number,
                                       CampaignOutcome& outcome) {
    try {
        std::optional<CaseRecord> record = read_record(folder, number);
        const std::string lost = record ? lost_file(folder, *record) : std::string();
        if (lost.empty()) return record;
        add_problem(outcome, record->plan.name + ": " + lost);
    } catch (const InputError& problem) {
        add_problem(outcome, problem.what());
    }
    return {};
}

}  // namespace

void write_results(const CampaignConfig& campaign, const std::filesystem::path& folder,
                   const CaseRange& range, bool complete, CampaignOutcome& outcome) {
    Progress progress("results", static_cast<double>(range.last - range.first + 1));
    IndexWriter index(campaign);
    std::vector<std::unique_ptr<LabelWriter>> labels;
    if (complete) labels = label_writers(context_of(campaign, folder));
    for (std::uint64_t n = range.first; n <= range.last; ++n) {
        progress.done(static_cast<double>(n - range.first));
        const std::optional<CaseRecord> record = whole_record(folder, n, outcome);
        if (!record) {
            ++outcome.absent;
            continue;
        }
        count_record(*record, outcome);
        if (!complete) continue;
        index.add(*record);
        if (record->done)
            for (const auto& writer : labels) writer->add(*record);
    }
    if (!complete) return;
    for (const auto& writer : labels) writer->finish();
    index.write(folder);
}

}  // namespace hilcam
