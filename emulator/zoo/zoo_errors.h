#pragma once
// Computes the errors of one frame of a zoo's view, as defined in zoo_bench.h.

#include <vector>

#include "emulator/zoo/zoo_bench.h"
#include "emulator/zoo/zoo_reference.h"

namespace hilcam {

// Errors of single pixels, to combine several pictures.
struct ZooPixels {
    // |difference| / sigma of lit pixels on objects and near them
    std::vector<double> errors, reference_errors;
};

struct ZooFrame {
    const ElectronImage& still;
    const ElectronImage& panned;
};
// Returns the figures that depend on the pictures alone: all except centroid, photometry and time. Pictures
// are cut off at saturation. pixels: receives the errors of single pixels in addition.
ZooFigures zoo_errors(const ZooFrame& frame, const ZooReference& reference, const SurfacePixels& surface,
                      const SensorNoise& noise, ZooPixels& pixels);

// Computes the errors in sensor noise from those of single pixels.
void set_errors(const ZooPixels& pixels, ZooFigures& figures);

}  // namespace hilcam
