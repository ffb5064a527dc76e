#pragma once
// Code that Highway has compiled for several widths of vectors, run by each: other processors' frames must be this one's.

#include <gtest/gtest.h>

#include <hwy/highway.h>

#include <initializer_list>

namespace hilcam {

// Expects value() to be the same by the narrower vectors as by the widest that the processor has.
template <class Value>
void expect_same_by_any_width(const Value& value,
                              std::initializer_list<std::int64_t> widths = {HWY_AVX2, HWY_SSE4}) {
    const auto widest = value();
    for (const std::int64_t width : widths) {
        hwy::DisableTargets(~width);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        EXPECT_EQ(value(), widest) << hwy::TargetName(width);
    }
    hwy::DisableTargets(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace hilcam
