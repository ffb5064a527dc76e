// `hilcam manual`: every key of a scenario file; and `make-pages`.

#include <spdlog/fmt/fmt.h>

#include <filesystem>

#include "emulator/campaign/campaign_config.h"
#include "emulator/recording/program_version.h"
#include "emulator/run/report.h"
#include "emulator/scenario/app_config.h"
#include "emulator/send/command_examples.h"
#include "emulator/subcommands/arguments.h"
#include "emulator/subcommands/command_pages.h"
#include "io/config/config_keys.h"
#include "io/config/config_manual.h"
#include "io/config/config_schema.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

struct ManualArguments {
    std::string prefix;
    bool json = false, schema = false, campaign = false;
};

int carry_out(const ManualArguments& o) {
    ScenarioConfig scenario;
    CampaignConfig campaign;
    const SectionField root = o.campaign ? section_of(campaign) : section_of(scenario);
    const std::string whole = o.campaign ? "campaign" : "scenario";
    if (o.schema)
        fmt::print("{}", config_schema(root, o.prefix, "hilcam " + (o.prefix.empty() ? whole : o.prefix)));
    else
        fmt::print("{}", o.json ? config_manual_json(root, o.prefix) : config_manual(root, o.prefix));
    return 0;
}

int make_pages(const CLI::App& app, const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    const CommandText program = described(app);
    for (const NamedText& page : manual_pages(program, std::string(kProgramVersion)))
        write_text(folder / page.name, page.text);
    ScenarioConfig scenario;
    write_text(folder / "hilcam.bash", bash_completion(program, config_keys(fields(scenario))));
    return 0;
}

}  // namespace

void add_manual_command(CLI::App& app, Action& action) {
    auto o = std::make_shared<ManualArguments>();
    CLI::App* manual = app.add_subcommand("manual", "print the keys of a scenario file as a Markdown table");
    manual->add_option("prefix", o->prefix,
                       "only this key and those below it, as camera.shutter or objects.N.pose");
    manual->add_flag("--campaign", o->campaign, "the keys of a campaign file (docs/campaigns.md)");
    CLI::Option* json = manual->add_flag("--json", o->json, "machine-readable");
    manual
        ->add_flag("--schema", o->schema,
                   "print a JSON Schema (draft 2020-12) of a scenario file, or of a file that holds the "
                   "section PREFIX")
        ->excludes(json);
    set_examples(manual, {"hilcam manual camera.shutter", "hilcam manual camera --schema"});
    when_named(manual, action, o, carry_out);
}

void add_pages_command(CLI::App& app, Action& action) {
    auto folder = std::make_shared<std::filesystem::path>();
    CLI::App* pages = app.add_subcommand("make-pages", "manual pages and completion, into a folder");
    pages->group("");
    pages->add_option("folder", *folder)->required();
    pages->callback(
        [&app, &action, folder] { action = [&app, folder] { return make_pages(app, *folder); }; });
}

}  // namespace hilcam
