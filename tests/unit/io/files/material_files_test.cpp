// Files that describe how surfaces and air look.

#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "io/cache/cache.h"
#include "io/cache/level_cache.h"
#include "io/cache/transfer_cache.h"
#include "io/config/config_yaml.h"
#include "io/files/brdf_file.h"
#include "io/files/height_map_file.h"
#include "render/scene/brdf.h"
#include "render/scene/packed_normal.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

const SpectralGrid kThreeBins({0.5, 0.6, 0.7});

class MaterialFiles : public FilesTest {
  protected:
    std::string brdf_error(const std::filesystem::path& file) {
        return error_of([&] { read_brdf(file, kThreeBins); });
    }
};

const char* const kHeader = "theta_i_deg,phi_deg,theta_o_deg,wavelength_um,brdf_sr\n";

// Lambert of 0.3 at 0.5 um and 0.6 at 0.7 um.
std::string lambert_table(double last_theta = 90) {
    std::string text = kHeader;
    for (const double ti : {0.0, 45.0, last_theta})
        for (const double phi : {0.0, 180.0})
            for (const double to : {0.0, 45.0, last_theta})
                for (const double um : {0.5, 0.7})
                    text += std::to_string(ti) + "," + std::to_string(phi) + "," + std::to_string(to) + "," +
                            std::to_string(um) + "," + std::to_string((um < 0.6 ? 0.3 : 0.6) / kPi) + "\n";
    return text;
}

TEST_F(MaterialFiles, ATableComesBackOnTheBins) {
    const BrdfTable table = read_brdf(write("t.csv", lambert_table()), kThreeBins);
    const Spectrum f = table.value(0.9f, 0.5f, 0.4f);
    EXPECT_NEAR(f[0], 0.375 / kPi, 1e-5);
    EXPECT_NEAR(f[1], 0.525 / kPi, 1e-5);
}

TEST_F(MaterialFiles, WhatATableLacksIsNamed) {
    EXPECT_THAT(brdf_error(folder_ / "none.csv"), HasSubstr("none.csv: no such file"));
    EXPECT_THAT(brdf_error(write("a.txt", "")), HasSubstr("accepted: a BRDF in .csv, or MERL's .binary"));
    EXPECT_THAT(brdf_error(write("b.csv", "theta,phi\n")), HasSubstr("b.csv:1: found 'theta,phi'"));
    EXPECT_THAT(brdf_error(write("c.csv", std::string(kHeader) + "0,0,0,0.5\n")),
                HasSubstr("c.csv:2: found '0,0,0,0.5'"));
    EXPECT_THAT(brdf_error(write("d.csv", std::string(kHeader) + "0,0,0,0.5,-1\n")), HasSubstr("d.csv:2:"));
    EXPECT_THAT(brdf_error(write("e.csv", lambert_table(80))),
                HasSubstr("theta_i_deg reaches from 0 to 80; needed: 0 to 90, or a line '# hold'"));
    EXPECT_THAT(brdf_error(write("f.csv", "# hold\n" + lambert_table(80))), HasSubstr("no error"));
    std::string gap = lambert_table();
    gap.erase(gap.rfind('\n', gap.size() - 2) + 1);
    EXPECT_THAT(brdf_error(write("g.csv", gap)),
                HasSubstr("has no value at theta_i_deg 90, phi_deg 180, theta_o_deg 90, wavelength_um 0.7"));
    std::string narrow = lambert_table();
    for (std::size_t at; (at = narrow.find(",0.700000,")) != std::string::npos;)
        narrow.replace(at, 10, ",0.650000,");
    EXPECT_THAT(brdf_error(write("h.csv", narrow)), HasSubstr("reaches from 0.500 to 0.650 um"));
}

