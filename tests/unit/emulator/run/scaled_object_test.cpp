// Objects in several sizes: one set of tables serves them all, and their pictures show it.

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>

#include "emulator/run/still_camera.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

// A wall that stands on a plate in the sunlight, seen by cached light; more than 2000 triangles, so that it has levels of
// detail. Its cache folder is empty.
class ScaledObject : public FilesTest {
  protected:
    static constexpr int kSide = 40;

    void SetUp() override {
        FilesTest::SetUp();
        if (const char* cache = std::getenv("HILCAM_CACHE")) before_ = cache;
        setenv("HILCAM_CACHE", (folder_ / "cache").c_str(), 1);
        std::string mesh;
        add_sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1, mesh);
        add_sheet({-1, 0.5f, 0}, {2, 0, 0}, {0, 0, 1}, 1 + (kSide + 1) * (kSide + 1), mesh);
        write("corner.obj", mesh);
    }
    void TearDown() override {
        before_.empty() ? unsetenv("HILCAM_CACHE") : setenv("HILCAM_CACHE", before_.c_str(), 1);
        FilesTest::TearDown();
    }

    ScenarioConfig scenario(double scale, double size_of_all = 1, const std::string& more = "") {
        const auto text = [](double x) { return std::to_string(x); };
        const double far_m = size_of_all;
        const auto file = write(
            "scenario.yaml",
            "time_utc: 2026-12-21T00:00:00Z\n"
            "camera: {width_px: 64, height_px: 64, pitch_um: 10, focal_length_mm: 1.2, f_number: 8, "
            "transmission: 0.01,\n"
            "  quantum_efficiency: 0.5, full_well_e: 20000, gain_dn_e: 0.2, bits: 12, exposure_ms: 20}\n"
            "camera_pose: {position_m: [" +
                text(1 * far_m) + ", " + text(-3 * far_m) + ", " + text(2 * far_m) +
                "], attitude: look_at, look_at_m: [0, 0, 0], up: [0, 0, 1]}\n"
                "objects:\n  - {name: corner, mesh: corner.obj, scale: " +
                text(scale) + "}\n" + more +
                "earth: {visible: false}\nmoon: {visible: false}\nspectrum_edges_um: [0.5, 0.7]\n"
                "quality: {path_model: cached, probes: 2000, lod_error_px: 0.5}\n");
        return load_scenario(file, {});
    }
    static std::vector<double> electrons(const ScenarioConfig& s) {
        StillCamera camera(s);
        camera.render({1, 1});
        const auto all = camera.expose().all();
        return {all.begin(), all.end()};
    }
    std::size_t files(const std::string& prefix) const {
        std::size_t count = 0;
        for (const auto& entry : std::filesystem::directory_iterator(folder_ / "cache"))
            count += entry.path().filename().string().starts_with(prefix);
        return count;
    }

  private:
    std::string before_;

    // A square of small squares, with a ripple that levels flatten.
    static void add_sheet(Vec3f corner, Vec3f u, Vec3f v, int first, std::string& mesh) {
        const Vec3f up = normalized(cross(u, v));
        for (int y = 0; y <= kSide; ++y)
            for (int x = 0; x <= kSide; ++x) {
                const float ripple = 1e-3f * std::sin(static_cast<float>(x * 3 + y * 5));
                const Vec3f at = corner + (static_cast<float>(x) / kSide) * u +
                                 (static_cast<float>(y) / kSide) * v + ripple * up;
                mesh += "v " + std::to_string(at.x) + " " + std::to_string(at.y) + " " +
                        std::to_string(at.z) + "\n";
            }
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                const auto corner_of = [&](int dx, int dy) {
                    return " " + std::to_string(first + (y + dy) * (kSide + 1) + x + dx);
                };
                mesh += "f" + corner_of(0, 0) + corner_of(1, 0) + corner_of(1, 1) + "\nf" + corner_of(0, 0) +
                        corner_of(1, 1) + corner_of(0, 1) + "\n";
            }
    }
};

double sum_of(const std::vector<double>& values) {
    double sum = 0;
    for (const double v : values) sum += v;
    return sum;
}

// Seen from as many times as far it is the same picture: places are rounded otherwise, which moves a sample over an edge
// here and there and nothing else.
TEST_F(ScaledObject, SeenFromFartherItIsTheSamePicture) {
    const std::vector<double> unscaled = electrons(scenario(1));
    ASSERT_GT(sum_of(unscaled), 1e5);
    for (const double scale : {4.0, 0.3, 37.0}) {
        const std::vector<double> scaled = electrons(scenario(scale, scale));
        double off = 0;
        for (std::size_t i = 0; i < scaled.size(); ++i) off += std::abs(scaled[i] - unscaled[i]);
        EXPECT_LT(off / sum_of(unscaled), 1e-3) << scale;
    }
    EXPECT_EQ(files("transfer_"), 1u);
    EXPECT_EQ(files("levels_"), 1u);
}

// Without the light between surfaces, or with that of another size, it would be another picture.
TEST_F(ScaledObject, ItsLightIsThatOfItsSize) {
    const std::vector<double> unscaled = electrons(scenario(1));
    ScenarioConfig direct = scenario(1);
    direct.quality.render.path_model = "direct";
    const std::vector<double> without = electrons(direct);
    EXPECT_GT(sum_of(unscaled) / sum_of(without), 1.02);
}

// One of two objects grows: shares of places are by rough sizes, so that no size has tables of its own.
TEST_F(ScaledObject, OneOfSeveralHasItsTableInAllSizes) {
    const std::string other = "  - {name: other, mesh: corner.obj, pose: {position_m: [5, 5, 0]}}\n";
    for (const double scale : {0.8, 0.9, 1.0, 1.1, 1.3}) StillCamera camera(scenario(scale, 1, other));
    EXPECT_EQ(files("transfer_"), 1u);
    EXPECT_EQ(files("levels_"), 1u);
}

// What is used once finds what there is, and leaves nothing.
TEST_F(ScaledObject, WhatIsUsedOnceIsNotKept) {
    ScenarioConfig once = scenario(1);
    once.is_used_once = true;
    { StillCamera camera(once); }
    EXPECT_FALSE(std::filesystem::exists(folder_ / "cache"));
}

// A mesh ten times as large, in micrometres: numbers of another size are rounded otherwise, so that some places of kept
// light are others where the ripple lies on the faces of their cubes; the light is the same to two hundredths.
TEST_F(ScaledObject, AMeshInOtherUnitsIsTheSameObject) {
    const std::vector<double> unscaled = electrons(scenario(1));
    std::ifstream in(folder_ / "corner.obj");
    std::string mesh;
    for (std::string word; in >> word;) {
        if (word != "v") {
            std::string rest;
            std::getline(in, rest);
            mesh += word + rest + "\n";
            continue;
        }
        double x = 0, y = 0, z = 0;
        in >> x >> y >> z;
        mesh += "v " + std::to_string(1e7 * x) + " " + std::to_string(1e7 * y) + " " +
                std::to_string(1e7 * z) + "\n";
    }
    write("corner.obj", mesh);
    const std::vector<double> scaled = electrons(scenario(1e-6, 10));
    double off = 0;
    for (std::size_t i = 0; i < scaled.size(); ++i) off += std::abs(scaled[i] - unscaled[i]);
    EXPECT_LT(off / sum_of(unscaled), 0.02);
    EXPECT_EQ(files("transfer_"), 2u);
}

}  // namespace
}  // namespace hilcam
