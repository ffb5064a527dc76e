// `hilcam doctor`: what this machine lacks to run a bench.

#include <spdlog/fmt/fmt.h>

#include "emulator/check/doctor.h"
#include "emulator/check/doctor_facts.h"
#include "emulator/send/command_examples.h"
#include "emulator/subcommands/arguments.h"
#include "emulator/subcommands/scenario_use.h"

namespace hilcam {
namespace {

struct DoctorArguments {
    ConfigArguments config;  // no file: nothing is required
    bool json = false;
};

int carry_out(const DoctorArguments& o) {
    const BenchNeeds needs = o.config.file.empty() ? BenchNeeds{} : needs_of(load_and_warn(o.config));
    const std::vector<Finding> findings = diagnose(needs, look_at_machine(needs));
    fmt::print("{}", o.json ? findings_json(findings) : findings_text(findings));
    return all_there(findings) ? 0 : 1;
}

}  // namespace

void add_doctor_command(CLI::App& app, Action& action) {
    auto o = std::make_shared<DoctorArguments>();
    CLI::App* doctor = app.add_subcommand("doctor",
                                          "report what this machine lacks for a bench, and the remedy; "
                                          "status 1: CONFIG needs something that is missing");
    doctor
        ->add_option("config", o->config.file,
                     "scenario file (YAML), or the name of a shipped one; none: nothing is required")
        ->transform(name_of_shipped());
    add_overrides(doctor, o->config.overrides, "the scenario");
    doctor->add_flag("--json", o->json, "machine-readable");
    set_examples(doctor, {"hilcam doctor", "hilcam doctor geo_inspection"});
    when_named(doctor, action, o, carry_out);
}

}  // namespace hilcam
