#pragma once
// The files that a map consists of, as far as they can be told before a library opens them: the one that is named, what lies beside it
// under the same name (headers, world files, overviews), and what its label points at.

#include <filesystem>
#include <string>
#include <vector>

namespace hilcam {

struct MapFiles {
    std::filesystem::path file;       // absolute
    std::vector<std::string> beside;  // names of files in its folder that begin as it does, itself among them
    std::vector<std::string>
        pointed_at{};     // names in its folder that the label gives, as they are spelt there
    std::string label{};  // text of its PDS3, PDS4 or ISIS label; empty: it has none
};

// Throws InputError, one line that begins with `name`, unless all of them are regular files of the map's own folder: a pipe would keep
// whoever opens it, a device has no end, and a label may not name what lies elsewhere.
MapFiles find_map_files(const std::filesystem::path& file, const std::string& name);

// Returns all that may be the name of a file which the text of a PDS3, PDS4 or ISIS label points at; words that are none are among it. Throws
// InputError, which begins with `name`, where a pointer is no plain name, and where the values are in a file of another format.
std::vector<std::string> label_pointers(const std::string& text, const std::string& name);

}  // namespace hilcam
