#pragma once
// Rotations of the frames in a set of kernels at any time: fixed offsets, bodies, structures with attitudes,
// dynamic frames.
//
// Frames that the loop needs are named beforehand by require(), which reads what they depend on.

#include <map>
#include <memory>
#include <vector>

#include "io/spice/body_orientation.h"
#include "io/spice/ck_segment.h"
#include "io/spice/dynamic_frame.h"
#include "io/spice/frame_definition.h"
#include "io/spice/kernel_set.h"
#include "io/spice/spacecraft_clock.h"
#include "render/sky/bodies.h"

namespace hilcam {

// A span of SPICE's time; both ends belong to it.
struct EtSpan {
    double start_s = 0, stop_s = 0;
};

// The states of bodies, on which axes from two vectors depend.
class FrameBodies {
  public:
    virtual ~FrameBodies() = default;
    // See KernelBodies.
    virtual bool has(int body) const = 0;
    virtual void require(int body, const std::string& key) = 0;
    virtual bool state(int body, int center, double et_s, StateVector& out) const = 0;
    virtual void add_boundaries(int body, std::vector<double>& et_s) const = 0;
};

class KernelFrames {
  public:
    // kernels: must outlive this. tolerance_s: time beyond an attitude's instant or span for which the
    // attitude is still used.
    explicit KernelFrames(const KernelSet& kernels, double tolerance_s = 0)
        : kernels_(&kernels), tolerance_s_(tolerance_s) {}

    // Sets where axes from vectors between bodies get states; null: there are none. The bodies must outlive
    // this.
    void set_bodies(FrameBodies* bodies) { places_ = bodies; }

    // Reads what a frame needs, back to J2000, and returns its code. Throws InputError; key: what asks, for
    // messages.
    int require(std::string_view name, const std::string& key);
    void require(int code, const std::string& key);

    // Gets the rotation of the frame's axes into J2000's; false when the kernels do not have it at that time,
    // or require() was not called. Loop.
    bool turn(int code, double et_s, FrameTurn& j2000_from_frame) const;
    // Returns which attitudes cannot be used and why, a line each; their times are not known.
    const std::vector<std::string>& left_out() const { return left_out_; }
    // Appends the times at which a frame's rotation may become known or unknown.
    void add_boundaries(int code, std::vector<double>& et_s) const;

  private:
    struct Structure {
        std::vector<std::unique_ptr<CkSegment>> segments;  // the first that knows a time is used
        std::unique_ptr<SpacecraftClock> clock;
        struct Span {
            TickSpan ticks;
            const CkSegment* segment;
        };
        std::vector<Span> spans;  // by their start, to find the nearest within the tolerance
    };
    const KernelSet* kernels_;
    double tolerance_s_;
    std::map<int, FrameDefinition> frames_;
    // Orientations by class code; the first that covers a time is used.
    std::map<int, std::vector<std::unique_ptr<BodyOrientation>>> bodies_;
    std::map<int, Structure> structures_;
    std::vector<std::string> left_out_;
    FrameBodies* places_ = nullptr;

    void require(const FrameDefinition& frame, const std::string& key);
    void require_body(const FrameDefinition& frame, const std::string& key);
    void require_dynamic(const FrameDefinition& frame);
    void require_structure(const FrameDefinition& frame, const std::string& key);
    bool turn(int code, double et_s, FrameTurn& out, int depth) const;
    bool turn_in(int reference, double et_s, const FrameTurn& inner, FrameTurn& out, int depth) const;
    // Both get a dynamic frame's rotation relative to J2000. moving_turn() computes it with its rate;
    // dynamic_turn() then freezes it, or ignores the rate, as the frame's definition says.
    bool dynamic_turn(const FrameDefinition& frame, double et_s, FrameTurn& out, int depth) const;
    bool moving_turn(const FrameDefinition& frame, double et_s, FrameTurn& out, int depth) const;
    bool vector_axes(const DynamicFrame& frame, double et_s, Mat3d& out, int depth) const;
    bool vector_of(const FrameVector& vector, double et_s, Vec3d& out, int depth) const;
    bool structure_turn(const Structure& structure, double et_s, FrameTurn& out, int depth) const;
};

}  // namespace hilcam
