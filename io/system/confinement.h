#pragma once
// Takes away from a process what it does not need: descriptors, files and system calls. Used in children that
// work on untrusted bytes (confined.h, helper_process.h): code that breaks the library there can compute and
// read its own input, and nothing else.
//
// The kernel offers this in steps: Landlock since 5.13, and more of it in later versions; seccomp where it
// was built in. What the kernel lacks is left out, and confinement_here() says what works on this machine.

#include <filesystem>
#include <span>
#include <string>

namespace hilcam {

// Closes all descriptors of the process but these.
void close_all_but(std::span<const int> kept);

// Restricts this thread, and threads that it starts, to reading below these folders and these files. They
// cannot write, create or remove anything; what is open stays open. With Landlock 4 they cannot listen on or
// connect to TCP ports, with Landlock 6 they cannot signal other processes. Folders and files that do not
// exist are ignored. Returns false, with nothing changed, when the kernel has no Landlock.
bool restrict_files(std::span<const std::filesystem::path> readable);

// Restricts the process to system calls for computing, for reading files, and for messages over open
// descriptors. Calls for sockets, other programs, other processes, or for opening a file to write fail with
// EPERM. Returns false when the kernel has no seccomp.
bool restrict_calls();

// The means that this machine's kernel supports; seccomp is tried in a child process.
struct Confinement {
    int landlock = 0;  // version of its interface; 0: none
    bool seccomp = false;
};
Confinement confinement_here();

}  // namespace hilcam
