#pragma once
// Measures the modulation transfer function from a picture of a slanted edge: e-SFR of ISO 12233:2017 and
// 2023, annexes C and D.
//
// In each row the edge is at the centroid of the derivative. A line is fitted through the rows' edges. The
// distances of all pixels from that line give an edge spread function that is sampled much more finely than
// the pixels; the Fourier transform of its derivative is the MTF along the edge's normal. Rows are cut to
// whole cycles of the edge's position on the pixel grid, so that all positions have the same weight.
//
// Four points differ from the standard, because each of its choices makes a bare pixel's MTF wrong by more
// than 0.003. There are eight bins to a pixel, where the standard has four (with four, a box pixel's side
// lobe at 3.5 cycles/px is aliased to 0.5 with one percent). The mean over a bin is corrected as well as the
// finite difference, together sinc^2(f/8). Each bin is moved from the mean position of its pixels to its
// centre. The window is Tukey's, flat over its middle half; Hamming's would widen the transform. Distances
// are measured across the edge, so frequencies are along its normal, too.

#include <cstdint>
#include <span>
#include <vector>

namespace hilcam {

// Values linear in light: the response curve has been undone.
struct EdgePicture {
    int width = 0, height = 0;
    std::span<const double> value;      // row by row
    std::span<const std::uint8_t> use;  // 1: counts
    double noise = 0;                   // standard deviation of a value
};

struct SlantedEdgeOptions {
    // The step between the two sides far from the edge. MTF = 1 at zero frequency then refers to large
    // surfaces, and light that a lens spreads widely lowers the curve above it. 0: the step within
    // half_width_px.
    double step = 0;
    double half_width_px = 32;  // used on either side of the edge
};

struct EdgeMtf {
    std::vector<double> frequency_cy_px;  // along the edge's normal, 0 to 1 in steps of 1/64
    std::vector<double> mtf;
    std::vector<double> uncertainty;  // one standard deviation, from the noise of the pixels
    double normal_rad = 0;            // direction of the edge's normal, from +x towards +y
};

// Returns the MTF of an edge within 45 degrees of the columns or the rows, but not within 1 degree of either.
// Throws InputError when the picture is too small or shows no edge. Owner thread.
EdgeMtf slanted_edge_mtf(const EdgePicture& picture, const SlantedEdgeOptions& options);

}  // namespace hilcam
