#pragma once
// Somebody who wants the truth of some frames only, now and then: the preview's page while it draws over the
// picture. Truth of other frames is not worked out for it.

#include <cstdint>
#include <string>

namespace hilcam {

class TruthListener {
  public:
    virtual ~TruthListener() = default;
    // True while the truth of the frame that begins now is wanted. Loop.
    virtual bool wants_truth() const noexcept = 0;
    // Takes a frame's line of JSON, as docs/truth.md has it. Truth's thread.
    virtual void take_truth(std::uint64_t frame, std::string line) = 0;
};

}  // namespace hilcam
