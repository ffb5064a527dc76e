#pragma once
// Says what an output needs to know of its camera, and the addresses on which outputs and command ports
// listen.

#include <cstdint>
#include <functional>
#include <string>

namespace hilcam {

struct PictureRun;

struct OutputShape {
    int width = 0, height = 0;              // size of the largest frame
    int fixed_width = 0, fixed_height = 0;  // size of every frame, for outputs that need one size
    double frame_rate_hz = 0;               // at power-up
    std::string camera_name{};
    const PictureRun* run = nullptr;  // the run's notes in image files (io/images/picture_notes.h)
    bool has_live_output = false;     // another output sends the same frames to clients during the run
    // Returns the run's figures as JSON; any thread, while the loop exists.
    std::function<std::string()> status{};
};

// An address on which an output or a command port listens.
struct ListeningPort {
    std::string key;  // "outputs.preview.port"
    std::string address;
    std::int64_t port = 0;  // 0: none
    bool tcp = true;
};

}  // namespace hilcam
