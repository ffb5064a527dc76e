#pragma once
// Measures how much more a picture changes than the truth does when the scene moves by a fraction of a pixel: what crawls,
// dashes and flickers in a video and is seen in no single frame.

#include <cstddef>

#include "emulator/zoo/surface_blocks.h"

namespace hilcam {

// The same of the reference: its change, and an estimate of the change's own error by pixel.
struct KnownChange {
    const ElectronImage& change;
    const ElectronImage& error;
};

// Sums over the lit pixels on objects and near them, in the reference's noise. They add up over pictures.
struct PanChange {
    std::size_t lit_px = 0;
    double squares = 0;        // squares of the change less the reference's
    double own_squares = 0;    // squares of the reference's own error in that
    double moved_squares = 0;  // squares of the reference's change

    PanChange& operator+=(const PanChange& other);
    // Returns the root of the mean square beyond what the reference's own error makes [sensor noise].
    double excess_rms() const;
    // The reference's own change, its error apart.
    double reference_rms() const;
};
// still, moved: pictures before and after [e-]. A pixel is lit by image_error.h's rule in one of them or the reference.
struct PannedPictures {
    const ElectronImage& still;
    const ElectronImage& moved;
};
PanChange pan_change(const PannedPictures& pictures, const KnownPicture& reference, const KnownChange& known,
                     const SurfacePixels& surface, const SensorNoise& noise);

}  // namespace hilcam