// A file of MERL's layout filled from a GGX metal gives that metal back.
TEST_F(MaterialFiles, MerlsLayoutIsReadAsItIsMeant) {
    MaterialConfig config;
    config.model = kModel<brdf::Metal>;
    config.roughness = 0.7;
    const Material m = make_material(config, kThreeBins);
    const Bsdf at{&m, m.ggx_alpha, m.base, m.highlight};
    std::vector<double> values;
    for (int th = 0; th < 90; ++th)
        for (int td = 0; td < 90; ++td)
            for (int pd = 0; pd < 180; ++pd) {
                // n = cos(th) h - sin(th) x, the light at (td, pd) about h.
                const double a = 0.5 * kPi * th * th / 8100.0, d = td * kDegree_rad, p = pd * kDegree_rad;
                const Vec3d n{-std::sin(a), 0, std::cos(a)};
                const Vec3d light{std::sin(d) * std::cos(p), std::sin(d) * std::sin(p), std::cos(d)};
                const Vec3d view{-light.x, -light.y, light.z};
                values.push_back(
                    brdf_value(at, {static_cast<float>(dot(n, view)), static_cast<float>(dot(n, light)),
                                    static_cast<float>(dot(light, view))})[0]);
            }
    std::string bytes(12, '\0');
    const std::int32_t counts[3] = {90, 90, 180};
    std::memcpy(bytes.data(), counts, 12);
    for (const double scale : {1500.0, 1500 / 1.15, 1500 / 1.66})
        for (const double value : values) {
            const double scaled = value * scale;
            bytes.append(reinterpret_cast<const char*>(&scaled), sizeof scaled);
        }
    const BrdfTable table = read_brdf(write("m.binary", bytes), kThreeBins);
    for (const Cosines c :
         {Cosines{0.8f, 0.7f, 0.3f}, Cosines{0.6f, 0.9f, 0.5f}, Cosines{0.95f, 0.95f, 0.9f}})
        EXPECT_NEAR(table.value(c.no, c.ni, c.io)[0] / brdf_value(at, c)[0], 1, 0.02);
    EXPECT_THAT(brdf_error(write("cut.binary", bytes.substr(0, 1000))),
                HasSubstr("has 1000 bytes; a MERL BRDF has 34992012"));
    bytes[0] = 80;
    EXPECT_THAT(brdf_error(write("other.binary", bytes)), HasSubstr("begins with 80 90 180"));
}

// Every material of the library loads, covers 0.35 to 1.05 um, names its source, and gives back no more than
// it gets.
TEST(MaterialLibrary, EveryFileLoadsAndKeepsEnergy) {
    const SpectralGrid grid({0.35, 0.45, 0.55, 0.65, 0.75, 0.85, 0.95, 1.05});
    int count = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(HILCAM_SOURCE_DIR) + "/configs/materials")) {
        if (entry.path().filename() == "spacecraft.yaml") continue;
        MaterialConfig config;
        read_config(entry.path(), section_of(config), {});
        EXPECT_GT(config.source.size(), 30u) << entry.path();
        const Material m = make_material(config, grid);
        const Bsdf at{&m, m.ggx_alpha, m.base, m.highlight};
        for (int b = 0; b < grid.size(); ++b) {
            const float largest_part = std::max(m.base[b], m.highlight[b]);
            EXPECT_GE(largest_part, 0) << entry.path();
            EXPECT_LE(config.model == kModel<brdf::LommelSeeliger> ? largest_part / 2 : largest_part, 1)
                << entry.path();
        }
        EXPECT_TRUE(std::isfinite(brdf_value(at, {0.7f, 0.6f, 0.5f})[0])) << entry.path();
        ++count;
    }
    EXPECT_GE(count, 20);
}

