#pragma once
// The turns of the frames of a set of kernels at any time: fixed offsets, bodies, structures with attitudes, dynamic frames.
//
// What is asked for in the loop is named beforehand by require(), which reads its kernels.

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

// A span of SPICE's time; both ends count.
struct EtSpan {
    double start_s = 0, stop_s = 0;
};

// The places of bodies, which axes by two vectors follow.
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
    // The set outlives it. tolerance_s: how far from an attitude's instant or span it still stands for the time.
    explicit KernelFrames(const KernelSet& kernels, double tolerance_s = 0)
        : kernels_(&kernels), tolerance_s_(tolerance_s) {}

    // Axes by vectors between bodies ask here; null: there are none. The bodies outlive it.
    void set_bodies(FrameBodies* bodies) { places_ = bodies; }

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
    FrameBodies* places_ = nullptr;

    void require(const FrameDefinition& frame, const std::string& key);
    void require_body(const FrameDefinition& frame, const std::string& key);
    void require_dynamic(const FrameDefinition& frame);
    void require_structure(const FrameDefinition& frame, const std::string& key);
    bool turn(int code, double et_s, FrameTurn& out, int depth) const;
    bool turn_in(int reference, double et_s, const FrameTurn& inner, FrameTurn& out, int depth) const;
    // The turn of a dynamic frame: against J2000, without what is frozen or left out of it.
    bool dynamic_turn(const FrameDefinition& frame, double et_s, FrameTurn& out, int depth) const;
    bool moving_turn(const FrameDefinition& frame, double et_s, FrameTurn& out, int depth) const;
    bool vector_axes(const DynamicFrame& frame, double et_s, Mat3d& out, int depth) const;
    bool vector_of(const FrameVector& vector, double et_s, Vec3d& out, int depth) const;
    bool structure_turn(const Structure& structure, double et_s, FrameTurn& out, int depth) const;
};

}  // namespace hilcam
