#pragma once
// The turns of the frames of a set of kernels at any time: fixed offsets, bodies, structures with attitudes.
//
// What is asked for in the loop is named beforehand by require(), which reads its kernels. Dynamic frames are not built.

#include <map>
#include <memory>
#include <vector>

#include "io/spice/body_orientation.h"
#include "io/spice/ck_segment.h"
#include "io/spice/frame_definition.h"
#include "io/spice/kernel_set.h"
#include "io/spice/spacecraft_clock.h"

namespace hilcam {

// A span of SPICE's time; both ends count.
struct EtSpan {
    double start_s = 0, stop_s = 0;
};

class KernelFrames {
  public:
    // The set outlives it. tolerance_s: how far from an attitude's instant or span it still stands for the time.
    explicit KernelFrames(const KernelSet& kernels, double tolerance_s = 0)
        : kernels_(&kernels), tolerance_s_(tolerance_s) {}

    // Reads what a frame needs, back to J2000, and returns its code. Throws InputError; key: what asks, for messages.
    int require(std::string_view name, const std::string& key);
    void require(int code, const std::string& key);

    // Puts the frame's axes in J2000's; false: the kernels do not know it then, or require() was not called. Loop.
    bool turn(int code, double et_s, FrameTurn& j2000_from_frame) const;
    // Returns what of attitudes cannot be used and why, a line each; what that covers is not known.
    const std::vector<std::string>& left_out() const { return left_out_; }
    // Adds to a list the times at which a frame may begin or cease to be known.
    void add_boundaries(int code, std::vector<double>& et_s) const;

  private:
    struct Structure {
        std::vector<std::unique_ptr<CkSegment>> segments;  // the first that knows a time counts
        std::unique_ptr<SpacecraftClock> clock;
        struct Span {
            TickSpan ticks;
            const CkSegment* segment;
        };
        std::vector<Span> spans;  // by their start; for the nearest within the tolerance
    };
    const KernelSet* kernels_;
    double tolerance_s_;
    std::map<int, FrameDefinition> frames_;
    std::map<int, std::vector<std::unique_ptr<BodyOrientation>>>
        bodies_;  // by class code; the first that covers counts
    std::map<int, Structure> structures_;
    std::vector<std::string> left_out_;

    void require(const FrameDefinition& frame, const std::string& key);
    void require_body(const FrameDefinition& frame, const std::string& key);
    void require_structure(const FrameDefinition& frame, const std::string& key);
    bool turn(int code, double et_s, FrameTurn& out, int depth) const;
    bool turn_in(int reference, double et_s, const FrameTurn& inner, FrameTurn& out, int depth) const;
    bool structure_turn(const Structure& structure, double et_s, FrameTurn& out, int depth) const;
};

}  // namespace hilcam
