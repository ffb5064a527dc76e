#pragma once
// A camera as an instrument kernel (IK) describes it: NAIF's keywords for the field of view ("IK Required
// Reading", GETFOV), and those that most missions' kernels use for focal length and pixels.

#include <optional>
#include <string>

#include "io/spice/kernel_pool.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

struct InstrumentKernel {
    int code = 0;
    std::string frame;               // empty: the kernel does not say
    std::optional<Vec3d> boresight;  // unit vector in the frame
    // INS<code>_FOCAL_LENGTH in mm; _PIXEL_PITCH in mm, else _PIXEL_SIZE in the one of m, mm and um that
    // gives 1 to 100 um; _PIXEL_SAMPLES and _PIXEL_LINES.
    std::optional<double> focal_length_m, pitch_m;
    std::optional<std::int64_t> samples, lines;
    // The point where the boresight meets the detector [px; the centre of the first pixel is (0.5, 0.5)]:
    // _DISTORTION_X and _DISTORTION_Y, the centre of distortion (JunoCam's and others'), else _CCD_CENTER.
    // The kernel counts from the first pixel's centre as (0, 0), or as (1, 1) where _CCD_CENTER is the centre
    // of the pixels in that count.
    std::optional<Vec2d> center_px;
    // Half the field of view, from the boresight to the farthest corner or edge.
    std::optional<double> half_field_rad;
};

// Throws InputError when the kernels have no instrument of that name or code, and for malformed numbers.
InstrumentKernel instrument_kernel(const KernelPool& pool, std::string_view name, const std::string& key);

}  // namespace hilcam
