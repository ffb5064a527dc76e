#pragma once
// Measures how much more a picture changes than the truth when the scene moves by a fraction of a pixel. This
// finds crawling, dashing and flicker, which show in a video but in no single frame.

#include <cstddef>

#include "emulator/zoo/surface_blocks.h"

namespace hilcam {

// The change of the reference, and an estimate of the error of that change for each pixel.
struct KnownChange {
    const ElectronImage& change;
    const ElectronImage& error;
};

// Sums over the lit pixels on objects and near them, in units of the reference's sensor noise. They add up
// over pictures.
struct PanChange {
    std::size_t lit_px = 0;
    double squares = 0;        // squares of the change minus the reference's
    double own_squares = 0;    // squares of the error of the reference's change
    double moved_squares = 0;  // squares of the reference's change

    PanChange& operator+=(const PanChange& other);
    // Returns the rms of the difference beyond the reference's own error [sensor noise].
    double excess_rms() const;
    // Returns the rms of the reference's change, without its error.
    double reference_rms() const;
};
// Pictures before (still) and after the move [e-]. A pixel is lit if it is so by the rule of image_error.h in
// one of them or in the reference.
struct PannedPictures {
    const ElectronImage& still;
    const ElectronImage& moved;
};
PanChange pan_change(const PannedPictures& pictures, const KnownPicture& reference, const KnownChange& known,
                     const SurfacePixels& surface, const SensorNoise& noise);

}  // namespace hilcam
