// `hilcam ground`: lists a scenario's ground around a place, as comma-separated values.

#include <spdlog/fmt/fmt.h>

#include "emulator/ground/map_report.h"
#include "emulator/run/ground_footprint.h"
#include "emulator/scenario/scene_loader.h"
#include "emulator/scenario/site.h"
#include "emulator/send/command_examples.h"
#include "emulator/subcommands/arguments.h"
#include "emulator/subcommands/scenario_use.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

const std::map<std::string, GroundSurvey::What> kLists = {{"craters", GroundSurvey::What::kCraters},
                                                          {"boulders", GroundSurvey::What::kBoulders},
                                                          {"heights", GroundSurvey::What::kHeights},
                                                          {"hazards", GroundSurvey::What::kHazards}};

struct GroundArguments {
    ConfigArguments config;
    std::string list;
    std::vector<double> at_deg;
    GroundSurvey survey;
    double slope_deg = HazardLimits{}.slope_rad / kDegree_rad;
    bool footprint = false;
    GroundFootprint seen;
    std::filesystem::path out;
};

int carry_out_footprint(const GroundArguments& o, const ScenarioConfig& scenario,
                        const GroundSurvey& survey) {
    const bool hazards = survey.what == GroundSurvey::What::kHazards;
    if (survey.what == GroundSurvey::What::kHeights)
        throw InputError("--footprint: found --list heights; accepted: craters, boulders or hazards");
    if (hazards != !o.out.empty() || (hazards && o.out.extension() != ".exr"))
        throw InputError("--out: goes with --footprint and hazards, which are a picture (.exr)");
    if (hazards)
        write_hazards(scenario, survey, o.seen, o.out);
    else
        fmt::print("{}", survey_footprint(scenario, survey, o.seen));
    return 0;
}

// Prints the site's axes at the scenario's start.
int list_axes(const ScenarioConfig& scenario) {
    const std::optional<PlaceConfig> site = site_of(scenario);
    if (!site)
        throw InputError("site: there is none in this scenario; accepted: one with a site, for its axes");
    PoseConfig axes;
    axes.frame = PoseConfig::Frame::kLocal;
    const Pose pose = local_motion_at(axes, *site, parse_utc(scenario.time_utc), scenario.origin).pose;
    const Vec3d p = pose.position_world_m;
    const Quat q = pose.world_from_body;
    fmt::print("x_m,y_m,z_m,w,x,y,z\n{:.4f},{:.4f},{:.4f},{:.15f},{:.15f},{:.15f},{:.15f}\n", p.x, p.y, p.z,
               q.w, q.x, q.y, q.z);
    return 0;
}

int carry_out(const GroundArguments& o) {
    const ScenarioConfig scenario = load_and_warn(o.config);
    if (o.list == "axes") return list_axes(scenario);
    if (!scenario.terrain || !scenario.terrain->globe)
        throw InputError(o.config.file.string() +
                         ": has no terrain.globe; accepted: a scenario with the ground of a body");
    const MapReport maps = report_maps(*scenario.terrain->globe, ground_body(scenario));
    for (const std::string& line : maps.taken) log_info(line);
    log_warnings(maps.doubts);
    GroundSurvey survey = o.survey;
    survey.what = kLists.at(o.list);
    survey.limits.slope_rad = o.slope_deg * kDegree_rad;
    if (o.footprint) return carry_out_footprint(o, scenario, survey);
    if (!o.out.empty()) throw InputError("--out: goes with --footprint and hazards");
    if (!o.at_deg.empty())
        survey.middle = {o.at_deg[0] * kDegree_rad, o.at_deg[1] * kDegree_rad, 0};
    else if (const auto site = site_of(scenario))
        survey.middle = site->place;
    else
        throw InputError(
            "--at: is needed, as the scenario has no site; accepted: a longitude and a latitude [deg]");
    fmt::print("{}", survey_ground(*scenario.terrain->globe, ground_body(scenario), survey));
    return 0;
}

}  // namespace

void add_ground_command(CLI::App& app, Action& action) {
    auto o = std::make_shared<GroundArguments>();
    CLI::App* ground = app.add_subcommand("ground",
                                          "list the craters, boulders, or heights, slopes and hazards of a "
                                          "scenario's ground about a place, or in a picture");
    add_config(ground, o->config);
    std::vector<std::string> names = {"axes"};
    for (const auto& [name, what] : kLists) names.push_back(name);
    ground
        ->add_option("--list", o->list,
                     "craters, boulders, heights, hazards (heights with a judgement), or axes: the site's "
                     "place and axes in the world, for pose commands there")
        ->required()
        ->check(CLI::IsMember(names));
    ground->add_option("--at", o->at_deg, "longitude and latitude [deg]; left out: the scenario's site")
        ->expected(2)
        ->check(CLI::Range(-360.0, 360.0));
    ground
        ->add_option("--within-m", o->survey.within_m,
                     "distance from there [m]; half the edge of a square of heights")
        ->check(CLI::Range(0.01, 1e6));
    ground->add_option("--smallest-m", o->survey.smallest_m, "least diameter [m]")
        ->check(CLI::Range(0.0, 1e6));
    ground->add_option("--spacing-m", o->survey.spacing_m, "spacing of the heights [m]")
        ->check(CLI::Range(1e-3, 1e5));
    ground->add_option("--slope-deg", o->slope_deg, "hazards: greatest safe slope [deg]")
        ->check(CLI::Range(0.0, 90.0));
    ground->add_option("--step-m", o->survey.limits.step_m, "hazards: greatest safe step [m]")
        ->check(CLI::Range(0.0, 1e4));
    ground->add_flag(
        "--footprint", o->footprint,
        "what the camera's picture shows, with its places there; --at and --within-m have no effect");
    ground->add_option("--time-offset-s", o->seen.time_offset_s,
                       "footprint: seconds after the scenario's start");
    ground->add_option("--smallest-px", o->seen.smallest_px, "footprint: least diameter in the picture [px]")
        ->check(CLI::Range(0.1, 1e4));
    ground->add_option("--out", o->out, "footprint: picture of the hazards, .exr");
    set_examples(ground, {"hilcam ground lunar_landing --list craters --within-m 500",
                          "hilcam ground lunar_landing --list heights --at 23.47 0.67"});
    when_named(ground, action, o, carry_out);
}

}  // namespace hilcam
