// `hilcam ground`: what a scenario's ground has about a place, as comma-separated values.

#include <spdlog/fmt/fmt.h>

#include "emulator/ground/ground_survey.h"
#include "emulator/scenario/scene_loader.h"
#include "emulator/scenario/site.h"
#include "emulator/subcommands/arguments.h"
#include "emulator/subcommands/scenario_use.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

struct GroundArguments {
    ConfigArguments config;
    std::string what;
    std::vector<double> at_deg;
    GroundSurvey survey;
};

int carry_out(const GroundArguments& o) {
    const ScenarioConfig scenario = load_and_warn(o.config);
    if (!scenario.terrain || !scenario.terrain->globe)
        throw InputError(o.config.file.string() +
                         ": has no terrain.globe; accepted: a scenario with the ground of a body");
    GroundSurvey survey = o.survey;
    if (!o.at_deg.empty())
        survey.middle = {o.at_deg[0] * kDegree_rad, o.at_deg[1] * kDegree_rad, 0};
    else if (scenario.site)
        survey.middle = scenario.site->place;
    else
        throw InputError(
            "--at: is needed, as the scenario has no site; accepted: a longitude and a latitude [deg]");
    fmt::print("{}", survey_ground(*scenario.terrain->globe, ground_body(scenario), survey));
    return 0;
}

}  // namespace

void add_ground_command(CLI::App& app, Action& action) {
    auto o = std::make_shared<GroundArguments>();
    CLI::App* ground = app.add_subcommand(
        "ground", "list the craters, boulders, or heights and slopes of a scenario's ground about a place");
    add_config(ground, o->config);
    const std::map<std::string, GroundSurvey::What> kinds = {{"craters", GroundSurvey::What::kCraters},
                                                             {"boulders", GroundSurvey::What::kBoulders},
                                                             {"heights", GroundSurvey::What::kHeights}};
    ground->add_option("--list", o->survey.what, "craters, boulders or heights")
        ->required()
        ->transform(CLI::CheckedTransformer(kinds));
    ground->add_option("--at", o->at_deg, "longitude and latitude [deg]; left out: the scenario's site")
        ->expected(2)
        ->check(CLI::Range(-360.0, 360.0));
    ground
        ->add_option("--within-m", o->survey.within_m,
                     "distance from there [m]; half the edge of a square of heights")
        ->check(CLI::Range(0.01, 1e6));
    ground->add_option("--smallest-m", o->survey.smallest_m, "least diameter [m]")
        ->check(CLI::Range(0.0, 1e6));
    ground->add_option("--spacing-m", o->survey.spacing_m, "distance of the heights [m]")
        ->check(CLI::Range(1e-3, 1e5));
    when_named(ground, action, o, carry_out);
}

}  // namespace hilcam
