#include "sensor/test_pattern.h"

#include <algorithm>

namespace hilcam {

void draw_test_pattern(TestPattern pattern, int bits, std::uint64_t frame, DnImage& image) {
    const std::uint64_t most = (std::uint64_t{1} << bits) - 1;
    const auto ramp = [&](auto dn_of) {
        for (int y = 0; y < image.height(); ++y) {
            const auto row = image.row(y);
            for (std::size_t x = 0; x < row.size(); ++x)
                row[x] = static_cast<std::uint16_t>(dn_of(x, static_cast<std::uint64_t>(y)) & most);
        }
    };
    switch (pattern) {
        case TestPattern::kOff:
            return;
        case TestPattern::kBlack:
            std::fill(image.all().begin(), image.all().end(), std::uint16_t{0});
            return;
        case TestPattern::kWhite:
            std::fill(image.all().begin(), image.all().end(), static_cast<std::uint16_t>(most));
            return;
        case TestPattern::kRampHorizontal:
            return ramp([](std::uint64_t x, std::uint64_t) { return x; });
        case TestPattern::kRampVertical:
            return ramp([](std::uint64_t, std::uint64_t y) { return y; });
        case TestPattern::kRampHorizontalMoving:
            return ramp([frame](std::uint64_t x, std::uint64_t) { return x + frame; });
    }
}

}  // namespace hilcam
