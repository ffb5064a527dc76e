#pragma once
// Runs another program and waits for its end.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hilcam {

// Runs the program with this one's standard input and output. arguments: without its own name. Returns its
// exit status, -1 when a signal ended it; nothing when it cannot be started.
std::optional<int> run_program(const std::filesystem::path& program, std::vector<std::string> arguments);

}  // namespace hilcam
