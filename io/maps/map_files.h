#pragma once
// Finds the files of a map before a library opens them: the one that is named, those of the same name beside
// it (headers, world files, overviews), and those that its label points at.

#include <filesystem>
#include <string>
#include <vector>

namespace hilcam {

struct MapFiles {
    std::filesystem::path file;       // absolute
    std::vector<std::string> beside;  // files in its folder with the same beginning, itself among them
    // Names of files in its folder that the label gives, as spelt there.
    std::vector<std::string> pointed_at{};
    std::string label{};  // text of its PDS3, PDS4 or ISIS label; empty: it has none
};

// Throws InputError, one line that begins with `name`, unless all are regular files in the map's own folder:
// opening a pipe would block, a device has no end, and a label may not name files elsewhere.
MapFiles find_map_files(const std::filesystem::path& file, const std::string& name);

// Returns every word of a PDS3, PDS4 or ISIS label that may be the name of a file it points at; some are no
// names. Throws InputError that begins with `name` when a pointer is not a plain name, and when the values
// are in a file of another format.
std::vector<std::string> label_pointers(const std::string& text, const std::string& name);

}  // namespace hilcam
