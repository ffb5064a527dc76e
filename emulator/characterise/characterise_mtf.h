#pragma once
// The camera's MTF on the bench: slanted edges of contrast 4 : 1, 5 degrees from columns and rows.
//
// Every pixel is calibrated by frames of the two plates alone, (edge - dark plate) / (bright plate - dark
// plate), each carried to a scale linear in light by the measured response: that takes out offsets, gains and
// shading, and sets MTF = 1 at zero frequency to what large surfaces show. So a lens's veiling glare, which
// takes contrast from everything but large surfaces, lowers the measured curve as it lowers the configured
// one. Not resolved: what changes within 1/32 cycles/px, as a halo's curve does at its very beginning.

#include <functional>
#include <vector>

#include "emulator/characterise/characterise_setup.h"
#include "sensor/measure/emva1288.h"

namespace hilcam {

struct MtfCurve {
    double normal_rad = 0;  // direction in the image from +x towards +y; both curves are along it
    std::vector<double> frequency_cy_px, configured, measured, uncertainty;

    std::size_t nyquist() const;  // index of 0.5 cycles/px
};

// Edge near the columns (the MTF along the rows), or near the rows.
enum class EdgeDirection { kAlongRows, kAlongColumns };
// told: is given the share of the work that is done, 0 to 1, now and then.
MtfCurve measure_mtf(const LabSetup& setup, const ResponseCurve& response, EdgeDirection direction,
                     const DetectorPictures& pictures, const std::function<void(double)>& told);

}  // namespace hilcam
