#pragma once
// The folder that an output fills with the files of one run.
//
// Files of two runs never mix: the second run's labels would stand beside the first run's images. A folder
// that holds such files is refused unless it may be overwritten; then all files of the older run's output are
// removed before the first new one is written. Other files are left alone.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace hilcam {

struct RunFolder {
    std::string key;  // "outputs.files", for messages
    std::filesystem::path folder;
    // True for the name of a file that this output writes.
    std::function<bool(std::string_view)> is_own;
    bool overwrite = false;
};

// Returns what the folder holds of another run: "outputs.files.folder: found 'out', which holds 200 files of
// another run ('frame_00000001.png' is the first); ..."; empty: nothing. Changes nothing.
std::string used_by_another_run(const RunFolder& folder);
// Throws InputError with that text, unless the folder may be overwritten. Changes nothing.
void require_unused(const RunFolder& folder);
// Creates the folder and removes another run's files from it. Throws InputError as above, DeviceError when
// the file system refuses.
void claim(const RunFolder& folder);

// True for a name that begins with STEM_ and a frame number of eight digits or more.
bool is_numbered(std::string_view file_name, std::string_view stem);

}  // namespace hilcam
