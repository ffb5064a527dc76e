// The whole command line: every command's help has examples, and each of them is a command.

#include "emulator/cli.h"

#include <gmock/gmock.h>

#include "emulator/send/choice_option.h"
#include "emulator/send/command_examples.h"
#include "emulator/subcommands/subcommands.h"

namespace hilcam {
namespace {

using testing::HasSubstr;
using testing::Not;

// The commands that people see, with those below them.
void gather(const CLI::App& app, const std::string& name,
            std::vector<std::pair<std::string, const CLI::App*>>& out) {
    out.emplace_back(name, &app);
    for (const CLI::App* below : app.get_subcommands([](const CLI::App*) { return true; }))
        if (!below->get_group().empty()) gather(*below, name + " " + below->get_name(), out);
}

TEST(CommandLine, EveryExampleOfEveryHelpIsACommand) {
    CLI::App app;
    Action action;
    set_up_command_line(app, action);
    std::vector<std::pair<std::string, const CLI::App*>> commands;
    gather(app, "hilcam", commands);
    ASSERT_GT(commands.size(), 25u);
    for (const auto& [name, command] : commands) {
        const std::vector<std::string> examples = examples_of(*command);
        EXPECT_FALSE(examples.empty()) << name;
        bool shows_itself = name == "hilcam";
        for (const std::string& example : examples) {
            CLI::App again;
            Action asked;
            set_up_command_line(again, asked);
            try {
                again.parse(example, true);
                EXPECT_TRUE(asked) << example;
            } catch (const CLI::CallForHelp&) {
            } catch (const CLI::ParseError& error) {
                ADD_FAILURE() << example << ": " << error.what();
            }
            // Options of `send` stand before the command that it sends.
            const std::string own = name.substr(name.rfind(' ') + 1);
            shows_itself |= (example + " ").find(" " + own + " ") != std::string::npos;
        }
        EXPECT_TRUE(shows_itself) << name;
    }
}

TEST(CommandLine, WhatIsHiddenIsOfferedToNobody) {
    CLI::App app;
    Action action;
    set_up_command_line(app, action);
    try {
        app.parse("hilcam make-page", true);
        FAIL();
    } catch (const CLI::ParseError&) {
        EXPECT_THAT(unknown_subcommand(app),
                    HasSubstr("unknown subcommand 'make-page'; accepted: run prepare recording"));
        EXPECT_THAT(unknown_subcommand(app), Not(HasSubstr("make-pages")));
    }
    EXPECT_THAT(app.help(), Not(HasSubstr("make-pages")));
}

}  // namespace
}  // namespace hilcam
