#pragma once
// Configures which truth of a camera's frames is sent, and where to (docs/truth.md).

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/contract/output_shape.h"
#include "io/contract/run_folder.h"
#include "io/contract/when_slow.h"
#include "render/frame/frame_truth.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

struct TruthConfig {
    static constexpr const char* kKey = "truth";
    static constexpr const char* kMeaning = "truth of each frame, as known by the renderer (docs/truth.md)";

    std::string address = "127.0.0.1";
    std::int64_t port = 0;  // 0: none
    std::vector<std::string> allow{};
    std::int64_t clients = 8;
    std::vector<std::string> udp_to{};
    std::filesystem::path folder{};  // empty: no files
    std::vector<std::string> layers{};
    bool visibility = true;
    bool stars = true;
    double faintest_magnitude = 30;
    double ground_px = 0;  // 0: no craters and boulders
    std::int64_t every_nth = 1;
    bool overwrite = false;
    WhenSlow when_slow = WhenSlow::kAuto;  // when truth comes too fast for the folder
};
Fields fields(TruthConfig& config);
void validate(const TruthConfig& config);
std::vector<ListeningPort> listening(const TruthConfig& config);

// Returns the folder, which must not be mixed with another run's. The folder must not be empty.
RunFolder run_folder(const TruthConfig& config);
// Returns what the renderer has to report; thing_of_object is left empty.
TruthRequest request_of(const TruthConfig& config);

}  // namespace hilcam
