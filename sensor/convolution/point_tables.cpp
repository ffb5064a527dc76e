#include "sensor/convolution/point_tables.h"

#include <cstring>

#include "render/vocabulary/clones.h"

namespace hilcam {
namespace {

using TwoRows [[gnu::vector_size(64)]] = float;  // two rows of a least image
using LeastImage = std::array<TwoRows, 4>;

[[gnu::always_inline]] inline void sum_least(const ShiftedTable* tables, std::size_t count,
                                             LeastImage& sums) {
    sums = {};
    for (std::size_t t = 0; t < count; ++t)
        for (std::size_t i = 0; i < sums.size(); ++i) {
            TwoRows in;
            std::memcpy(&in, tables[t].corner + 16 * i, sizeof(in));
            sums[i] += tables[t].weight * in;
        }
}

}  // namespace

HILCAM_CLONES void copy_least(const ShiftedTable* tables, std::size_t count, float* out) {
    LeastImage sums;
    sum_least(tables, count, sums);
    std::memcpy(out, sums.data(), sizeof(sums));
}

HILCAM_CLONES void add_least(const ShiftedTable* tables, std::size_t count, std::ptrdiff_t first,
                             std::ptrdiff_t end, float* out, std::ptrdiff_t pitch) {
    LeastImage sums;
    sum_least(tables, count, sums);
    std::array<float, 64> rows;
    std::memcpy(rows.data(), sums.data(), sizeof(rows));
    for (std::ptrdiff_t y = first; y < end; ++y)
        for (std::ptrdiff_t x = 0; x < 8; ++x)
            out[y * pitch + x] += rows[static_cast<std::size_t>(8 * y + x)];
}

HILCAM_CLONES void add_large(const LargeImage& image, std::ptrdiff_t first, std::ptrdiff_t end, float* out,
                             std::ptrdiff_t pitch) {
    using Eight [[gnu::vector_size(32)]] = float;
    constexpr Eight kLane = {0, 1, 2, 3, 4, 5, 6, 7};
    for (std::ptrdiff_t y = first; y < end; ++y) {
        const bool near_row = y >= image.first_near && y < image.end_near;
        for (std::ptrdiff_t x = 0; x < image.size; x += kColumnsTogether) {
            const bool near = near_row && x < image.end_near && x + kColumnsTogether > image.first_near;
            const ShiftedTable* const tables = near ? image.cubic.data() : image.linear.data();
            const std::size_t count = near ? image.cubic.size() : image.linear.size();
            Eight sum{};
            for (std::size_t t = 0; t < count; ++t) {
                Eight in;
                std::memcpy(&in, tables[t].corner + y * image.pitch + x, sizeof(in));
                sum += tables[t].weight * in;
            }
            const auto rest = static_cast<float>(image.size - x);
            sum = kLane < rest ? sum : Eight{};
            Eight there;
            std::memcpy(&there, out + y * pitch + x, sizeof(there));
            there += sum;
            std::memcpy(out + y * pitch + x, &there, sizeof(there));
        }
    }
}

}  // namespace hilcam
