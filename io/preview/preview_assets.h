#pragma once
// The page's files, which are in the program: it is one file.

#include <span>
#include <string_view>

namespace hilcam {

struct PreviewAsset {
    const char* path;  // path by which it is asked for
    std::string_view text;
    const char* type;
};
// Any thread.
std::span<const PreviewAsset> preview_assets();

}  // namespace hilcam
