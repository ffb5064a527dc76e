#include "emulator/tradeoff/reference_cache.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <fstream>

#include "emulator/tradeoff/tradeoff_knobs.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

const std::string kKey = "a key\nof two lines\n";

class ReferenceCache : public FilesTest {
  protected:
    Cache cache() const { return Cache(folder_); }
    std::filesystem::path file() const { return folder_ / reference_name(kKey); }
    void keep() const { keep_reference(cache(), kKey, picture()); }
    bool is_kept() const { return kept_reference(cache(), kKey).has_value(); }

    // No two pixels alike, one of them as small as floats go.
    static ReferencePicture picture() {
        ReferencePicture p{ElectronImage(7, 5), ElectronImage(7, 5), {1.5, 0.25, 0.75, 30}, 8, 12.5};
        for (std::size_t i = 0; i < p.mean.pixels(); ++i) {
            p.mean.data()[i] = 1000.1f * static_cast<float>(i);
            p.dark.data()[i] = 0.3f + static_cast<float>(i);
        }
        p.mean.data()[3] = 1e-45f;
        return p;
    }
    void put(std::streamoff at, char byte) const {
        std::fstream out(file(), std::ios::in | std::ios::out | std::ios::binary);
        out.seekp(at).put(byte);
    }
};

bool same_bits(const ElectronImage& a, const ElectronImage& b) {
    return a.width() == b.width() && a.height() == b.height() &&
           std::memcmp(a.data(), b.data(), a.pixels() * sizeof(float)) == 0;
}

TEST_F(ReferenceCache, ThePictureComesBackBitByBit) {
    EXPECT_FALSE(is_kept());
    keep();
    const auto kept = kept_reference(cache(), kKey);
    ASSERT_TRUE(kept);
    const ReferencePicture expected = picture();
    EXPECT_TRUE(same_bits(kept->mean, expected.mean));
    EXPECT_TRUE(same_bits(kept->dark, expected.dark));
    EXPECT_EQ(kept->frames, 8);
    EXPECT_EQ(kept->seconds, 12.5);
    EXPECT_EQ(kept->standard_error.p99, 1.5);
    EXPECT_EQ(kept->standard_error.rms, 0.25);
    EXPECT_EQ(kept->standard_error.within_half_fraction, 0.75);
    EXPECT_EQ(kept->standard_error.lit_px, 30u);
}

TEST_F(ReferenceCache, WhatIsNotWholeIsNotTaken) {
    keep();
    const auto whole = std::filesystem::file_size(file());
    for (const std::uintmax_t size :
         {whole - 1, whole / 2, std::uintmax_t{79}, std::uintmax_t{0}, whole + 4}) {
        std::filesystem::resize_file(file(), size);
        EXPECT_FALSE(is_kept()) << size;
    }
    keep();  // made anew
    EXPECT_TRUE(is_kept());
}

TEST_F(ReferenceCache, NoByteOfItMayDiffer) {
    keep();
    const auto size = static_cast<std::streamoff>(std::filesystem::file_size(file()));
    for (std::streamoff at = 0; at < size; at += 3) {
        keep();
        char byte = 0;
        std::ifstream(file(), std::ios::binary).seekg(at).get(byte);
        put(at, static_cast<char>(byte ^ 0x10));
        EXPECT_FALSE(is_kept()) << at;
    }
}

TEST_F(ReferenceCache, AnotherKeysFileIsNotTaken) {
    keep();
    const std::string other = kKey + "more\n";
    EXPECT_NE(reference_name(other), reference_name(kKey));
    EXPECT_FALSE(kept_reference(cache(), other));
    std::filesystem::rename(file(), folder_ / reference_name(other));
    EXPECT_FALSE(kept_reference(cache(), other));
}

TEST_F(ReferenceCache, AnotherVersionsFileIsNotTaken) {
    keep();
    put(8, static_cast<char>(kReferenceVersion + 1));  // behind the eight bytes that say what it is
    EXPECT_FALSE(is_kept());
    put(8, static_cast<char>(kReferenceVersion));
    EXPECT_TRUE(is_kept());
}

TEST_F(ReferenceCache, ImagesBesideItComeBackAndAnotherNumberOfThemIsNotTaken) {
    const ReferencePicture given = picture();
    const std::array<const ElectronImage*, 1> beside = {&given.dark};
    keep_reference(cache(), kKey, given, beside);
    ElectronImage found, more;
    const std::array<ElectronImage*, 2> both = {&found, &more};
    ASSERT_TRUE(kept_reference(cache(), kKey, std::span(both).first(1)));
    EXPECT_TRUE(same_bits(found, given.dark));
    EXPECT_FALSE(kept_reference(cache(), kKey, both));
    EXPECT_FALSE(is_kept());
}

TEST_F(ReferenceCache, AFolderThatCannotBeIsNoFailure) {
    const Cache nowhere(write("plain", "no folder") / "cache");
    keep_reference(nowhere, kKey, picture());
    EXPECT_FALSE(kept_reference(nowhere, kKey));
}

ScenarioConfig minimal_with(const std::vector<std::string>& overrides = {}) {
    const ScenarioSource source{
        std::filesystem::path(HILCAM_SOURCE_DIR) / "tests/protocol/minimal_scenario.yaml", {}};
    return source.load(overrides);
}

TEST(ReferenceKey, HasAllThatThePictureDependsOn) {
    const Pose here{{1, 2, 3}, {}};
    const ReferenceLimits limits;
    const std::string key = reference_key(minimal_with(), here, limits);
    EXPECT_EQ(reference_key(minimal_with(), here, limits), key);
    for (const char* change :
         {"quality.max_depth=7", "quality.lod_error_px=0.5", "camera.exposure_ms=0.16", "seed=4",
          "objects.0.generate.triangles=20001", "spectrum_edges_um=[0.4, 0.95]"})
        EXPECT_NE(reference_key(minimal_with({change}), here, limits), key) << change;
    EXPECT_NE(reference_key(minimal_with(), {{1, 2, 3.0000001}, {}}, limits), key);
    EXPECT_NE(reference_key(minimal_with(), {{1, 2, 3}, from_rotation_vector({0, 0, 1e-9})}, limits), key);
    EXPECT_NE(reference_key(minimal_with(), here, {.max_frames = 8}), key);
    EXPECT_NE(reference_key(minimal_with(), here, {.standard_error_sigma = 0.1}), key);
}

TEST(ReferenceKey, HasNothingElse) {
    const Pose here{{1, 2, 3}, {}};
    const std::string key = reference_key(minimal_with(), here, {});
    for (const char* change : {"threads=1", "commands.udp={address: 127.0.0.1, port: 5011}"})
        EXPECT_EQ(reference_key(minimal_with({change}), here, {}), key) << change;
    // A key of the quality at its default: one that is new makes no reference another.
    EXPECT_EQ(key.find("quality.watertight"), std::string::npos);
    EXPECT_NE(reference_key(minimal_with({"quality.watertight=false"}), here, {})
                  .find("quality.watertight = false"),
              std::string::npos);
}

}  // namespace
}  // namespace hilcam
