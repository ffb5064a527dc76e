// Tables of air on disk.

#include "io/cache/atmosphere_cache.h"

#include <gtest/gtest.h>

#include <fstream>

#include "render/sky/atmosphere_config.h"
#include "render/sky/atmosphere_models.h"
#include "render/vocabulary/units.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using AirCache = FilesTest;
const SpectralGrid kGrid({0.449, 0.451, 0.649, 0.651});

TEST_F(AirCache, TablesComeBackFromDiskAndADamagedFileIsMadeAnew) {
    const std::filesystem::path folder = folder_ / "cache";
    const AtmosphereCache cache{Cache(folder)};
    AtmosphereConfig config;
    config.model = "precomputed";
    const auto radiance = [&] {
        const auto air = make_precomputed_atmosphere({config, kGrid, nullptr, &cache});
        return air
            ->look({kEarthEquatorialRadius_m + 500e3, 0, 0}, {-1, 0, 0}, 500e3, normalized(Vec3d{1, 1, 0}))
            .radiance_sr[0];
    };
    const float made = radiance();
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
    EXPECT_EQ(radiance(), made);
    const auto file = std::filesystem::directory_iterator(folder)->path();
    const auto whole = std::filesystem::file_size(file);
    std::filesystem::resize_file(file, whole / 2);
    EXPECT_EQ(radiance(), made);
    EXPECT_EQ(std::filesystem::file_size(file), whole);
    // A page of zeros, in the middle of the light.
    {
        std::fstream out(file, std::ios::in | std::ios::out | std::ios::binary);
        out.seekp(static_cast<std::streamoff>(whole / 2)) << std::string(4096, '\0');
    }
    EXPECT_EQ(radiance(), made);
}

}  // namespace
}  // namespace hilcam
