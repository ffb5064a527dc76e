#pragma once
// Measures the camera's MTF on the bench, with slanted edges of contrast 4 : 1 at 5 degrees from columns and
// rows.
//
// Frames of the two plates alone calibrate every pixel: (edge - dark plate) / (bright plate - dark plate),
// each first made linear in light with the measured response. This removes offsets, gains and shading, and
// normalises the MTF to 1 at zero frequency for large surfaces. A lens's veiling glare reduces the contrast
// of everything but large surfaces, so it lowers the measured curve as it lowers the configured one. Changes
// within 1/32 cycles/px are not resolved, such as the steep beginning of a halo's curve.

#include <functional>
#include <vector>

#include "emulator/characterise/characterise_setup.h"
#include "sensor/measure/emva1288.h"

namespace hilcam {

struct MtfCurve {
    double normal_rad = 0;  // direction of both curves in the image, from +x towards +y
    std::vector<double> frequency_cy_px, configured, measured, uncertainty;

    std::size_t nyquist() const;  // index of 0.5 cycles/px
};

// kAlongRows: an edge near the columns, which gives the MTF along the rows. kAlongColumns: an edge near the
// rows.
enum class EdgeDirection { kAlongRows, kAlongColumns };
// told: called now and then with the share of the work that is done, 0 to 1.
MtfCurve measure_mtf(const LabSetup& setup, const ResponseCurve& response, EdgeDirection direction,
                     const DetectorPictures& pictures, const std::function<void(double)>& told);

}  // namespace hilcam
