#pragma once
// Gives the parts of a frame's light (render/vocabulary/light_part.h) while the camera runs, for the
// preview's page. The loop separates a frame's light only when a page asks for a part.

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
        std::uint64_t after = 0;  // the frame has another id than this; 0: any frame
        bool with_truth = false;  // prefer a frame with truth, if there is room for it
    };
    // One part of a frame's light in DN, oriented as the camera's frames, without noise.
    struct Picture {
        DnImage numbers;
        FrameRecord record;
    };

    virtual ~LightPartSource() = default;
    // Returns one line that says why this camera's frames cannot be separated; empty: they can. Any thread.
    virtual std::string refusal() const = 0;
    // Returns the newest picture of that part, or waits for a frame that begins after the call. Null when
    // none came in time, or when no more will come. Any thread but the loop; concurrent requests are served
    // one after the other.
    virtual std::shared_ptr<const Picture> wait_for(const Wish& wish, std::chrono::nanoseconds patience) = 0;
};

}  // namespace hilcam
