#pragma once
// Bits of FrameRecord::faults beside those of the faults on demand (fault.h), for what the run's own time and
// input did to a frame.

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace hilcam {

// Something in it could not be, as a place that is no number, and was left as it was (motion_bounds.h).
inline constexpr std::uint64_t kImpossibleMotionBit = std::uint64_t{1} << 58;
// It was made before the light between surfaces was kept that its quality asks for (loop.wait_for_light).
inline constexpr std::uint64_t kNoCachedLightBit = std::uint64_t{1} << 59;
inline constexpr std::uint64_t kTimeStandsBit = std::uint64_t{1} << 60;    // simulated time stood
inline constexpr std::uint64_t kPosesStaleBit = std::uint64_t{1} << 61;    // no pose came (pose_watch.h)
inline constexpr std::uint64_t kTagsWentBackBit = std::uint64_t{1} << 62;  // the first after tags went back

struct FrameFlag {
    std::uint64_t bit;
    std::string_view name;
};
inline constexpr std::array<FrameFlag, 5> kFrameFlags = {{
    {kImpossibleMotionBit, "impossible_motion"},
    {kNoCachedLightBit, "no_kept_light"},
    {kTimeStandsBit, "time_stands"},
    {kPosesStaleBit, "poses_stale"},
    {kTagsWentBackBit, "tags_went_back"},
}};

// Returns the names of the bits of FrameRecord::faults: faults and flags.
std::vector<std::string_view> names_of_bits(std::uint64_t bits);

}  // namespace hilcam
