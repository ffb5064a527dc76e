#pragma once
// Positions and velocities of the bodies and spacecraft in a set of kernels at any time.
//
// A body's segments give its state relative to a centre, which has segments of its own; two bodies are
// related through the first centre that they share. Bodies that the loop needs are named beforehand by
// require(), which reads their segments.

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "io/spice/kernel_frames.h"
#include "io/spice/spk_segment.h"

namespace hilcam {

class KernelBodies final : public FrameBodies {
  public:
    // Both must outlive this.
    KernelBodies(const KernelSet& kernels, KernelFrames& frames) : kernels_(&kernels), frames_(&frames) {
        frames.set_bodies(this);
    }
    ~KernelBodies() override { frames_->set_bodies(nullptr); }
    KernelBodies(const KernelBodies&) = delete;
    KernelBodies& operator=(const KernelBodies&) = delete;

    // Reads the segments of a body and of its centres. Throws InputError for a body that no SPK has; key:
    // what asks for it.
    void require(int body, const std::string& key) override;
    // True when some SPK has it.
    bool has(int body) const override;

    // Gets the geometric state of a body relative to another, axes of J2000 [m, m/s]; false when the kernels
    // do not have it at that time. Loop.
    bool state(int body, int center, double et_s, StateVector& out) const override;
    // Returns the spans with a known state, in order. Owner thread.
    std::vector<EtSpan> coverage(int body, int center) const;
    // Appends the times at which the body's state may become known or unknown.
    void add_boundaries(int body, std::vector<double>& et_s) const override;

  private:
    const KernelSet* kernels_;
    KernelFrames* frames_;
    // The first that covers a time is used.
    std::map<int, std::vector<std::unique_ptr<SpkSegment>>> segments_;

    // Goes one step, from a body to its centre, and adds the state to `out`.
    bool step(int& body, double et_s, StateVector& out) const;
    void add_boundaries(int body, std::vector<double>& et_s, std::vector<int>& seen) const;
};

// Returns the spans between boundaries at whose midpoint `known` holds; adjacent spans are joined.
std::vector<EtSpan> known_spans(std::vector<double> boundaries_et_s,
                                const std::function<bool(double)>& known);

}  // namespace hilcam
