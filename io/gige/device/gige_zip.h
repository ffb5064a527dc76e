#pragma once
// A ZIP archive (PKWARE APPNOTE 6.3, deflate) of one file, in memory: the form in which cameras store their
// description.

#include <cstdint>
#include <string>
#include <vector>

namespace hilcam {

// Returns an archive with a length that is a multiple of 4; its comment is the padding.
std::vector<std::uint8_t> zip_of(const std::string& name, const std::string& content);

}  // namespace hilcam
