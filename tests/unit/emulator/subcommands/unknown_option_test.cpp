#include "emulator/subcommands/unknown_option.h"

#include <gtest/gtest.h>

#include "emulator/subcommands/subcommands.h"

namespace hilcam {
namespace {

std::string told(const std::string& line) {
    CLI::App app("hilcam");
    Action action;
    add_run_command(app, action);
    add_mesh_command(app, action);
    try {
        app.parse(line);
    } catch (const CLI::ExtrasError&) {
        return unknown_option(app);
    } catch (const CLI::ParseError& error) {
        return error.what();
    }
    return "no error";
}

TEST(UnknownOption, AKeyIsToldToBeSet) {
    EXPECT_EQ(told("run geo_inspection --seed 1"),
              "run: not expected: '--seed 1'; 'seed' is a key of the scenario: --set seed=1");
    EXPECT_EQ(told("run geo_inspection --seed=7"),
              "run: not expected: '--seed=7'; 'seed' is a key of the scenario: --set seed=7");
    EXPECT_EQ(told("run geo_inspection --focal-length-mm 5"),
              "run: not expected: '--focal-length-mm 5'; 'camera.focal_length_mm' is a key of the scenario: --set "
              "camera.focal_length_mm=5");
}

TEST(UnknownOption, ASlipOfThePenHasTheNearestOption) {
    EXPECT_EQ(told("run geo_inspection --frame 5"), "run: not expected: '--frame 5'; nearest: --frames");
    EXPECT_EQ(told("run geo_inspection --colour"),
              "run: not expected: '--colour'; 'hilcam run --help' lists what is accepted");
    EXPECT_EQ(told("mesh a.obj --seed 1"),
              "mesh: not expected: '--seed 1'; 'hilcam mesh --help' lists what is accepted");
}

}  // namespace
}  // namespace hilcam
