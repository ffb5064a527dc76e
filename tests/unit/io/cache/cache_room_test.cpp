// What counts as a file of the cache, and what is left alone when it is cleared.

#include "io/cache/cache_room.h"

#include "tests/support/files.h"

namespace hilcam {
namespace {

using CacheRoom = FilesTest;

TEST_F(CacheRoom, IsCountedAndClearedAndNothingElseIs) {
    for (const char* own : {"levels_123.bin", "transfer_5_60_400000_enclosed.bin", "reference_9.bin",
                            "atmosphere_1.bin", "levels_123.bin.4711", "levels_123.bin.part-Ab3dE6",
                            "hilcam-make-spacecraft_seed_1_wing-angle-deg--142.00.glb"})
        write(own, "12345");
    for (const char* other : {"levels.bin", "levels_123.bin.bak", "notes.txt", "iss.glb", "hilcam.glb"})
        write(other, "1");
    std::filesystem::create_directories(folder_ / "levels_7.bin");
    std::filesystem::create_symlink(folder_ / "notes.txt", folder_ / "levels_8.bin");

    EXPECT_EQ(cache_size(folder_).files, 7u);
    EXPECT_EQ(cache_size(folder_).bytes, 35u);
    std::size_t of_kinds = 0;
    for (const CacheKind& kind : kCacheKinds) of_kinds += cache_size(folder_, kind.prefix).files;
    EXPECT_EQ(of_kinds, 7u);
    const CacheSize gone = clear_cache(folder_);
    EXPECT_EQ(gone.files, 7u);
    EXPECT_EQ(gone.bytes, 35u);
    EXPECT_EQ(cache_size(folder_).files, 0u);
    for (const char* other :
         {"levels.bin", "levels_123.bin.bak", "notes.txt", "iss.glb", "hilcam.glb", "levels_8.bin"})
        EXPECT_TRUE(std::filesystem::exists(folder_ / other)) << other;
    EXPECT_EQ(cache_size(folder_ / "none").files, 0u);
}

}  // namespace
}  // namespace hilcam
