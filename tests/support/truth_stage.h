#pragma once
// A stage whose frame is told, and comparisons of what is.

#include <gtest/gtest.h>

#include "tests/support/near.h"
#include "tests/support/stage.h"

namespace hilcam {

inline TruthRequest everything() {
    TruthRequest request;
    request.object = request.range = request.depth = request.normal = request.position = true;
    return request;
}

// 128 x 128 px, 128 px of focal length: a tangent of a half to each side. No guard band.
class TruthStage : public Stage {
  public:
    FrameRaster raster{128, 128, {}, {}};
    TruthRequest request = everything();

    TruthStage() { camera(128, 0.5); }
    FrameTruth tell() {
        render();
        FrameTruth truth = renderer->make_truth(request, 128, 128);
        truth.raster = raster;
        renderer->report_truth(truth);
        return truth;
    }
};

inline void expect_box(const PixelBox& seen, const PixelBox& expected) {
    EXPECT_EQ(seen.x0, expected.x0);
    EXPECT_EQ(seen.y0, expected.y0);
    EXPECT_EQ(seen.x1, expected.x1);
    EXPECT_EQ(seen.y1, expected.y1);
}
template <class Layer>
Vec3d vector_at(const Layer& layer, int x, int y) {
    const auto at = static_cast<std::size_t>(x);
    return {layer.row(y, 0)[at], layer.row(y, 1)[at], layer.row(y, 2)[at]};
}
template <class Layer>
auto value_at(const Layer& layer, int x, int y) {
    return layer.row(y)[static_cast<std::size_t>(x)];
}

}  // namespace hilcam
