#pragma once
// The colour of M stars by their spectral class. Their B-V does not determine it: giants from M0 to M6 have
// B-V of 1.5 to 1.65, and dwarfs of the same B-V are up to 0.8 mag redder in V-I.

#include <optional>
#include <string_view>

namespace hilcam {

// Returns V-I, Cousins' I, of "M2III", "gM4", "M1-M2Ia-Iab", "M3.5 V" and the like; nothing for another class
// or without a subclass. A star without a luminosity class counts as a giant, like most M stars that are
// visible to the naked eye.
std::optional<double> m_star_v_i(std::string_view spectral_type);

}  // namespace hilcam