TEST_F(MaterialFiles, HeightsAreReadAsTheyAreWritten) {
    std::string bytes;
    for (const std::int16_t h : {std::int16_t{0}, std::int16_t{-300}, std::int16_t{1000}, std::int16_t{7},
                                 std::int16_t{8}, std::int16_t{9}})
        bytes.append(reinterpret_cast<const char*>(&h), 2);
    HeightMapConfig config;
    config.file = write("h.raw", bytes);
    config.columns = 3, config.rows = 2, config.scale = 0.5, config.offset_m = 10;
    const auto map = open_height_map(config);
    EXPECT_EQ(map->height_m(1, 0), -140);
    EXPECT_EQ(map->height_m(2, 0), 510);
    EXPECT_EQ(map->height_m(0, 1), 13.5f);
    const auto error = [&] { return error_of([&] { open_height_map(config); }); };
    config.rows = 3;
    EXPECT_THAT(error(), HasSubstr("h.raw: has 12 bytes; 3 columns of 3 rows of 2 bytes make 18"));
    config.file = folder_ / "none.raw";
    EXPECT_THAT(error(), HasSubstr("none.raw: no such file"));
    // Other formats have heights inside, and say how they come out; a raw file of that length does not begin
    // like them.
    using namespace std::string_literals;
    for (const std::string& magic : {"II*\0"s, "MM\0*"s, "II+\0"s, "MM\0+"s, "PDS_VERSION_ID"s}) {
        config.file = write("h.raw", magic + std::string(18 - magic.size(), 'x'));
        EXPECT_THAT(error(), HasSubstr("'gdal_translate -of ENVI")) << magic;
    }
    // A float that is no number is ground at height 0.
    const float values[4] = {1.5f, std::nanf(""), std::numeric_limits<float>::infinity(), -2};
    config.file = write("f.raw", std::string(reinterpret_cast<const char*>(values), sizeof values));
    config.columns = config.rows = 2, config.scale = 1, config.offset_m = 0,
    config.format = HeightFormat::kFloat32;
    const auto floats = open_height_map(config);
    EXPECT_EQ(floats->height_m(0, 0), 1.5f);
    EXPECT_EQ(floats->height_m(1, 0), 0);
    EXPECT_EQ(floats->height_m(0, 1), 0);
    EXPECT_EQ(floats->height_m(1, 1), -2);
}

