// Measured BRDFs in CSV: whatever the bytes, a table of finite values or an InputError.

#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>

#include "io/files/brdf_file.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("hilcam_brdf_fuzz_" + std::to_string(getpid()) + ".csv");
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    try {
        const hilcam::BrdfTable table = hilcam::read_brdf(file, hilcam::SpectralGrid({0.5, 0.6, 0.7}));
        for (const float cosine : {0.01f, 0.5f, 1.0f})
            if (!std::isfinite(table.value(cosine, 0.7f, 0.3f)[0])) std::abort();
    } catch (const hilcam::InputError&) {
    }
    std::filesystem::remove(file);
    return 0;
}
