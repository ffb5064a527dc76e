#pragma once
// Weights the rays of the pixels around a glossy lobe: those that start near it on its surface, by its BRDF
// towards the place that each has met over the density of the ray's direction. It works on vectors of rays,
// from arrays to arrays; every vector width gives the same bits. See glossy_reuse.h for the law.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "render/glossy/glossy_buffer.h"
#include "render/glossy/glossy_columns.h"

namespace hilcam {

// A range of the columns: rays of successive pixels in a row of the picture.
struct GlossyRange {
    std::uint32_t first, end;
    float row_weight;  // weight of the row
};

// The rays around a lobe that count, in order.
struct WeighedRays {
    static constexpr std::size_t kMax = 2048;  // all pixels in reach, some with two surfaces
    static constexpr std::size_t kLanes = 16;  // columns have room for as many more
    using Column = std::array<float, kMax + kLanes>;

    std::size_t count = 0;
    float all = 0, squares = 0;  // sums of weights, and of their squares
    float per_distance = 0;      // weighted mean of one over the distance at which rays meet something [1/m]
    GlossySum sum;               // weighted
    alignas(64) Column weight;   // 0: the ray starts too far away for what it has met
    alignas(64) std::array<std::uint32_t, kMax + kLanes> ray;  // index in the columns

    // The number of rays of equal weight with the same variance (Kish, Survey Sampling, 1965, section 8.2).
    float rays() const { return squares > 0 ? all * all / squares : 0.0f; }
};

// column_px: the column of the lobe's pixel. Loop, any thread.
void weigh_rays(const GlossyColumns& columns, std::span<const GlossyRange> ranges, const GlossyPoint& lobe,
                int column_px, WeighedRays& out);

}  // namespace hilcam
