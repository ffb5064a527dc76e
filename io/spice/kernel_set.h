#pragma once
// A set of SPICE kernels in the order in which they were named: what comes later goes before what came earlier, as NAIF,
// "Kernel Required Reading" has it.
//
// A meta-kernel names others in KERNELS_TO_LOAD, with $SYMBOL in place of a path (PATH_SYMBOLS, PATH_VALUES). Paths that
// are not absolute start at the folder of the meta-kernel, not at where the program was started. A file that is named more
// than once is loaded once, where it is named last, as a kernel that NAIF's toolkit loads again goes before all others.

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
    std::vector<std::unique_ptr<DafFile>> binaries;  // in the order of their loading
    std::vector<std::string> files;                  // all of them, for reports
    EphemerisTime time;
};

// Throws InputError, one line, for a file that is missing, no kernel, cut short, or a meta-kernel that names itself or names more
// than 10 000 files. Shape kernels (DSK) are meshes, not part of a set: refused. Owner thread.
KernelSet load_kernels(std::span<const std::filesystem::path> files);

}  // namespace hilcam
