#pragma once
// The command line: what the user asked for, done; exit status 0, 1 (failed at run time) or 2 (wrong usage or
// input).

#include <functional>

namespace CLI {
class App;
}

namespace hilcam {

int run_command_line(int argc, char** argv);

// Gives an empty `app` all options and subcommands. When it has parsed a command line, `action` is what that asks for.
void set_up_command_line(CLI::App& app, std::function<int()>& action);

}  // namespace hilcam
