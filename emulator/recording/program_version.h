#pragma once
// The program version that recordings, pictures and truth contain. `hilcam --version` adds the commit
// (emulator/commit.h), on which nothing else depends.

#include <string_view>

namespace hilcam {

// "hilcam 0.3.0", from CMakeLists.txt.
extern const std::string_view kProgramVersion;

}  // namespace hilcam
