// Folders of frames are read as series, and every mistake in them is named in one line.

#include "emulator/clone/frame_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>

#include "emulator/clone/clone_measurement.h"
#include "io/images/image_file.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr int kSide = 48;

CameraModel like() {
    CameraModel c;
    c.name = "like";
    c.width_px = c.height_px = kSide;
    c.gain_dn_e = 0.3, c.bits = 12, c.full_well_e = 1e4;
    return c;
}

// A plain made-up camera: 0.3 DN/e-, 6 e- of noise, 64 DN of black, 100 e-/s of dark current.
class FrameFolder : public testing::Test {
  protected:
    FrameFolder() : folder_(fs::temp_directory_path() / ("hilcam_frames_" + std::to_string(getpid()))) {
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    ~FrameFolder() override { fs::remove_all(folder_); }

    DnImage frame(double charge_e, double exposure_s, int side = kSide) {
        DnImage out(side, side);
        std::normal_distribution<double> normal;
        for (std::uint16_t& dn : out.all()) {
            const double mean = charge_e + 100 * exposure_s;
            const double q = std::min(mean + std::sqrt(mean) * normal(engine_), 1e4) + 6 * normal(engine_);
            dn = static_cast<std::uint16_t>(std::clamp(std::floor(0.3 * q + 64.5), 0.0, 4095.0));
        }
        return out;
    }
    using Change = std::function<void(DnImage&)>;
    void series(const std::string& name, double charge_e, double exposure_s, int frames = 8,
                const Change& change = {}) {
        fs::create_directories(folder_ / name);
        for (int i = 0; i < frames; ++i) {
            DnImage image = frame(charge_e, exposure_s);
            if (change) change(image);
            write_numbers(folder_ / name / (std::to_string(i) + ".png"), image);
        }
    }
    void usual(const Change& change = {}) {
        for (const double ms : {1.0, 10.0, 100.0})
            series("dark_" + std::to_string(static_cast<int>(ms)) + "ms_25c", 0, 1e-3 * ms, 8, change);
        for (const int ms : {1, 3, 5, 7, 9})
            series("flat_" + std::to_string(ms) + "ms_25c", 1000.0 * ms, 1e-3 * ms, 4, change);
    }
    CloneMeasurement measured() {
        return measure_clone(read_frame_folder(folder_, {}, like()), like(), [](double) {});
    }
    std::string message() {
        try {
            measured();
        } catch (const InputError& error) {
            const std::string what = error.what();
            EXPECT_EQ(what.find('\n'), std::string::npos);
            return what;
        }
        return "accepted";
    }
    void manifest(const std::string& text) { std::ofstream(folder_ / "frames.yaml") << text; }

    fs::path folder_;
    std::mt19937_64 engine_{4};
};

TEST_F(FrameFolder, NamesMakeSeries) {
    usual();
    const FrameSet set = read_frame_folder(folder_, {}, like());
    ASSERT_EQ(set.series.size(), 8u);
    EXPECT_EQ(set.width, kSide);
    EXPECT_EQ(set.series[0].kind, SeriesKind::kDark);
    EXPECT_EQ(set.series[0].frames, 8u);
    EXPECT_DOUBLE_EQ(set.series[0].exposure_s, 0.001);
    EXPECT_EQ(*set.series[0].temperature_c, 25);
    const CloneMeasurement m = measured();
    EXPECT_NEAR(m.gain_dn_e.value, 0.3, 5 * m.gain_dn_e.uncertainty);
    EXPECT_LT(m.gain_dn_e.uncertainty, 0.01);
    EXPECT_NEAR(m.read_noise_e.value, 6, 5 * m.read_noise_e.uncertainty);
    // Five levels are too few for the bend, and none is beyond the full well.
    EXPECT_FALSE(m.nonlinearity);
    EXPECT_FALSE(m.full_well_e);
    EXPECT_GT(m.full_well_at_least_e, 8500);
}

TEST_F(FrameFolder, AManifestMakesSeriesOfRawFiles) {
    const auto raw = [&](const std::string& name, double charge_e, double exposure_s) {
        const DnImage image = frame(charge_e, exposure_s);
        std::ofstream out(folder_ / name, std::ios::binary);
        out << "head";
        for (const std::uint16_t dn : image.all())
            out << static_cast<char>(dn << 4 >> 8) << static_cast<char>(dn << 4);
    };
    for (int i = 0; i < 8; ++i) {
        raw("a" + std::to_string(i) + ".raw", 0, 0.001);
        raw("b" + std::to_string(i) + ".raw", 4000, 0.001);
        raw("c" + std::to_string(i) + ".raw", 8000, 0.001);
    }
    const std::string yaml =
        "header_bytes: 4\nbyte_order: big\nshift_bits: 4\nseries:\n"
        "  - {kind: dark, exposure_ms: 1, files: \"a?.raw\"}\n"
        "  - {kind: flat, exposure_ms: 1, light: 4, files: [\"b*.raw\"]}\n"
        "  - {kind: flat, exposure_ms: 1, light: 8, files: [\"c*.raw\"]}\n";
    manifest(yaml);
    const CloneMeasurement m = measured();
    EXPECT_NEAR(m.gain_dn_e.value, 0.3, 5 * m.gain_dn_e.uncertainty);
    EXPECT_TRUE(m.light_known);
    EXPECT_FALSE(m.dark_current_e_s);
    manifest("header_bytes: 5\n" + yaml.substr(yaml.find("byte_order")));
    EXPECT_THAT(message(),
                HasSubstr("a0.raw: found 4612 bytes; accepted: 4613, for 48 x 48 pixels of 2 bytes"));
    manifest("header_bytes: 4\nshift_bits: 4\n" + yaml.substr(yaml.find("series")));
    EXPECT_THAT(message(), HasSubstr("byte_order: big"));
}

TEST_F(FrameFolder, WhatCannotBeReadIsNamed) {
    EXPECT_THAT(message(),
                HasSubstr("found no frames whose names say what they are; accepted: darks of several"));
    manifest("series: 12\n");
    EXPECT_THAT(message(), HasSubstr("frames.yaml:1:9: series: "));
    manifest("series:\n  - {kind: bright, exposure_ms: 1, files: x}\n");
    EXPECT_THAT(message(),
                HasSubstr("frames.yaml:2:12: series.0.kind: found 'bright'; accepted: dark | flat"));
    manifest("series:\n  - {kind: dark, exposure_ms: 1, files: x*.png}\n");
    EXPECT_THAT(message(),
                HasSubstr("series.0.files: found no file like 'x*.png'; accepted: names in that folder"));
    manifest("bits: 12\n");
    EXPECT_THAT(message(),
                HasSubstr("frames.yaml: found no series; accepted: series: with kind, exposure_ms"));
    fs::remove(folder_ / "frames.yaml");
    usual();
    std::ofstream(folder_ / "dark_1ms_25c/3.png") << "no picture";
    EXPECT_THAT(message(), HasSubstr("dark_1ms_25c/3.png"));
    fs::remove_all(folder_);
    EXPECT_THAT(message(), HasSubstr("is no folder; accepted: a folder with darks"));
}

TEST_F(FrameFolder, TwoSizes) {
    usual();
    write_numbers(folder_ / "flat_3ms_25c/1.png", frame(3000, 0.003, 32));
    EXPECT_THAT(message(),
                HasSubstr("flat_3ms_25c/1.png: found 32 x 32 pixels; accepted: 48 x 48, as the first"));
}

TEST_F(FrameFolder, SaturatedFlats) {
    for (const char* ms : {"1", "10"}) series(std::string("dark_") + ms + "ms", 0, 0.001);
    for (const char* ms : {"1", "2", "3"}) series(std::string("flat_") + ms + "ms", 20000, 0.001, 4);
    // This camera's well fills before its converter: the plateau has little noise.
    series("flat_0.5ms", 5000, 0.0005, 4);
    EXPECT_THAT(message(),
                HasSubstr("found 3 of 4 flats saturated; accepted: at least two below saturation"));
    for (const char* ms : {"0.5", "1", "2", "3"})
        series(std::string("flat_") + ms + "ms", 0, 0.001, 4, [](DnImage& image) {
            for (std::uint16_t& dn : image.all()) dn = 4095;
        });
    EXPECT_THAT(message(), HasSubstr("found saturated flats only"));
}

TEST_F(FrameFolder, DarksWithLight) {
    usual();
    series("dark_50ms_25c", 800, 0.05);
    EXPECT_THAT(message(), HasSubstr("dark_50ms_25c: found darks with a mean of"));
    EXPECT_THAT(message(),
                HasSubstr("accepted: frames without any light, whose mean rises in a straight line"));
    fs::remove_all(folder_ / "dark_50ms_25c");
    // All of them, as behind a cap that leaks.
    for (const int ms : {1, 10, 100}) series("dark_" + std::to_string(ms) + "ms_25c", 50.0 * ms, 1e-3 * ms);
    for (const int ms : {1, 3, 5, 7, 9})
        series("flat_" + std::to_string(ms) + "ms_25c", 100.0 * ms, 1e-3 * ms, 4);
    EXPECT_THAT(message(), HasSubstr("where the faintest flat rises by"));
}

TEST_F(FrameFolder, PicturesOfEightBits) {
    usual([](DnImage& image) {
        for (std::uint16_t& dn : image.all()) dn = static_cast<std::uint16_t>(dn >> 4);
    });
    EXPECT_THAT(message(), HasSubstr("accepted: all 12 bits of the camera; these look like 8-bit pictures"));
}

TEST_F(FrameFolder, ShiftedNumbers) {
    usual([](DnImage& image) {
        for (std::uint16_t& dn : image.all()) dn = static_cast<std::uint16_t>(dn << 4);
    });
    EXPECT_THAT(message(),
                HasSubstr("all multiples of 16; accepted: 0 to 4095 of 12 bits; numbers that are shifted "
                          "up need shift_bits: 4"));
}

TEST_F(FrameFolder, SwappedBytes) {
    usual([](DnImage& image) {
        for (std::uint16_t& dn : image.all()) dn = static_cast<std::uint16_t>(dn << 8 | dn >> 8);
    });
    EXPECT_THAT(message(), HasSubstr("smoother with their bytes exchanged; accepted: 0 to 4095 of 12 bits"));
}

TEST_F(FrameFolder, TooFewFramesAndOneLevel) {
    series("dark_1ms", 0, 0.001, 3);
    series("flat_1ms", 1000, 0.001, 4);
    series("flat_2ms", 2000, 0.002, 4);
    EXPECT_THAT(message(), HasSubstr("dark_1ms: found 3 frames; accepted: at least 8 of each dark"));
    series("dark_1ms", 0, 0.001);
    fs::remove_all(folder_ / "flat_2ms");
    EXPECT_THAT(message(), HasSubstr("found 1 series of flats; accepted: flats of at least two levels"));
    fs::remove_all(folder_ / "dark_1ms");
    EXPECT_THAT(message(), HasSubstr("found no dark frames; accepted: at least one series"));
    series("dark_1ms", 0, 0.001);
    series("flat_2ms_6db", 2000, 0.002, 4);
    EXPECT_THAT(message(),
                HasSubstr("accepted: one gain; put the frames of each gain into a folder of their own"));
}

TEST_F(FrameFolder, ABlackLevelThatCutsTheNoise) {
    usual([](DnImage& image) {
        for (std::uint16_t& dn : image.all()) dn = static_cast<std::uint16_t>(std::max(0, dn - 66));
    });
    EXPECT_THAT(message(), HasSubstr("of the numbers 0; accepted: a black level that is above the noise"));
}

}  // namespace
}  // namespace hilcam
