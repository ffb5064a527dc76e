#pragma once
// The folder that an output fills with the files of one run.
//
// Files of two runs are never mixed in it: the second run's labels would stand beside the first run's
// pictures. So a folder that holds such files already is refused, unless it may be overwritten; then all of
// the older run's files of this output go before the first new one comes. Files that this output does not
// write are left alone.

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

// Says what the folder holds of another run: "outputs.files.folder: found 'out', which holds 200 files of
// another run ('frame_00000001.png' is one); ...". Empty: nothing. Changes nothing.
std::string used_by_another_run(const RunFolder& folder);
// Throws InputError with that text, unless the folder may be overwritten. Changes nothing.
void require_unused(const RunFolder& folder);
// Makes the folder, without files of another run. InputError as above; DeviceError when that cannot be.
void claim(const RunFolder& folder);

// STEM_ and a frame's number of eight digits or more, whatever follows.
bool is_numbered(std::string_view file_name, std::string_view stem);

}  // namespace hilcam
