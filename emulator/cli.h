#pragma once
// The command line: what the user asked for, done; exit status 0, 1 (failed at run time) or 2 (wrong usage or
// input).

namespace hilcam {

int run_command_line(int argc, char** argv);

}  // namespace hilcam
