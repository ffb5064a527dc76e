#pragma once
// The view of one probe, direction by direction, as its transfer table has it. For people and tools; the
// frame loop reads the table itself.

#include <cstdint>
#include <vector>

#include "render/probes/transfer_table.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

enum class ProbeMeets : std::uint8_t {
    kNothing,  // nothing: the direction leaves the object
    kProbe,    // surface of another probe
    kDark,     // a surface that sends no light: it has no cache, or no light reaches it
    kOwnSide,  // ignored: the direction points below the surface at its point
    kBuried,   // ignored: its point sees only what is nearer than half a cube
};

struct ProbeRay {
    Vec3f dir;              // unit, body axes
    std::size_t point = 0;  // number of the probe's point where it starts
    ProbeMeets meets = ProbeMeets::kDark;
    std::uint32_t probe = 0;  // the probe that it meets, for kProbe only
};

// Returns a probe's directions in the table's order; probe is below table.size(). Any thread.
std::vector<ProbeRay> rays_of(const TransferTable& table, std::size_t probe);

}  // namespace hilcam
