#pragma once
// Whoever keeps what each frame was made with, so that it can be made again (recorder.h).

#include <cstdint>

#include "emulator/loop/frame_script.h"

namespace hilcam {

class FrameRecorder {
  public:
    virtual ~FrameRecorder() = default;
    // The camera's next frame shows the command of this number of a thing (WorldState::things) at the newest.
    // Loop.
    virtual void keep_shown(std::uint16_t camera, std::uint32_t thing, std::uint64_t number) noexcept = 0;
    // The camera's frame as it is handed to the outputs. Loop.
    virtual void keep_frame(std::uint16_t camera, const FrameUse& use) noexcept = 0;
};

}  // namespace hilcam
