#pragma once
// The errors of one frame of a zoo's view, in the terms of zoo_bench.h.

#include <vector>

#include "emulator/zoo/zoo_bench.h"
#include "emulator/zoo/zoo_reference.h"

namespace hilcam {

// Errors of single pixels, to put several pictures together.
struct ZooPixels {
    std::vector<double> errors, reference_errors;  // |off| / sigma of lit pixels on objects and near them
};

struct ZooFrame {
    const ElectronImage& still;
    const ElectronImage& panned;
};
// Returns the figures that follow from the pictures alone: all but the centre of light, the light and the time. Pictures are cut off at
// saturation. pixels: the single pixels' errors are added to it.
ZooFigures zoo_errors(const ZooFrame& frame, const ZooReference& reference, const SurfacePixels& surface,
                      const SensorNoise& noise, ZooPixels& pixels);

// Sets the errors in sensor noise from single pixels' errors.
void set_errors(const ZooPixels& pixels, ZooFigures& figures);

}  // namespace hilcam
