// Any file is a catalogue of finite numbers, or refused in one line.

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "io/files/catalogue_file.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    const auto file = std::filesystem::temp_directory_path() /
                      ("hilcam_catalogue_fuzz_" + std::to_string(getpid()) + ".csv");
    std::ofstream(file, std::ios::binary) << std::string_view(reinterpret_cast<const char*>(data), size);
    try {
        const StarCatalogue catalogue = load_catalogue(file);
        for (const CatalogueStar& star : catalogue.stars)
            HILCAM_CHECK(std::isfinite(star.right_ascension_rad) && std::abs(star.declination_rad) < 1.6 &&
                         std::isfinite(star.magnitude_v));
    } catch (const InputError& error) {
        HILCAM_CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
    std::filesystem::remove(file);
    return 0;
}
