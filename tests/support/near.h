#pragma once
// Vectors that are nearly the same.

#include <gtest/gtest.h>

#include "render/vocabulary/vec.h"

namespace hilcam {

inline void expect_near(Vec3d found, Vec3d expected, double tolerance) {
    EXPECT_NEAR(found.x, expected.x, tolerance);
    EXPECT_NEAR(found.y, expected.y, tolerance);
    EXPECT_NEAR(found.z, expected.z, tolerance);
}

}  // namespace hilcam
