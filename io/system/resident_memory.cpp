#include "io/system/resident_memory.h"

#include <fcntl.h>

#include <array>
#include <cstdio>

namespace hilcam {

ResidentMemory::ResidentMemory() : statm_(::open("/proc/self/statm", O_RDONLY | O_CLOEXEC)) {}

double ResidentMemory::megabytes() const {
    // "size resident shared ...", in pages (proc(5)).
    std::array<char, 128> text{};
    unsigned long resident_pages = 0;
    if (::pread(statm_.get(), text.data(), text.size() - 1, 0) <= 0 ||
        std::sscanf(text.data(), "%*u %lu", &resident_pages) != 1)
        return 0;
    return static_cast<double>(resident_pages) * static_cast<double>(::sysconf(_SC_PAGESIZE)) * 1e-6;
}

}  // namespace hilcam
