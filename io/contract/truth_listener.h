#pragma once
// A listener that wants the truth of some frames only, such as the preview's page while it draws truth over
// the picture. Truth of the other frames is not computed for it.

#include <cstdint>
#include <string>

namespace hilcam {

class TruthListener {
  public:
    virtual ~TruthListener() = default;
    // True when the truth of the frame that begins is wanted. Loop.
    virtual bool wants_truth() const noexcept = 0;
    // Takes the frame's line of JSON (docs/truth.md). Truth's thread.
    virtual void take_truth(std::uint64_t frame, std::string line) = 0;
};

}  // namespace hilcam
