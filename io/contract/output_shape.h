#pragma once
// The facts that an output is told of the camera whose frames it gets, and what others ask of it.

#include <cstdint>
#include <functional>
#include <string>

namespace hilcam {

struct PictureRun;

struct OutputShape {
    int width = 0, height = 0;              // size of the largest frame
    int fixed_width = 0, fixed_height = 0;  // size of all frames, where an output needs one size
    double frame_rate_hz = 0;               // at power-up
    std::string camera_name{};
    const PictureRun* run = nullptr;  // the notes that pictures have of the run (io/images/picture_notes.h)
    bool has_live_output = false;     // another output hands the same frames to clients while they are made
    std::function<std::string()> status{};  // the run's figures as JSON; any thread, while the loop is there
};

// An address that an output or a command port listens on.
struct ListeningPort {
    std::string key;  // "outputs.preview.port"
    std::string address;
    std::int64_t port = 0;  // 0: none
    bool tcp = true;
};

}  // namespace hilcam
