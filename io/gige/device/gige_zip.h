#pragma once
// A ZIP archive (PKWARE APPNOTE 6.3, deflate) of one file, in memory: the form in which cameras keep their
// description.

#include <cstdint>
#include <string>
#include <vector>

namespace hilcam {

// Its length is a multiple of 4: the archive's comment fills it up.
std::vector<std::uint8_t> zip_of(const std::string& name, const std::string& content);

}  // namespace hilcam
