#pragma once
// Takes from a process what it has no use for: descriptors, files and system calls. For children that work on bytes which nobody
// vouches for (confined.h, helper_process.h): whoever breaks the library in there can compute, and read what it was meant to read.
//
// The kernel has these means by degrees: Landlock since 5.13, and more of it later; seccomp where it was built with it. What is not
// there is left out; confinement_here() says what holds on this machine.

#include <filesystem>
#include <span>
#include <string>

namespace hilcam {

// Closes all descriptors of the process but these.
void close_all_but(std::span<const int> kept);

// From now on the thread and those that it starts read below these folders and these files, and write, make or remove nothing anywhere;
// what is open stays so. TCP ports can be neither listened at nor connected to (Landlock 4), processes outside not signalled (6).
// Folders and files that do not exist are left out. False: the kernel has no Landlock, and nothing has changed.
bool restrict_files(std::span<const std::filesystem::path> readable);

// From now on the process has the calls for computing, for reading files, and for messages over what is open: none for sockets, other
// programs, other processes, or for opening a file to write into. Others fail (EPERM). False: the kernel has no seccomp.
bool restrict_calls();

// The means that this machine's kernel has, each of them tried in a process of its own.
struct Confinement {
    int landlock = 0;  // version of its interface; 0: none
    bool seccomp = false;
};
Confinement confinement_here();

}  // namespace hilcam
