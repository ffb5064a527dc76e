#pragma once
// The kernels of a scenario, with the bodies and frames in them.

#include "io/spice/kernel_bodies.h"
#include "io/spice/kernel_frames.h"
#include "io/spice/kernel_set.h"

namespace hilcam {

struct SpiceKernels {
    KernelSet set;
    KernelFrames frames;
    KernelBodies bodies;

    // tolerance_s: see KernelFrames. Throws InputError.
    explicit SpiceKernels(std::span<const std::filesystem::path> files, double tolerance_s = 0)
        : set(load_kernels(files)), frames(set, tolerance_s), bodies(set, frames) {}
    SpiceKernels(const SpiceKernels&) = delete;
    SpiceKernels& operator=(const SpiceKernels&) = delete;
};

}  // namespace hilcam
