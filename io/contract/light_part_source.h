#pragma once
// A camera's frames taken apart into the parts of their light (render/vocabulary/light_part.h), for who looks at one part while the
// camera runs: the preview's page. The loop takes a frame apart when somebody asks, and is otherwise as it is.

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "io/contract/frame_sink.h"
#include "render/vocabulary/image.h"
#include "render/vocabulary/light_part.h"

namespace hilcam {

class LightPartSource {
  public:
    struct Wish {
        LightPart part{};
        std::uint64_t after = 0;  // a frame with another id than this; 0: any
        bool with_truth = false;  // one whose truth is told, if there is room for it
    };
    // One part of a frame's light, in the numbers of the camera and as its frames lie, without noise.
    struct Picture {
        DnImage numbers;
        FrameRecord record;
    };

    virtual ~LightPartSource() = default;
    // Says in one line why frames of this camera cannot be taken apart; empty: they can. Any thread.
    virtual std::string refusal() const = 0;
    // Gives the newest picture of that part, or waits for a frame that begins from now on. Null: none came in time, or none comes any
    // more. Any thread but the loop, several at a time; what they ask is done one by one.
    virtual std::shared_ptr<const Picture> wait_for(const Wish& wish, std::chrono::nanoseconds patience) = 0;
};

}  // namespace hilcam
