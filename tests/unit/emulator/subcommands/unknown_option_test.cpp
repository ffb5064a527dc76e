#include "emulator/subcommands/unknown_option.h"

#include <gtest/gtest.h>

#include "emulator/subcommands/subcommands.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

// Any file will do: the line is not carried out.
class UnknownOption : public FilesTest {
  protected:
    std::string run() { return "run " + write("bench.yaml", "name: bench\n").string() + " "; }
};

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

TEST_F(UnknownOption, AKeyIsToldToBeSet) {
    EXPECT_EQ(told(run() + "--seed 1"),
              "run: not expected: '--seed 1'; 'seed' is a key of the scenario: --set seed=1");
    EXPECT_EQ(told(run() + "--seed=7"),
              "run: not expected: '--seed=7'; 'seed' is a key of the scenario: --set seed=7");
    EXPECT_EQ(
        told(run() + "--focal-length-mm 5"),
        "run: not expected: '--focal-length-mm 5'; 'camera.focal_length_mm' is a key of the scenario: --set "
        "camera.focal_length_mm=5");
}

TEST_F(UnknownOption, ASlipOfThePenHasTheNearestOption) {
    EXPECT_EQ(told(run() + "--frame 5"), "run: not expected: '--frame 5'; nearest: --frames");
    EXPECT_EQ(told(run() + "--colour"),
              "run: not expected: '--colour'; 'hilcam run --help' lists what is accepted");
    EXPECT_EQ(told("mesh a.obj --seed 1"),
              "mesh: not expected: '--seed 1'; 'hilcam mesh --help' lists what is accepted");
}

}  // namespace
}  // namespace hilcam
