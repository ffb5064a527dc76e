#pragma once
// A run of a scenario that is watched for what its loop allocates between some of its frames.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace hilcam {

enum class Loop {
    kUnpaced,    // as fast as it goes, without outputs
    kTold,       // the same, with the outputs that the scenario has
    kPaced,      // at the camera's rate
    kGoverned,   // the same, and the governor holds a rate that becomes another one every few frames
    kStreaming,  // the same, with a GigE Vision camera whose frames an application takes
    kLookedAt,   // with a preview whose pictures, their truth and parts of their light somebody looks at
};

struct Seen {
    int allocations = 0;           // of the program's own
    int terrain_allocations = 0;   // of the thread that makes the ground's meshes
    std::uint64_t bytes_read = 0;  // by the process and its readers of maps, out of files
    std::uint32_t level_changes = 0;
};

// Runs a scenario of the source tree with these values changed, and fails the test where frames or what readers take do not come. A
// camera that does not fly by itself is commanded to a place beside the satellite.
Seen watch_run(const std::vector<std::string>& overrides, Loop loop, const std::filesystem::path& record = {},
               const char* scenario_file = "tests/protocol/minimal_scenario.yaml");

}  // namespace hilcam
