#pragma once
// The colour of M stars by their spectral class, which their B-V does not tell: from M0 to M6 giants have B-V of 1.5 to 1.65, and dwarfs of
// the same B-V are up to 0.8 mag redder in V-I.

#include <optional>
#include <string_view>

namespace hilcam {

// Returns V-I, Cousins' I, of "M2III", "gM4", "M1-M2Ia-Iab", "M3.5 V" and the like; nothing for a star that is not of class M or of no known
// subclass. Without a luminosity it is a giant, as most of those are that are seen with the naked eye.
std::optional<double> m_star_v_i(std::string_view spectral_type);

}  // namespace hilcam
