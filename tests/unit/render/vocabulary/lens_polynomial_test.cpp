#include "render/vocabulary/lens_polynomial.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/vocabulary/image_geometry.h"

namespace hilcam {
namespace {

constexpr double kFocal_mm = 50;

// 0.5 + 0.25 x - y + 0.1 x^2 + 0.2 x y - 0.3 y^2 + 0.04 y^3 at (2, 3) mm, by hand.
TEST(LensPolynomial, HasItsTermsByOrder) {
    const std::vector<double> x_mm{0.5, 0.25, -1, 0.1, 0.2, -0.3, 0, 0, 0, 0.04};
    const LensPolynomial lens = lens_polynomial(x_mm, {}, kFocal_mm);
    EXPECT_EQ(lens.order, 3);
    EXPECT_EQ(lens.terms_x().size(), 10u);
    const LensPolynomial::Shift at = lens.shift({2 / kFocal_mm, 3 / kFocal_mm});
    EXPECT_NEAR(kFocal_mm * at.by.x, 0.5 + 0.5 - 3 + 0.4 + 1.2 - 2.7 + 1.08, 1e-12);
    EXPECT_EQ(at.by.y, 0);
    EXPECT_NEAR(at.along_x.x, 0.25 + 0.2 * 2 + 0.2 * 3, 1e-12);
    EXPECT_NEAR(at.along_y.x, -1 + 0.2 * 2 - 0.6 * 3 + 0.12 * 9, 1e-12);
}

TEST(LensPolynomial, WithoutTermsMovesNothing) {
    const LensPolynomial lens = lens_polynomial({}, {}, kFocal_mm);
    EXPECT_TRUE(lens.none());
    EXPECT_TRUE(LensDistortion{}.none());
    EXPECT_TRUE(lens.terms_x().empty());
}

// Brown's radial and tangential terms are cubic and quadratic forms.
TEST(LensPolynomial, MovesAsBrownsTermsWhereThoseAreIts) {
    LensDistortion brown;
    brown.k1 = -0.2, brown.p1 = 0.01, brown.p2 = -0.03;
    const std::vector<double> x{0, 0, 0, 3 * brown.p2, 2 * brown.p1, brown.p2, brown.k1, 0, brown.k1, 0};
    const std::vector<double> y{0, 0, 0, brown.p1, 2 * brown.p2, 3 * brown.p1, 0, brown.k1, 0, brown.k1};
    LensDistortion own;
    own.polynomial = lens_polynomial(x, y, 1);
    for (const Vec2d p : {Vec2d{0.1, 0.2}, {-0.3, 0.25}, {0.4, -0.3}, {0, 0}}) {
        const Vec2d there = own.distorted(p), expected = brown.distorted(p), back = own.undistorted(there);
        EXPECT_NEAR(there.x, expected.x, 1e-15);
        EXPECT_NEAR(there.y, expected.y, 1e-15);
        EXPECT_NEAR(back.x, p.x, 1e-12);
        EXPECT_NEAR(back.y, p.y, 1e-12);
    }
}

TEST(LensPolynomial, IsAddedToBrownsTermsAndComesBackFromBoth) {
    LensDistortion both;
    both.k1 = -0.1, both.p2 = 0.004;
    const std::vector<double> x{0.02, 0.01, -0.005, 0.03, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.1};
    const std::vector<double> y{-0.01, 0.004, 0.002, 0, 0.05, -0.02};
    both.polynomial = lens_polynomial(x, y, 1);
    EXPECT_EQ(both.polynomial.order, 5);
    LensDistortion brown = both;
    brown.polynomial = {};
    const Vec2d p{0.2, -0.35}, there = both.distorted(p), without = brown.distorted(p);
    EXPECT_NEAR(there.x - without.x, 0.02 + 0.002 + 0.00175 + 0.0012 + 0.1 * std::pow(0.2, 5), 1e-15);
    EXPECT_NEAR(there.y - without.y, -0.01 + 0.0008 - 0.0007 - 0.0035 - 0.02 * 0.1225, 1e-15);
    const Vec2d back = both.undistorted(there);
    EXPECT_NEAR(back.x, p.x, 1e-12);
    EXPECT_NEAR(back.y, p.y, 1e-12);
}

}  // namespace
}  // namespace hilcam
