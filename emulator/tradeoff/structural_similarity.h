#pragma once
// Structural similarity of two pictures: Wang, Bovik, Sheikh, Simoncelli, "Image quality assessment: from
// error visibility to structural similarity", IEEE Trans. Image Processing 13(4), 2004, eq. (13) to (17):
//     SSIM = (2 m_a m_b + C1)(2 s_ab + C2) / ((m_a^2 + m_b^2 + C1)(s_a^2 + s_b^2 + C2))
// with means m, variances s^2 and covariance s_ab under a Gaussian window of 11 x 11 pixels with a standard
// deviation of 1.5, C1 = (0.01 L)^2 and C2 = (0.03 L)^2, where L is the range of pixel values. The result is
// the mean over all positions of the window within the picture. 1: equal.

#include <optional>

#include "render/vocabulary/image.h"

namespace hilcam {

// Returns nothing for pictures smaller than the window. Owner thread.
std::optional<double> structural_similarity(const ElectronImage& a, const ElectronImage& b, double range_e);

}  // namespace hilcam
