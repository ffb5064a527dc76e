#include "sensor/convolution/point_tables.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sensor/convolution/point_tables.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hilcam {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kMin = 64;  // numbers in the smallest image

// Numbers side by side, in as many vectors as necessary.
template <std::size_t kCount>
struct Numbers {
    using Floats = hn::CappedTag < float, kCount<16 ? kCount : 16>;
    static constexpr std::size_t kLanes = hn::MaxLanes(Floats());
    hn::Vec<Floats> vector[kCount / kLanes];

    // Computes the sum of the tables, starting at one of their numbers.
    HWY_INLINE void sum(const ShiftedTable* tables, std::size_t count, std::ptrdiff_t from) {
        const Floats d;
        for (auto& v : vector) v = hn::Zero(d);
        for (std::size_t t = 0; t < count; ++t) {
            const float* numbers = tables[t].corner + from;
            const auto weight = hn::Set(d, tables[t].weight);
            for (auto& v : vector) v = hn::Add(v, hn::Mul(weight, hn::LoadU(d, numbers))), numbers += kLanes;
        }
    }
    HWY_INLINE void store(float* to) const {
        for (const auto& v : vector) hn::StoreU(v, Floats(), to), to += kLanes;
    }
    // Adds the first `count` of them, or all, to memory.
    HWY_INLINE void add_to(float* to, std::ptrdiff_t count) const {
        const Floats d;
        auto rest = static_cast<float>(count);
        for (const auto& v : vector) {
            const auto ours = hn::IfThenElseZero(hn::Lt(hn::Iota(d, 0), hn::Set(d, rest)), v);
            hn::StoreU(hn::Add(hn::LoadU(d, to), ours), d, to);
            to += kLanes, rest -= static_cast<float>(kLanes);
        }
    }
};

void copy(const ShiftedTable* tables, std::size_t count, float* out) {
    // The sums of this many numbers stay in registers, however narrow vectors are.
    constexpr std::size_t kTogether = kMin < 8 * Numbers<kMin>::kLanes ? kMin : 8 * Numbers<kMin>::kLanes;
    for (std::size_t first = 0; first < kMin; first += kTogether) {
        Numbers<kTogether> part;
        part.sum(tables, count, static_cast<std::ptrdiff_t>(first));
        part.store(out + first);
    }
}

void add_rows(const ShiftedTable* tables, std::size_t count, std::ptrdiff_t first, std::ptrdiff_t end,
              float* out, std::ptrdiff_t pitch) {
    for (std::ptrdiff_t y = first; y < end; ++y) {
        Numbers<8> row;
        row.sum(tables, count, 8 * y);
        row.add_to(out + y * pitch, 8);
    }
}

void add_rows_of_large(const LargeImage& image, std::ptrdiff_t first, std::ptrdiff_t end, float* out,
                       std::ptrdiff_t pitch) {
    for (std::ptrdiff_t y = first; y < end; ++y) {
        const bool near_row = y >= image.first_near && y < image.end_near;
        for (std::ptrdiff_t x = 0; x < image.size; x += kColumnsTogether) {
            const bool near = near_row && x < image.end_near && x + kColumnsTogether > image.first_near;
            Numbers<kColumnsTogether> columns;
            columns.sum(near ? image.cubic.data() : image.linear.data(),
                        near ? image.cubic.size() : image.linear.size(), y * image.pitch + x);
            columns.add_to(out + y * pitch + x, image.size - x);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace hilcam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hilcam {

HWY_EXPORT(copy);
HWY_EXPORT(add_rows);
HWY_EXPORT(add_rows_of_large);

void copy_least(const ShiftedTable* tables, std::size_t count, float* out) {
    HWY_DYNAMIC_DISPATCH(copy)(tables, count, out);
}

void add_least(const ShiftedTable* tables, std::size_t count, std::ptrdiff_t first, std::ptrdiff_t end,
               float* out, std::ptrdiff_t pitch) {
    HWY_DYNAMIC_DISPATCH(add_rows)(tables, count, first, end, out, pitch);
}

void add_large(const LargeImage& image, std::ptrdiff_t first, std::ptrdiff_t end, float* out,
               std::ptrdiff_t pitch) {
    HWY_DYNAMIC_DISPATCH(add_rows_of_large)(image, first, end, out, pitch);
}

}  // namespace hilcam
#endif
