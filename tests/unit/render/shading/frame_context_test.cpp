#include "render/shading/frame_context.h"

#include <gtest/gtest.h>

namespace hilcam {
namespace {

// Footprints are as wide as the whole way says, from the camera to where a ray begins and on from there.
TEST(FrameContext, RaysHaveComeFromTheCameraToWhereTheyBegin) {
    FrameContext frame;
    frame.camera_m = {3, 0, -1000};
    frame.start_at_m = {3, 0, 200};
    EXPECT_EQ(frame.way_to_start_m(), 0);
    frame.start_before_m = 20;
    EXPECT_DOUBLE_EQ(frame.way_to_start_m(), 1180);
    const Vec3f start_m = frame.start_of({0, 0, 1});
    EXPECT_FLOAT_EQ(static_cast<float>(length(to_double(start_m) - frame.camera_m)), 1180);
    // The camera is as near as rays would begin.
    frame.start_before_m = 2000;
    EXPECT_EQ(frame.way_to_start_m(), 0);
}

}  // namespace
}  // namespace hilcam
