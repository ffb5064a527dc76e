#pragma once
// Interface to a recorder that keeps what each frame was made with, so that the frame can be made again
// (recorder.h).

#include <cstdint>

#include "emulator/loop/frame_script.h"

namespace hilcam {

class FrameRecorder {
  public:
    virtual ~FrameRecorder() = default;
    // The camera's next frame shows this command of a thing (WorldState::things) as its newest. number: the
    // command's number. Loop.
    virtual void keep_shown(std::uint16_t camera, std::uint32_t thing, std::uint64_t number) noexcept = 0;
    // Keeps the data of the camera's frame as it is handed to the outputs. Loop.
    virtual void keep_frame(std::uint16_t camera, const FrameUse& use) noexcept = 0;
};

}  // namespace hilcam
