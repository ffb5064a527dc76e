#pragma once
// Reference frames by name and code: SPICE's built-in ones and those of frames kernels (NAIF, "Frames
// Required Reading").

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "io/spice/kernel_pool.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

enum class FrameClass { kInertial = 1, kPck = 2, kCk = 3, kFixedOffset = 4, kDynamic = 5 };

struct DynamicFrame;

struct FrameDefinition {
    int code = 0;
    std::string name;
    FrameClass kind = FrameClass::kInertial;
    int class_code = 0;  // kPck: code of the body or binary kernel; kCk: of the structure
    // kInertial: into J2000's axes; kFixedOffset: into the axes of the frame `relative`.
    Mat3d relative_from_frame;
    int relative = 1;                               // kFixedOffset, kDynamic: the base
    std::shared_ptr<const DynamicFrame> dynamic{};  // kDynamic
    std::string where;                              // place of the definition, for messages
};

inline constexpr int kJ2000Frame = 1;

// Returns a frame by its name (in any case) or code. Built-in inertial frames: J2000, ECLIPJ2000, DE-200,
// DE-202, B1950, FK4, DE-118, -140, -142, -143, GALACTIC and MARSIAU. Built-in as well: ITRF93, and IAU_ with
// any body's name or code. Throws InputError for a frame that no kernel defines, or of another class (switch
// frames).
FrameDefinition frame_named(const KernelPool& pool, std::string_view name, const std::string& key);
// Returns the code only. Frames may refer to each other in a circle; the caller that follows them has to
// detect it.
int frame_code(const KernelPool& pool, const std::string& name, const std::string& where);

// Returns NAIF's [angle]i: axes rotated about axis i, 1 to 3.
Mat3d turned_axes(int axis, double angle_rad);
FrameDefinition frame_coded(const KernelPool& pool, int code, const std::string& key);

}  // namespace hilcam
