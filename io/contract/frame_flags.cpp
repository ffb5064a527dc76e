#include "io/contract/frame_flags.h"

#include "io/contract/fault.h"

namespace hilcam {

std::vector<std::string_view> names_of_bits(std::uint64_t bits) {
    std::vector<std::string_view> names;
    for (const FaultKind kind : kAllFaults)
        if (bits & bit_of(kind)) names.push_back(name_of(kind));
    for (const FrameFlag& flag : kFrameFlags)
        if (bits & flag.bit) names.push_back(flag.name);
    return names;
}

}  // namespace hilcam
