#pragma once
// Files that are complete or absent, even if the program or the machine stops: a file is written under
// another name in the same folder, synced to the disk, then renamed.
//
// Names of unfinished files begin with a dot and keep the file's ending. Any thread.

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hilcam {

// Writes a file. Throws DeviceError when that fails; then the old file is still there.
void write_durably(const std::filesystem::path& file, std::string_view text);

// Several files, written by others, that take their places together.
class DurableFiles {
  public:
    DurableFiles() = default;
    // Removes files that were not committed.
    ~DurableFiles();
    DurableFiles(const DurableFiles&) = delete;
    DurableFiles& operator=(const DurableFiles&) = delete;

    // Returns the name under which the file has to be written first; creates its folder.
    std::filesystem::path begin(const std::filesystem::path& file);
    // Syncs all files to the disk and renames them. Throws DeviceError.
    void commit();

  private:
    std::vector<std::pair<std::filesystem::path, std::filesystem::path>> files_;  // unfinished, final
};

// Removes the unfinished files of a killed program from a folder. Nothing else may be writing there.
void remove_unfinished(const std::filesystem::path& folder);

}  // namespace hilcam
