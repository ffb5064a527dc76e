#pragma once
// Finds the lens's blur that explains the measured MTF of an edge's pieces: a wavefront error, or a defocus
// where that explains them clearly better (strongly blurred lenses; the formula of wavefront errors holds up
// to 0.18 waves, sensor/mtf.h). Everything else of the camera's MTF (diffraction, pixel, diffusion) is that
// of the camera file. Not modelled: astigmatism; both directions of an edge are one lens.

#include <span>
#include <string>
#include <vector>

#include "emulator/clone/edge_pieces.h"
#include "sensor/camera_model.h"
#include "sensor/measure/frame_statistics.h"

namespace hilcam {

enum class BlurKind { kWavefront, kDefocus };

// The lens at one image height.
struct LensZone {
    double field_fraction = 0;                              // image height over that of the sensor's corner
    Measured blur_m;                                        // rms wavefront error or defocus, >= 0
    std::vector<double> frequency_cy_px, mtf, uncertainty;  // measured, along the edge's normal
    std::vector<double> described;                          // the clone's, at the same frequencies
    double misfit = 0;  // root mean square of the two's difference up to the Nyquist frequency
};
struct LensBlur {
    BlurKind kind = BlurKind::kWavefront;
    std::vector<LensZone> zones;  // rising field_fraction, each greater than that before
};

// A piece with its image height over that of the sensor's corner.
struct PlacedPiece {
    double field_fraction = 0;
    EdgePiece piece;
};
// camera: the clone's, without blur of the lens; lens properties that the MTF replaces do not count.
LensBlur fit_lens_blur(const CameraModel& camera, const std::vector<PlacedPiece>& pieces);

}  // namespace hilcam
