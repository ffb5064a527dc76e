// Sixteen numbers in as many vectors as they take, for code that is compiled for several widths. Included once for each width, as
// Highway's own headers are.

#if defined(HILCAM_SIXTEEN_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HILCAM_SIXTEEN_LANES_INL_H
#undef HILCAM_SIXTEEN_LANES_INL_H
#else
#define HILCAM_SIXTEEN_LANES_INL_H
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hilcam {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, 16>;
using Ints = hn::RebindToSigned<Floats>;
using V = hn::Vec<Floats>;
using I = hn::Vec<Ints>;

// One sum and one product after the other, never fused: every width must round alike.
HWY_INLINE V times_plus(V a, V b, V c) { return hn::Add(hn::Mul(a, b), c); }

}  // namespace HWY_NAMESPACE
}  // namespace hilcam
HWY_AFTER_NAMESPACE();

#endif
