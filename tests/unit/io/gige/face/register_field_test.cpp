// Numbers in bits of registers, and what they mean.

#include "io/gige/face/register_field.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "io/gige/face/register_formula.h"

namespace hilcam {
namespace {

TEST(RegisterField, BitsAreCountedFromTheLeastSignificantInBothOrders) {
    const std::array<std::uint8_t, 4> bytes = {0x12, 0x34, 0x56, 0x78};
    EXPECT_EQ(bits_in({.bytes = 4, .low = 0, .high = 31}, bytes), 0x12345678u);
    EXPECT_EQ(bits_in({.bytes = 4, .little_endian = true, .low = 0, .high = 31}, bytes), 0x78563412u);
    EXPECT_EQ(bits_in({.bytes = 4, .low = 4, .high = 11}, bytes), 0x67u);
    EXPECT_EQ(bits_in({.bytes = 4, .little_endian = true, .low = 4, .high = 11}, bytes), 0x41u);
    EXPECT_EQ(bits_in({.bytes = 2, .low = 15, .high = 15}, bytes), 0u);
}

TEST(RegisterField, PuttingBitsLeavesTheOthers) {
    std::array<std::uint8_t, 4> bytes = {0xFF, 0xFF, 0xFF, 0xFF};
    const RegisterField f{.bytes = 4, .low = 4, .high = 11};
    put_bits(f, 0x1AB, bytes);  // wider than the field
    EXPECT_EQ(bytes, (std::array<std::uint8_t, 4>{0xFF, 0xFF, 0xFA, 0xBF}));
    EXPECT_EQ(bits_in(f, bytes), 0xABu);
    std::array<std::uint8_t, 8> all{};
    put_bits({.bytes = 8, .low = 0, .high = 63}, ~0ull, all);
    EXPECT_EQ(all[0] & all[7], 0xFF);
}

TEST(RegisterField, ItsBytesAreThoseOfItsBits) {
    const RegisterField big{.bytes = 4, .low = 4, .high = 11},
        little{.bytes = 4, .little_endian = true, .low = 4, .high = 11};
    EXPECT_EQ(big.first_byte(), 2u);
    EXPECT_EQ(big.end_byte(), 4u);
    EXPECT_EQ(little.first_byte(), 0u);
    EXPECT_EQ(little.end_byte(), 2u);
}

TEST(RegisterField, NumbersAreHeldAtTheEndsOfTheField) {
    const RegisterField s{.low = 0, .high = 7, .kind = RegisterField::Kind::kSigned}, u{.low = 8, .high = 15};
    EXPECT_EQ(bits_of(s, -3), 0xFDu);
    EXPECT_EQ(number_of(s, 0xFD), -3);
    EXPECT_EQ(number_of(s, bits_of(s, 1e9)), 127);
    EXPECT_EQ(number_of(s, bits_of(s, -1e9)), -128);
    EXPECT_EQ(bits_of(u, 1e9), 0xFFu);
    EXPECT_EQ(bits_of(u, -1), 0u);
    EXPECT_EQ(bits_of(u, 2.6), 3u);
    EXPECT_EQ(bits_of(u, std::nan("")), 0u);
    const RegisterField f{.bytes = 4, .kind = RegisterField::Kind::kFloat};
    EXPECT_EQ(number_of(f, bits_of(f, 0.25)), 0.25);
    EXPECT_TRUE(std::isfinite(number_of(f, bits_of(f, 1e300))));
}

// --- formulas

TEST(RegisterFormula, EachKindInverts) {
    using Formula = RegisterFormula;
    const Formula linear{Formula::Kind::kLinear, 0.5, 3, {}},
        reciprocal{Formula::Kind::kReciprocal, 1e6, 0, {}},
        logarithm{Formula::Kind::kLogarithm, 20 / std::log(10), -96.3, {}},
        falling{Formula::Kind::kPoints, 1, 0, {{0, 10}, {4, 2}, {5, 0}}};
    EXPECT_EQ(linear.value(4), 5);
    EXPECT_EQ(reciprocal.value(50000), 20);
    EXPECT_NEAR(logarithm.value(65536), 96.3296 - 96.3, 1e-4);  // 20 lg 65536
    EXPECT_EQ(falling.value(2), 6);
    EXPECT_EQ(falling.value(-1), 10);
    EXPECT_EQ(falling.value(9), 0);
    for (const Formula* f : {&linear, &reciprocal, &logarithm, &falling})
        for (const double raw : {1.0, 2.0, 4.5}) EXPECT_NEAR(f->raw(f->value(raw)), raw, 1e-9);
    EXPECT_EQ(falling.raw(99), 0);
    EXPECT_EQ(falling.raw(-99), 5);
}

TEST(RegisterFormula, NothingIsInfinite) {
    const RegisterFormula reciprocal{RegisterFormula::Kind::kReciprocal, 1e6, 0, {}},
        logarithm{RegisterFormula::Kind::kLogarithm, 8.7, 0, {}};
    for (const double x : {0.0, -1.0, 1e308, -1e308})
        for (const RegisterFormula* f : {&reciprocal, &logarithm}) {
            EXPECT_TRUE(std::isfinite(f->value(x)));
            EXPECT_TRUE(std::isfinite(f->raw(x)));
        }
}

}  // namespace
}  // namespace hilcam
