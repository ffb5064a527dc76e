#pragma once
// Bits of FrameRecord::faults above those of ordered faults (fault.h): what the run's own time and input did
// to a frame.

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace hilcam {

// A pose or another input of the frame was impossible, such as a position that is not a number, and was not
// used (motion_bounds.h).
inline constexpr std::uint64_t kImpossibleMotionBit = std::uint64_t{1} << 58;
// The frame was made before the cached light between surfaces reached its quality (loop.wait_for_light).
inline constexpr std::uint64_t kNoCachedLightBit = std::uint64_t{1} << 59;
inline constexpr std::uint64_t kTimeStandsBit = std::uint64_t{1} << 60;    // simulated time stood
inline constexpr std::uint64_t kPosesStaleBit = std::uint64_t{1} << 61;    // no pose came (pose_watch.h)
inline constexpr std::uint64_t kTagsWentBackBit = std::uint64_t{1} << 62;  // first after time tags went back

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

// Returns the names of the set bits of FrameRecord::faults, faults and flags.
std::vector<std::string_view> names_of_bits(std::uint64_t bits);

}  // namespace hilcam
