#pragma once
// Finds the files that belong to the program: shipped data and helper programs.
//
// The search begins at the running program, so that an installed tree may be moved, and goes on in the
// configured prefix. A build tree links to the source tree's configs where an installed tree has its folder.
// Any thread; touches nothing but the file system.

#include <filesystem>
#include <string>

namespace hilcam {

// Returns the file of the running program, from /proc; without /proc, as in a bare chroot, from the path that
// the kernel was asked to run. Empty when neither is known.
std::filesystem::path program_file();
// Returns the same, with `link` in place of /proc/self/exe.
std::filesystem::path program_file_by(const std::filesystem::path& link);
// Returns a path by which the program can start itself again: the running file, even if another has replaced
// it since.
std::filesystem::path own_program();

// Returns the folder that holds scenarios/, cameras/, stars/ ...; empty: there is none.
std::filesystem::path data_folder();

// Returns a shipped file by its path in that folder, "cameras/lorri.yaml". The path in the source tree,
// "configs/cameras/lorri.yaml", works too. Empty: there is no such file.
std::filesystem::path shipped_file(const std::filesystem::path& name);
// True for a folder inside the data folder, where runs must not write.
bool is_shipped(const std::filesystem::path& folder);

// Returns the path of a program that hilcam starts: beside hilcam, or in its own folder (libexec/hilcam).
// When there is none, the path beside hilcam.
std::filesystem::path helper_program(const std::string& name);

}  // namespace hilcam
