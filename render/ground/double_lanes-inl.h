// Lanes of double precision, for code that is compiled for several vector widths. Included once per width,
// like Highway's own headers.

#if defined(HILCAM_DOUBLE_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HILCAM_DOUBLE_LANES_INL_H
#undef HILCAM_DOUBLE_LANES_INL_H
#else
#define HILCAM_DOUBLE_LANES_INL_H
#endif

#include <hwy/highway.h>

#include "render/vocabulary/vec.h"

HWY_BEFORE_NAMESPACE();
namespace hilcam {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
constexpr std::size_t kMaxLanes = 8;
using Doubles = hn::CappedTag<double, kMaxLanes>;
using Longs = hn::RebindToSigned<Doubles>;
using V = hn::Vec<Doubles>;
// Places are loaded as three numbers each.
static_assert(sizeof(Vec3d) == 3 * sizeof(double));

HWY_INLINE V number(double value) { return hn::Set(Doubles(), value); }

}  // namespace HWY_NAMESPACE
}  // namespace hilcam
HWY_AFTER_NAMESPACE();

#endif
