// `hilcam campaign`: thousands of cases of a scenario.

#include <spdlog/spdlog.h>

#include "emulator/campaign/campaign.h"
#include "emulator/campaign/case_record.h"
#include "emulator/campaign/end_request.h"
#include "emulator/campaign/slurm_script.h"
#include "emulator/run/page_maker.h"
#include "emulator/send/command_examples.h"
#include "emulator/subcommands/arguments.h"
#include "emulator/subcommands/scenario_use.h"
#include "io/system/program_files.h"
#include "io/system/text_number.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

struct CampaignArguments {
    ConfigArguments config;
    CampaignOptions options;
    std::uint64_t only = 0;  // --case; 0: not given
    std::string cases;       // "1-1000"
    bool slurm = false, submit = true;
    double task_s = 900;
};

CaseRange parsed_cases(const std::string& text) {
    const std::size_t dash = text.find('-');
    const auto first = parsed_as<std::uint64_t>(std::string_view(text).substr(0, dash));
    const auto last =
        dash == std::string::npos ? first : parsed_as<std::uint64_t>(std::string_view(text).substr(dash + 1));
    if (!first || !last)
        throw InputError("--cases: found " + in_quotes(text) + "; accepted: FIRST-LAST, as 1-1000");
    return {*first, *last};
}

void say_outcome(const CampaignOutcome& outcome, const std::filesystem::path& folder) {
    for (const std::string& failure : outcome.failures) spdlog::error("{}", failure);
    if (outcome.problems > outcome.failures.size())
        spdlog::error("... and {} more; index.csv has those that have failed",
                      outcome.problems - outcome.failures.size());
    if (outcome.made > 0)
        spdlog::info("{} cases made in {:.1f} s, {:.2f} a second, after {:.1f} s of loading", outcome.made,
                     outcome.seconds, static_cast<double>(outcome.made) / outcome.seconds, outcome.load_s);
    spdlog::info("{} done, {} failed{}; {}", outcome.done, outcome.failed,
                 outcome.absent > 0
                     ? fmt::format(", {} not made, or without a file of theirs: the same command makes them",
                                   outcome.absent)
                     : "",
                 folder.string());
}

// Estimates the time of a case from existing cases; if there are none, makes the first one here.
double seconds_of_case(const CampaignConfig& campaign, const CampaignOptions& options) {
    const CaseRange all{1, static_cast<std::uint64_t>(campaign.count)};
    if (CampaignFolder(campaign, options.out, true).missing(all, false).size() ==
        static_cast<std::uint64_t>(campaign.count)) {
        CampaignOptions first = options;
        first.cases = CaseRange{1, 1};
        first.jobs = 1;
        if (run_campaign(campaign, first).interrupted)
            throw DeviceError("interrupted; nothing was submitted");
    }
    double sum_s = 0;
    int count = 0;
    for (std::uint64_t n = 1; n <= all.last && count < 100; ++n)
        if (const auto record = read_record(options.out, n)) sum_s += record->all_s, ++count;
    return count > 0 ? sum_s / count : 1;
}

int go_to_slurm(const CampaignArguments& o, const CampaignConfig& campaign) {
    const double case_s = seconds_of_case(campaign, o.options);
    SlurmPlan plan{campaign.name,
                   program_file(),
                   std::filesystem::absolute(o.config.file),
                   std::filesystem::absolute(o.options.out),
                   o.config.overrides,
                   static_cast<std::uint64_t>(campaign.count),
                   chunk_of(case_s, o.task_s),
                   {}};
    const CampaignFolder folder(campaign, o.options.out, true);
    plan.tasks = tasks_of(folder.missing({1, plan.count}, false), plan.chunk);
    if (plan.tasks.empty()) {
        spdlog::info("no case is missing; --merge puts them together");
        return 0;
    }
    spdlog::info("a case takes {:.2f} s here", case_s);
    for (const std::string& line : submit_campaign(plan, o.submit)) spdlog::info("{}", line);
    return 0;
}

int carry_out(const CampaignArguments& o) {
    const CampaignConfig campaign = load_campaign(o.config.file, o.config.overrides);
    if (o.slurm) return go_to_slurm(o, campaign);
    CampaignOptions options = o.options;
    if (!o.cases.empty()) options.cases = parsed_cases(o.cases);
    if (o.only > 0) options.cases = CaseRange{o.only, o.only};
    const CampaignOutcome outcome = run_campaign(campaign, options);
    if (outcome.interrupted) {
        spdlog::info("{}", interruption_text(outcome.before + outcome.made, outcome.all));
        return kInterruptedStatus;
    }
    say_outcome(outcome, options.out);
    if (!options.cases) {
        try {
            run_page_maker("hilcam-plot-campaign", {options.out.string()});
        } catch (const DeviceError& problem) {
            log_warning(problem.what());
        }
    }
    return outcome.failed + outcome.absent == 0 ? 0 : 1;
}

}  // namespace

void add_campaign_command(CLI::App& app, Action& action) {
    auto o = std::make_shared<CampaignArguments>();
    CLI::App* campaign = app.add_subcommand("campaign", "make thousands of cases of a scenario, with labels");
    campaign->add_option("config", o->config.file, "campaign file (YAML)")->required();
    add_overrides(campaign, o->config.overrides, "the campaign");
    campaign
        ->add_option("--out", o->options.out, "folder of the results; one that holds this campaign's goes on")
        ->required();
    campaign->add_option("--jobs", o->options.jobs, "number of cases at once (default: one per core)")
        ->check(CLI::Range(std::size_t{1}, std::size_t{1024}));
    CLI::Option* only = campaign->add_option("--case", o->only, "make this case alone, from 1")
                            ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000'000}));
    CLI::Option* cases =
        campaign
            ->add_option(
                "--cases", o->cases,
                "FIRST-LAST: make these alone; others may be made at the same time, by other machines, too")
            ->excludes(only);
    campaign->add_flag("--retry", o->options.retry, "make failed cases again");
    campaign->add_flag("--merge", o->options.merge, "make no case; put together what there is")
        ->excludes(only)
        ->excludes(cases);
    CLI::Option* slurm =
        campaign
            ->add_flag("--slurm", o->slurm,
                       "write what is missing as an array job of Slurm, and submit it where there is sbatch")
            ->excludes(only)
            ->excludes(cases);
    campaign->add_flag("!--no-submit", o->submit, "write the job's scripts, and submit nothing")
        ->needs(slurm);
    campaign->add_option("--task-s", o->task_s, "approximate duration of a Slurm task [s]")
        ->check(CLI::PositiveNumber)
        ->capture_default_str()
        ->needs(slurm);
    set_examples(campaign, {"hilcam campaign views.yaml --out views",
                            "hilcam campaign views.yaml --out views --case 17 --retry"});
    when_named(campaign, action, o, carry_out);
}

}  // namespace hilcam
