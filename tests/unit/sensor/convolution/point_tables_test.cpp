#include "sensor/convolution/point_tables.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/vector_widths.h"

namespace hilcam {
namespace {

constexpr std::ptrdiff_t kPitch = 24;

// Numbers for tables to lie in.
const std::vector<float>& numbers() {
    static const std::vector<float> all = [] {
        std::vector<float> out;
        for (int i = 0; i < 4000; ++i) out.push_back(static_cast<float>(i * 37 % 101) / 64 - 0.5f);
        return out;
    }();
    return all;
}
ShiftedTable table(std::size_t i) { return {numbers().data() + 67 * i, 0.5f + static_cast<float>(i) / 16}; }
// Rows of a picture that is not black.
std::vector<float> picture() { return std::vector<float>(kPitch * 24, 2); }

LargeImage large() {
    LargeImage image{{}, {}, kPitch, 19, 6, 13};
    for (std::size_t i = 0; i < image.cubic.size(); ++i) image.cubic[i] = table(i);
    for (std::size_t i = 0; i < image.linear.size(); ++i) image.linear[i] = table(20 + i);
    return image;
}

TEST(PointTables, ALeastImageIsTheirSum) {
    const std::array tables{table(0), table(1), table(2), table(3)};
    std::vector<float> copy(64);
    copy_least(tables.data(), tables.size(), copy.data());
    std::vector<float> rows = picture();
    add_least(tables.data(), tables.size(), 2, 7, rows.data(), kPitch);
    for (std::ptrdiff_t y = 0; y < 8; ++y)
        for (std::ptrdiff_t x = 0; x < kPitch; ++x) {
            float sum = 0;
            for (const ShiftedTable& t : tables) sum += x < 8 ? t.weight * t.corner[8 * y + x] : 0.0f;
            if (x < 8) {
                EXPECT_EQ(copy[static_cast<std::size_t>(8 * y + x)], sum) << x << ' ' << y;
            }
            const bool added = y >= 2 && y < 7;
            EXPECT_EQ(rows[static_cast<std::size_t>(kPitch * y + x)], added ? 2 + sum : 2) << x << ' ' << y;
        }
}

// By sixteen tables where a vector of columns meets the rows and columns near its middle, else by four.
TEST(PointTables, ALargeImageIsTheirSum) {
    const LargeImage image = large();
    std::vector<float> rows = picture();
    add_large(image, 1, 17, rows.data(), kPitch);
    for (std::ptrdiff_t y = 0; y < image.size; ++y)
        for (std::ptrdiff_t x = 0; x < kPitch; ++x) {
            float sum = 0;
            const std::ptrdiff_t first = x / kColumnsTogether * kColumnsTogether;
            const bool near = y >= 6 && y < 13 && first < 13 && first + kColumnsTogether > 6;
            const bool added = x < image.size && y >= 1 && y < 17;
            for (std::size_t i = 0; added && i < (near ? 16 : 4); ++i) {
                const ShiftedTable& t = near ? image.cubic[i] : image.linear[i];
                sum += t.weight * t.corner[kPitch * y + x];
            }
            EXPECT_EQ(rows[static_cast<std::size_t>(kPitch * y + x)], 2 + sum) << x << ' ' << y;
        }
}

TEST(PointTables, SumsAreAlikeByAnyWidth) {
    expect_same_by_any_width([] {
        const std::array tables{table(4), table(5), table(6)};
        std::vector<float> out = picture();
        add_large(large(), 0, 19, out.data(), kPitch);
        add_least(tables.data(), tables.size(), 0, 8, out.data() + 11, kPitch);
        copy_least(tables.data(), tables.size(), out.data() + 20 * kPitch);
        return out;
    });
}

}  // namespace
}  // namespace hilcam
