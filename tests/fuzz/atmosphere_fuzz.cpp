// Tables of an atmosphere, of values or of MODTRAN runs: whatever the bytes, finite values or an InputError.
// Bytes that begin with the name of a run's first column are a run; an index of it is made here.

#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string_view>

#include "io/files/atmosphere_file.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("hilcam_atmosphere_fuzz_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    const bool run = bytes.starts_with("WAVLEN") || bytes.starts_with("FREQ");
    std::ofstream(folder / (run ? "run.scn" : "table.csv"), std::ios::binary) << bytes;
    if (run)
        std::ofstream(folder / "table.csv") << "sun_zenith_deg,view_zenith_deg,azimuth_deg,height_km,file\n"
                                               "60,20,90,800,run.scn\n";
    try {
        const hilcam::AtmosphereTable table =
            hilcam::read_atmosphere(folder / "table.csv", hilcam::SpectralGrid({0.45, 0.55, 0.65}));
        for (const auto& cell : table.cells)
            if (!std::isfinite(cell.tau_1[0] + cell.tau_2[0] + cell.radiance_sr[0] + cell.sky[0]))
                std::abort();
    } catch (const hilcam::InputError&) {
    }
    std::filesystem::remove_all(folder);
    return 0;
}
