#pragma once
// The places of the bodies and spacecraft of a set of kernels at any time.
//
// A body's segments say where it is about a centre, which has segments of its own; two bodies are compared at the first
// centre that they share. What is asked for in the loop is named beforehand by require(), which reads its kernels.

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
    // Both outlive it.
    KernelBodies(const KernelSet& kernels, KernelFrames& frames) : kernels_(&kernels), frames_(&frames) {
        frames.set_bodies(this);
    }
    ~KernelBodies() override { frames_->set_bodies(nullptr); }
    KernelBodies(const KernelBodies&) = delete;
    KernelBodies& operator=(const KernelBodies&) = delete;

    // Reads the segments of a body and of its centres. Throws InputError for a body that no SPK has; key: what asks.
    void require(int body, const std::string& key) override;
    // True when some SPK has it.
    bool has(int body) const override;

    // The geometric state of a body about another, axes of J2000 [m, m/s]; false: the kernels do not know it then. Loop.
    bool state(int body, int center, double et_s, StateVector& out) const override;
    // Returns the spans over which that is known, in order. Owner thread.
    std::vector<EtSpan> coverage(int body, int center) const;
    // Adds to a list the times at which the body may begin or cease to be known.
    void add_boundaries(int body, std::vector<double>& et_s) const override;

  private:
    const KernelSet* kernels_;
    KernelFrames* frames_;
    std::map<int, std::vector<std::unique_ptr<SpkSegment>>> segments_;  // the first that covers a time counts

    // Goes one step to the centre of a body, adding the way to `out`.
    bool step(int& body, double et_s, StateVector& out) const;
    void add_boundaries(int body, std::vector<double>& et_s, std::vector<int>& seen) const;
};

// Returns the spans between boundaries in whose middle `known` holds, joined where they meet.
std::vector<EtSpan> known_spans(std::vector<double> boundaries_et_s,
                                const std::function<bool(double)>& known);

}  // namespace hilcam
