#pragma once
// The command line: parses it and carries out what it asks for. Exit status: 0 for success, 1 for a failure
// at run time, 2 for wrong usage or input.

#include <functional>

namespace CLI {
class App;
}

namespace hilcam {

int run_command_line(int argc, char** argv);

// Adds all options and subcommands to an empty `app`. Parsing a command line with it sets `action` to the
// function that carries it out.
void set_up_command_line(CLI::App& app, std::function<int()>& action);

}  // namespace hilcam
