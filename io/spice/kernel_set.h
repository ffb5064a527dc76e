#pragma once
// A set of SPICE kernels in the order of their names: later kernels take precedence over earlier ones (NAIF,
// "Kernel Required Reading").
//
// A meta-kernel names others in KERNELS_TO_LOAD, with $SYMBOL for a path (PATH_SYMBOLS, PATH_VALUES).
// Relative paths start at the meta-kernel's folder, not at the working directory. A file that is named
// several times is loaded once, at the last place, because a kernel that NAIF's toolkit loads again takes
// precedence over all others.

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/naif/daf_file.h"
#include "io/spice/ephemeris_time.h"
#include "io/spice/kernel_pool.h"

namespace hilcam {

struct KernelSet {
    KernelPool pool;
    std::vector<std::unique_ptr<DafFile>> binaries;  // in loading order
    std::vector<std::string> files;                  // all of them, for reports
    EphemerisTime time;
};

// Throws InputError, one line, for a file that is missing, truncated or no kernel, and for a meta-kernel that
// names itself or more than 10 000 files. Refuses shape kernels (DSK): they are meshes. Owner thread.
KernelSet load_kernels(std::span<const std::filesystem::path> files);

}  // namespace hilcam
