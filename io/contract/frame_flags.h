#pragma once
// Bits of FrameRecord::faults beside those of the faults on demand (fault.h), for what the run's own time and
// input did to a frame.

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace hilcam {

inline constexpr std::uint64_t kTimeStandsBit = std::uint64_t{1} << 60;    // simulated time stood
inline constexpr std::uint64_t kPosesStaleBit = std::uint64_t{1} << 61;    // no pose came (pose_watch.h)
inline constexpr std::uint64_t kTagsWentBackBit = std::uint64_t{1} << 62;  // the first after tags went back

struct FrameFlag {
    std::uint64_t bit;
    std::string_view name;
};
inline constexpr std::array<FrameFlag, 3> kFrameFlags = {{
    {kTimeStandsBit, "time_stands"},
    {kPosesStaleBit, "poses_stale"},
    {kTagsWentBackBit, "tags_went_back"},
}};

// Of FrameRecord::faults, faults and flags.
std::vector<std::string_view> names_of_bits(std::uint64_t bits);

}  // namespace hilcam
