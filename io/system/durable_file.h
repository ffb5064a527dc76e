#pragma once
// Files that are there whole or not at all, whatever ends the program or the machine: written under another
// name beside their place, brought to the disk, then renamed.
//
// Names of unfinished files begin with a dot and end as the file does. Any thread.

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hilcam {

// DeviceError when it cannot be written; then what was there before is still there.
void write_durably(const std::filesystem::path& file, std::string_view text);

// Several files that are written by others and take their places together.
class DurableFiles {
  public:
    DurableFiles() = default;
    // Removes what did not take its place.
    ~DurableFiles();
    DurableFiles(const DurableFiles&) = delete;
    DurableFiles& operator=(const DurableFiles&) = delete;

    // Returns the name under which the file is to be written now; its folder is made.
    std::filesystem::path begin(const std::filesystem::path& file);
    // Brings all to the disk and to their places. DeviceError.
    void commit();

  private:
    std::vector<std::pair<std::filesystem::path, std::filesystem::path>> files_;  // unfinished, final
};

// Removes what a program that was killed has left in a folder. Nobody else may be writing there.
void remove_unfinished(const std::filesystem::path& folder);

}  // namespace hilcam
