#pragma once
// A stage by the visibility buffer beside the same by rays through the same places of each pixel.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "tests/support/stage.h"

namespace hilcam {

// How a picture out of the visibility buffer differs from one out of rays.
struct Difference {
    double mean = 0;      // of the pictures' means, as a fraction
    double greatest = 0;  // of a pixel, against the brightest
    double covered = 0;   // of the shares that objects cover
};

// Renders the stage by rays through across x across places of each pixel and then by a buffer of as many samples, whose picture it
// keeps.
inline Difference difference_from_rays(Stage& s, int across = 4) {
    s.quality.rays_across = 0;  // small objects would ask for more
    s.quality.samples_per_axis = across;
    s.quality.buffer_samples = across * across;
    s.quality.visibility = "rays";
    s.render();
    const RadianceImage rays = std::move(s.radiance);
    const RenderStats by_rays = s.stats;
    s.radiance = RadianceImage(rays.width(), rays.height(), rays.planes());
    s.quality.samples_per_axis = 1;
    s.quality.visibility = "buffer";
    s.render();
    EXPECT_EQ(s.stats.primary_rays, 0u);
    Difference out;
    double sum_rays = 0, sum_buffer = 0, brightest = 0;
    for (int y = 0; y < rays.height(); ++y)
        for (int x = 0; x < rays.width(); ++x) {
            const double a = rays.row(y, 0)[static_cast<std::size_t>(x)];
            const double b = s.radiance.row(y, 0)[static_cast<std::size_t>(x)];
            sum_rays += a, sum_buffer += b, brightest = std::max(brightest, a);
            out.greatest = std::max(out.greatest, std::abs(a - b));
        }
    EXPECT_GT(brightest, 0);
    out.mean = sum_buffer / sum_rays - 1;
    out.greatest /= brightest;
    out.covered = s.stats.coverage - by_rays.coverage;
    return out;
}

}  // namespace hilcam
