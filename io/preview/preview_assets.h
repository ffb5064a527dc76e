#pragma once
// The page's files, which are compiled into the program.

#include <span>
#include <string_view>

namespace hilcam {

struct PreviewAsset {
    const char* path;  // path in a request
    std::string_view text;
    const char* type;
};
// Returns all files. Any thread.
std::span<const PreviewAsset> preview_assets();

}  // namespace hilcam