TEST_F(MaterialFiles, LevelsComeBackFromDiskAndABrokenFileIsMadeAnew) {
    // A bumpy sheet of 20,000 triangles.
    Mesh mesh;
    mesh.surfaces.resize(1);
    constexpr std::uint32_t kSide = 101;
    for (std::uint32_t y = 0; y < kSide; ++y)
        for (std::uint32_t x = 0; x < kSide; ++x)
            mesh.vertices_m.push_back({0.1f * static_cast<float>(x), 0.1f * static_cast<float>(y),
                                       0.001f * std::sin(static_cast<float>(x * y))});
    for (std::uint32_t y = 0; y + 1 < kSide; ++y)
        for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
            const std::uint32_t a = y * kSide + x;
            mesh.triangles.push_back({a, a + 1, a + kSide});
            mesh.triangles.push_back({a + 1, a + kSide + 1, a + kSide});
        }
    mesh.surface_of_triangle.resize(mesh.triangles.size());
    std::vector<std::string> log;
    const Cache cache(
        CacheSettings{folder_, 1'000'000'000, true, [&](const std::string& l) { log.push_back(l); }});
    const std::vector<MeshLevel> made = cached_levels(mesh, cache);
    ASSERT_FALSE(made.empty());
    EXPECT_LT(made.back().mesh.triangles.size(), mesh.triangles.size() / 4);
    // Borders stay: a square of 10 m. No vertex is new, so none is farther from the sheet than its bumps.
    Vec3f most{};
    for (const Vec3f& v : made.back().mesh.vertices_m)
        most = {std::max(most.x, v.x), std::max(most.y, v.y), 0};
    EXPECT_NEAR(most.x, 10, 1e-4);
    EXPECT_NEAR(most.y, 10, 1e-4);
    const auto file = std::filesystem::directory_iterator(folder_)->path();
    EXPECT_EQ(cached_levels(mesh, cache).back().mesh.triangles, made.back().mesh.triangles);
    EXPECT_TRUE(log.empty()) << log.front();
    const auto size = std::filesystem::file_size(file);
    for (const std::uintmax_t cut : {size / 2, std::uintmax_t{30}, std::uintmax_t{0}}) {
        std::filesystem::resize_file(file, cut);
        EXPECT_EQ(cached_levels(mesh, cache).back().mesh.triangles, made.back().mesh.triangles);
        EXPECT_EQ(std::filesystem::file_size(file), size);
    }
}

// The bytes of a table, as a file would have them.
std::string bytes_of(const TransferTable& table, const std::filesystem::path& folder) {
    Cache(folder).write("table", [&](CacheWriter& out) { TransferTable::list(table, out); });
    std::ifstream in(folder / "table", std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// Two walls of a corner.
Mesh corner_walls() {
    Mesh mesh;
    mesh.surfaces.resize(1);
    mesh.vertices_m = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {1, -1, 2}, {1, 1, 2}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
    mesh.surface_of_triangle.resize(4);
    return mesh;
}

TEST_F(MaterialFiles, TransferTablesComeBackFromDiskAndABrokenFileIsMadeAnew) {
    const Mesh mesh = corner_walls();
    const std::vector<std::uint8_t> glass(1);
    const TableSource source{mesh, glass, {60, 1000, false}};
    const std::filesystem::path folder = folder_ / "cache";
    const Cache cache(folder);
    const auto table = [&] { return bytes_of(*cached_transfer(source, cache), folder_); };
    const std::string made = table();
    EXPECT_GT(made.size(), 10'000u);
    const auto file = std::filesystem::directory_iterator(folder)->path();
    EXPECT_TRUE(find_transfer(source, cache));
    EXPECT_EQ(table(), made);
    const auto size = std::filesystem::file_size(file);
    for (const std::uintmax_t cut : {size - 1, size / 2, std::uintmax_t{40}, std::uintmax_t{0}}) {
        std::filesystem::resize_file(file, cut);
        EXPECT_EQ(table(), made);
        EXPECT_EQ(std::filesystem::file_size(file), size);
    }
    // Other bytes, anywhere: it is made anew.
    for (std::uintmax_t at = 0; at < size; at += size / 97) {
        {
            std::fstream broken(file, std::ios::in | std::ios::out | std::ios::binary);
            broken.seekg(static_cast<std::streamoff>(at));
            const auto byte = static_cast<char>(broken.get() ^ 4);
            broken.seekp(static_cast<std::streamoff>(at)).put(byte);
        }
        EXPECT_FALSE(find_transfer(source, cache)) << at;
        EXPECT_EQ(table(), made);
    }
    // Other settings have files of their own.
    cached_transfer({mesh, glass, {16, 1000, false}}, cache);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 2);
}

// What a place meets does not change with the size: the table of a mesh, made larger, is that of the larger mesh.
TEST_F(MaterialFiles, OneTransferTableServesAMeshInAllSizes) {
    const Mesh mesh = corner_walls();
    const std::vector<std::uint8_t> glass(1);
    const TransferSettings settings{60, 1000, false};
    const std::filesystem::path folder = folder_ / "cache";
    const Cache cache(folder);
    for (const float scale : {1.0f, 4.0f, 0.3f, 1e-3f}) {
        const auto scaled = cached_transfer({mesh, glass, settings, scale}, cache);
        Mesh large = mesh;
        for (Vec3f& v : large.vertices_m) v = scale * v;
        const TransferTable own(large, glass, settings);
        ASSERT_EQ(scaled->size(), own.size()) << scale;
        EXPECT_EQ(scaled->entries(), own.entries()) << scale;
        EXPECT_NEAR(scaled->probes().cube_m(), own.probes().cube_m(), 1e-5f * own.probes().cube_m()) << scale;
        for (std::size_t n = 0; n < own.size(); ++n)
            for (std::size_t p = 0; p < SurfaceProbe::kPoints; ++p) {
                const Vec3f off =
                    scaled->probes().probes()[n].point_m[p] - own.probes().probes()[n].point_m[p];
                EXPECT_LT(length(off), 1e-5f * scale) << scale << ", node " << n;
            }
        // Each finds its own places.
        std::size_t found = 0;
        for (const SurfaceProbe& probe : own.probes().probes()) {
            ProbeWeights about;
            found += scaled->probes().find(probe.point_m[0],
                                           {unpack_normal(probe.geometric[0]), probe.surface, false}, about);
        }
        EXPECT_GT(found, own.size() / 3) << scale;
    }
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

}  // namespace
}  // namespace hilcam
