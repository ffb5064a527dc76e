#include "emulator/zoo/zoo_reference.h"

#include <gtest/gtest.h>

#include <cstring>

#include "emulator/tradeoff/reference_cache.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

const std::string kZooKey = "a key\n";

class ZooReferenceCache : public FilesTest {
  protected:
    Cache cache() const { return Cache(folder_); }
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

// Damage and other keys are reference_cache_test's.
TEST_F(ZooReferenceCache, AReferenceWithoutItsPanIsAnotherFile) {
    keep_reference(cache(), kZooKey, reference());
    EXPECT_FALSE(is_kept());
    keep_zoo_reference(cache(), kZooKey, reference());
    EXPECT_TRUE(is_kept());
    EXPECT_TRUE(kept_reference(cache(), kZooKey));
}

}  // namespace
}  // namespace hilcam
