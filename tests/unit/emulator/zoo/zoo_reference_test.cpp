#include "emulator/zoo/zoo_reference.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "tests/support/files.h"

namespace hilcam {
namespace {

const std::string kZooKey = "a key\n";

class ZooReferenceCache : public FilesTest {
  protected:
    Cache cache() const { return Cache(folder_); }
    std::filesystem::path file() const { return folder_ / zoo_reference_name(kZooKey); }
    bool is_kept() const { return kept_zoo_reference(cache(), kZooKey).has_value(); }

    static ZooReference reference() {
        ZooReference r;
        float value = 0;
        for (ElectronImage* image : {&r.mean, &r.dark, &r.error, &r.change, &r.change_error}) {
            *image = ElectronImage(5, 3);
            for (float& e : image->all()) e = value += 0.1f;
        }
        r.standard_error = {1.5, 0.25, 0.75, 12};
        r.frames = 8, r.seconds = 2.5;
        return r;
    }
};

TEST_F(ZooReferenceCache, ComesBackBitByBit) {
    EXPECT_FALSE(is_kept());
    const ZooReference given = reference();
    keep_zoo_reference(cache(), kZooKey, given);
    const auto kept = kept_zoo_reference(cache(), kZooKey);
    ASSERT_TRUE(kept);
    const auto same = [](const ElectronImage& a, const ElectronImage& b) {
        return a.width() == b.width() && a.height() == b.height() &&
               std::memcmp(a.data(), b.data(), a.pixels() * sizeof(float)) == 0;
    };
    EXPECT_TRUE(same(kept->mean, given.mean) && same(kept->dark, given.dark) &&
                same(kept->error, given.error));
    EXPECT_TRUE(same(kept->change, given.change) && same(kept->change_error, given.change_error));
    EXPECT_EQ(kept->frames, 8);
    EXPECT_EQ(kept->seconds, 2.5);
    EXPECT_EQ(kept->standard_error.p99, 1.5);
    EXPECT_EQ(kept->standard_error.lit_px, 12u);
}

TEST_F(ZooReferenceCache, NothingDamagedOrForeignIsTaken) {
    keep_zoo_reference(cache(), kZooKey, reference());
    const auto whole = static_cast<std::streamoff>(std::filesystem::file_size(file()));
    for (std::streamoff at = 0; at < whole; at += 5) {
        keep_zoo_reference(cache(), kZooKey, reference());
        std::fstream bytes(file(), std::ios::in | std::ios::out | std::ios::binary);
        char byte = 0;
        bytes.seekg(at).get(byte);
        bytes.seekp(at).put(static_cast<char>(byte ^ 0x40));
        bytes.close();
        EXPECT_FALSE(is_kept()) << at;
    }
    keep_zoo_reference(cache(), kZooKey, reference());
    std::filesystem::resize_file(file(), static_cast<std::uintmax_t>(whole - 4));
    EXPECT_FALSE(is_kept());
    keep_zoo_reference(cache(), kZooKey, reference());
    EXPECT_TRUE(is_kept());
    std::filesystem::rename(file(), folder_ / zoo_reference_name("another key\n"));
    EXPECT_FALSE(kept_zoo_reference(cache(), "another key\n"));
}

}  // namespace
}  // namespace hilcam
