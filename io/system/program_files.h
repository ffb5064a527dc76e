#pragma once
// The files that belong to the program: those that are shipped with it, and the programs that it starts.
//
// They are sought from where the running program lies, so that an installed tree may be moved; then in the
// prefix that it was configured for. A build tree has a link to the source tree's configs in the place of
// the installed folder. Any thread; touches nothing but the file system.

#include <filesystem>
#include <string>

namespace hilcam {

// The running program's file: what /proc says; where there is no /proc, as in a bare chroot, what the kernel was asked
// to run. Empty: neither tells.
std::filesystem::path program_file();
// The same where `link` stands for /proc/self/exe.
std::filesystem::path program_file_by(const std::filesystem::path& link);
// A path by which the program starts itself once more: the file that runs, even where another has taken its place since.
std::filesystem::path own_program();

// The folder of scenarios/, cameras/, stars/ ...; empty: there is none.
std::filesystem::path data_folder();

// A shipped file by its path in that folder, "cameras/lorri.yaml", as it may be written from the source tree,
// too ("configs/cameras/lorri.yaml"); empty: there is no such file.
std::filesystem::path shipped_file(const std::filesystem::path& name);
// True of a file's folder that lies in the data folder, where runs must not write.
bool is_shipped(const std::filesystem::path& folder);

// A program that hilcam starts, beside it or in its own folder (libexec/hilcam). Beside it, when there is
// none.
std::filesystem::path helper_program(const std::string& name);

}  // namespace hilcam
