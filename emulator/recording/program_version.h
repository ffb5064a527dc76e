#pragma once
// What `hilcam --version` says, and what a recording says it was made by.

#include <string_view>

namespace hilcam {

inline constexpr std::string_view kProgramVersion = "hilcam 0.1.0";

}  // namespace hilcam
