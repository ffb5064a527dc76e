#pragma once
// This is the view of one probe, direction by direction, as its transfer table has it: for people and tools. The frame loop reads the
// table itself.

#include <cstdint>
#include <vector>

#include "render/probes/transfer_table.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

enum class ProbeMeets : std::uint8_t {
    kNothing,  // the direction leaves the object
    kProbe,    // the surface of another probe
    kDark,     // a surface that sends no light: it keeps none, or no light reaches it
    kOwnSide,  // nothing that counts: the direction points below the surface at its point
    kBuried,   // nothing that counts: its point sees only what is nearer than half a cube
};

struct ProbeRay {
    Vec3f dir;              // unit, body axes
    std::size_t point = 0;  // number of the probe's point at which it begins
    ProbeMeets meets = ProbeMeets::kDark;
    std::uint32_t probe = 0;  // the probe that it meets; counts for kProbe alone
};

// Returns the directions of a probe below table.size(), in the table's order. Any thread.
std::vector<ProbeRay> rays_of(const TransferTable& table, std::size_t probe);

}  // namespace hilcam
