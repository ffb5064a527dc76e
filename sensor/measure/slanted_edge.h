#pragma once
// The modulation transfer function from a picture of a slanted edge: e-SFR of ISO 12233:2017 and 2023,
// annexes C and D.
//
// In each row the edge is where the derivative has its centroid; a line goes through the rows' edges; every
// pixel's distance from that line gives an edge spread function sampled much finer than the pixels, whose
// derivative's Fourier transform is the MTF along the edge's normal. Rows are cut to whole cycles of the
// edge's position on the pixel grid, so that all of them weigh alike.
//
// Differs from the standard, each because it measures a bare pixel's MTF wrong by more than 0.003: eight
// bins to a pixel where the standard has four (through four, a box pixel's side lobe at 3.5 cycles/px comes
// back at 0.5 with one percent); the mean over a bin is corrected as well as the finite difference, together
// sinc^2(f/8); each bin is moved from the mean place of its pixels to its middle; the window is Tukey's, flat
// over its middle half, where Hamming's widens the transform. Distances are across the edge, so that
// frequencies are those of its normal, too.

#include <cstdint>
#include <span>
#include <vector>

namespace hilcam {

// Linear in light: the response curve is undone before.
struct EdgePicture {
    int width = 0, height = 0;
    std::span<const double> value;      // row by row
    std::span<const std::uint8_t> use;  // 1: counts
    double noise = 0;                   // standard deviation of a value
};

struct SlantedEdgeOptions {
    // The step between the two sides far from the edge: MTF = 1 at zero frequency is then that of large
    // surfaces, and light that a lens spreads wide is missing above. 0: the step that is seen within
    // half_width_px.
    double step = 0;
    double half_width_px = 32;  // used on either side of the edge
};

struct EdgeMtf {
    std::vector<double> frequency_cy_px;  // along the edge's normal, 0 to 1 by 1/64
    std::vector<double> mtf;
    std::vector<double> uncertainty;  // one standard deviation, of the pixels' noise
    double normal_rad = 0;            // direction of the edge's normal, from +x towards +y
};

// Returns the MTF of an edge within 45 degrees of the columns or of the rows, not within 1 degree of either.
// InputError when the picture is too small for it or shows none. Owner thread.
EdgeMtf slanted_edge_mtf(const EdgePicture& picture, const SlantedEdgeOptions& options);

}  // namespace hilcam
