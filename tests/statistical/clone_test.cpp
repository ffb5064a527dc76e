// Hidden cameras, drawn by a seed that the cloning code is not told, are cloned from frames that they took
// themselves, and what they were made with comes back.

#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <set>

#include "emulator/clone/clone_bench.h"
#include "emulator/clone/clone_camera.h"
#include "emulator/clone/clone_figures.h"
#include "emulator/clone/clone_report.h"
#include "emulator/scenario/scene_loader.h"
#include "io/config/config_yaml.h"

namespace hilcam {
namespace {

constexpr int kFrames = 64;
constexpr double kFlat_s = 0.02;  // exposure that nearly fills the well

struct Hidden {
    CameraModel camera;
    DetectorPictures pictures;
    FixedPattern pattern;  // the unit's own values
    double flat_e = 0;     // charge of the light in kFlat_s
};

// The camera of the same type that the data sheet describes: everything that is measured is wrong in it.
std::string sheet_yaml(int size) {
    return fmt::format(
        "# A camera of the same type.\nname: sheet\nwidth_px: {0}\nheight_px: {0}\npitch_um: 5.5\n"
        "focal_length_mm: 50\nf_number: 4\ncos_power: 0\nquantum_efficiency: [[0.4, 0.3], [0.55, 0.6], [0.8, "
        "0.2]]\n"
        "full_well_e: 7000\ngain_dn_e: 0.2\noffset_dn: 100\nread_noise_e: 3\nreset_noise_e: 1\n"
        "dark_current_e_s: 5\ndark_doubling_k: 8\ntemperature_c: 20\nprnu_fraction: 0.02\ndsnu_e: 1\n"
        "fixed_pattern: {{seed: 7,\n  row_e: 1}}\nbits: 12\n",
        size);
}

CameraModel sheet(int size) {
    CameraModel c;
    read_config_text(sheet_yaml(size), "sheet.yaml", "/", section_of(c));
    return c;
}

// kind 0: an industrial CMOS sensor. 1: deep wells and few numbers a step. 2: low noise below a step, rows.
Hidden hidden_camera(int kind, unsigned seed, int size) {
    std::mt19937_64 engine(1000u * seed + static_cast<unsigned>(kind));
    const auto between = [&](double least, double most) {
        return std::uniform_real_distribution<double>(least, most)(engine);
    };
    Hidden out;
    CameraModel& c = out.camera;
    c = sheet(size);
    c.name = "hidden";
    c.reset_noise_e = 0;
    c.temperature_c = c.dark_reference_c = 25;
    c.fixed_pattern = {};
    // The listed hot pixels follow the temperature, too.
    c.fixed_pattern.has_dark_map_c = true, c.fixed_pattern.dark_map_c = 25;
    c.fixed_pattern.seed = static_cast<std::int64_t>(engine() >> 12);
    const double size_factor[] = {1, 4, 0.8};
    c.full_well_e = between(9000, 11000) * size_factor[kind];
    const double full_dn[] = {3300, 3000, 2500};
    c.gain_dn_e = between(0.95, 1.05) * full_dn[kind] / c.full_well_e;
    c.offset_dn = between(60, 140);
    c.read_noise_e = kind == 0 ? between(5, 8) : kind == 1 ? between(10, 15) : between(1.3, 1.9);
    c.row_noise_e = kind == 2 ? between(0.5, 0.9) : 0;
    c.dark_current_e_s = between(50, 150);
    c.dark_doubling_k = between(5.5, 8);
    c.nonlinearity = {between(-0.03, 0.01), between(-0.02, 0.01)};
    // Pixels differ by more than seven times the error of their mean over the flats.
    c.prnu_fraction = between(0.008, 0.014);
    c.dsnu_e = between(5, 8) * (kind == 2 ? 0.6 : kind == 1 ? 3 : 1);
    c.fixed_pattern.dark_current_fraction = between(0.1, 0.2);
    c.fixed_pattern.column_e = between(1, 2) * (kind == 1 ? 3 : 1);
    c.fixed_pattern.row_e = kind == 1 ? between(3, 6) : 0;
    c.fixed_pattern.column_gain_fraction = between(0.001, 0.002);
    c.defects.telegraph_frames = 3;
    std::set<std::pair<int, int>> taken;
    const auto place = [&](DefectKind kind_of, double value) {
        std::pair<int, int> at;
        do at = {static_cast<int>(between(0, size)), static_cast<int>(between(0, size))};
        while (!taken.insert(at).second);
        out.pictures.defects.push_back({kind_of, at.first, at.second, value});
    };
    const int count = size * size / 1000;
    for (int i = 0; i < count; ++i)
        place(DefectKind::kHot, c.dark_current_e_s - 600 * std::log(between(1e-6, 1)));
    for (int i = 0; i < count / 8; ++i) place(DefectKind::kDead, 0);
    for (int i = 0; i < count / 8; ++i) place(DefectKind::kBlinking, between(6, 20) * c.read_noise_e);
    out.pattern = draw_fixed_pattern(on_clone_bench(c), out.pictures);
    out.flat_e = 0.9 * c.full_well_e;
    return out;
}

// 64 darks of four exposures and 64 flats of ten levels at 25 C, darks at two more temperatures, and a few
// flats beyond saturation.
std::vector<BenchSeries> laboratory(double flat_e) {
    std::vector<BenchSeries> out;
    const auto add = [&](SeriesKind kind, double exposure_s, double temperature_c, std::size_t frames) {
        BenchSeries s;
        s.settings.name = fmt::format("{}_{:g}ms_{:g}c", kind == SeriesKind::kDark ? "dark" : "flat",
                                      1e3 * exposure_s, temperature_c);
        s.settings.kind = kind, s.settings.exposure_s = exposure_s, s.settings.temperature_c = temperature_c;
        s.settings.frames = frames;
        s.charge_e = kind == SeriesKind::kFlat ? flat_e * exposure_s / kFlat_s : 0;
        out.push_back(std::move(s));
    };
    for (const double s : {0.001, 0.02, 0.2, 1.0}) add(SeriesKind::kDark, s, 25, kFrames);
    for (const double c : {15.0, 35.0})
        for (const double s : {0.02, 1.0}) add(SeriesKind::kDark, s, c, kFrames);
    for (const double share : {0.04, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.85, 1.0})
        add(SeriesKind::kFlat, kFlat_s * share, 25, kFrames);
    add(SeriesKind::kFlat, 1.5 * kFlat_s, 25, 8);
    return out;
}

CloneMeasurement measure(const CameraModel& camera, const DetectorPictures& pictures, double flat_e,
                         std::uint64_t seed) {
    const CameraModel like = sheet(static_cast<int>(camera.width_px));
    return measure_clone(bench_frames(camera, pictures, laboratory(flat_e), seed), like, [](double) {});
}

double mean_of(const PixelMap& map, const PixelSelection& good) {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < map.pixels(); ++i)
        if (good.use[i]) sum += static_cast<double>(map.all()[i]), ++count;
    return sum / count;
}

struct Check {
    std::string key;
    double truth = 0;
    Measured measured;

    double sigmas() const { return (measured.value - truth) / measured.uncertainty; }
};
std::vector<Check> checks(const CloneMeasurement& m, const CameraModel& c, const FixedPattern& unit) {
    const auto bend = [&](std::size_t i) { return c.nonlinearity.size() > i ? c.nonlinearity[i] : 0; };
    std::vector<Check> out;
    const std::vector<CloneFigure> figures = clone_figures(m, c);
    const auto add = [&](const char* key, double truth) {
        const CloneFigure& f = figure_of(figures, key);
        EXPECT_TRUE(f.measured) << key;
        if (f.measured) out.push_back({key, truth, *f.measured});
    };
    add("gain_dn_e", c.gain_dn_e);
    // What is drawn for this unit has a mean of its own.
    add("offset_dn", c.offset_dn + c.gain_dn_e * mean_of(unit.offset_e, m.good));
    add("read_noise_e", c.read_noise_e);
    if (c.row_noise_e > 0) add("row_noise_e", c.row_noise_e);
    add("dark_current_e_s", mean_of(unit.dark_e_s, m.good));
    add("dark_doubling_k", c.dark_doubling_k);
    add("full_well_e", c.full_well_e);
    add("nonlinearity_a2", bend(0));
    add("nonlinearity_a3", bend(1));
    add("prnu_fraction", c.prnu_fraction);
    add("column_gain_fraction", c.fixed_pattern.column_gain_fraction);
    add("dsnu_e", c.dsnu_e);
    add("column_e", c.fixed_pattern.column_e);
    if (c.fixed_pattern.row_e > 0) add("row_e", c.fixed_pattern.row_e);
    add("dark_current_fraction", c.fixed_pattern.dark_current_fraction);
    return out;
}

double correlation(const std::vector<double>& map, const PixelMap& truth, const PixelSelection& good) {
    double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    for (std::size_t i = 0; i < map.size(); ++i) {
        if (!good.use[i]) continue;
        const double x = map[i], y = static_cast<double>(truth.all()[i]);
        ++n, a += x, b += y, aa += x * x, bb += y * y, ab += x * y;
    }
    return (ab - a * b / n) / std::sqrt((aa - a * a / n) * (bb - b * b / n));
}

struct Found {
    int made = 0, above = 0, found = 0, false_ones = 0;  // above: the limit that the clone states
};
Found found(const CloneMeasurement& m, const Hidden& hidden, DefectKind kind, double least) {
    Found out;
    std::set<std::pair<int, int>> listed, made;
    for (const ListedDefect& d : m.defects)
        if (d.kind == kind) listed.insert({d.x, d.y});
    for (const ListedDefect& d : hidden.pictures.defects) {
        if (d.kind != kind) continue;
        ++out.made;
        made.insert({d.x, d.y});
        if (d.value < least) continue;
        ++out.above, out.found += listed.count({d.x, d.y}) > 0 ? 1 : 0;
    }
    for (const auto& at : listed) out.false_ones += made.count(at) > 0 ? 0 : 1;
    return out;
}

void expect_found(const CloneMeasurement& m, const Hidden& hidden) {
    // The limit is that of the mean; dark currents scatter around it by their own spread and noise.
    const double dark = hidden.camera.dark_current_e_s;
    const Found hot = found(m, hidden, DefectKind::kHot, dark + 1.5 * m.hot_limit_e_s);
    EXPECT_EQ(hot.found, hot.above);
    EXPECT_EQ(hot.false_ones, 0);
    const Found dead = found(m, hidden, DefectKind::kDead, 0);
    EXPECT_EQ(dead.found, dead.made);
    EXPECT_EQ(dead.false_ones, 0);
    const Found blinking = found(m, hidden, DefectKind::kBlinking, 0);
    // One whose states are close may be missed, or be another noisy pixel.
    EXPECT_GE(blinking.found, blinking.made - 1);
    EXPECT_LE(blinking.false_ones, 1);
}

// Shares of figures within two standard deviations, over cameras and seeds.
struct Score {
    int within = 0, all = 0;
    void add(const std::vector<Check>& checks, const std::string& whose) {
        for (const Check& c : checks) {
            ++all;
            within += std::abs(c.sigmas()) <= 2 ? 1 : 0;
            // Beyond any chance of a thousand figures.
            EXPECT_LT(std::abs(c.sigmas()), 5) << whose << ": " << c.key << " " << c.measured.value << " +- "
                                               << c.measured.uncertainty << ", made with " << c.truth;
        }
    }
    // 95.45 % of Gaussian errors are within two sigma; less 3.5 standard deviations of that share.
    void expect_gaussian() const {
        const double n = all;
        EXPECT_GT(within / n, 0.9545 - 3.5 * std::sqrt(0.0455 * 0.9545 / n)) << within << " of " << all;
    }
};

void expect_correlations(const CloneMeasurement& m, const Hidden& hidden, const std::string& whose) {
    const auto expect = [&](const char* name, const PixelValues& map, const PixelMap& truth) {
        const double seen = correlation(map.value, truth, m.good), stated = map.spread.correlation();
        // The frames' own noise is the bound: no more and no less than the clone says itself.
        EXPECT_NEAR(seen, stated, 0.01) << whose << ": " << name;
    };
    expect("offset", m.offset_e, hidden.pattern.offset_e);
    expect("dark", m.dark_e_s, hidden.pattern.dark_e_s);
    expect("gain", m.gain, hidden.pattern.gain);
    EXPECT_GT(correlation(m.offset_e.value, hidden.pattern.offset_e, m.good), 0.99) << whose;
    EXPECT_GT(correlation(m.gain.value, hidden.pattern.gain, m.good), 0.99) << whose;
}

TEST(Clone, ThreeHiddenCamerasComeBackFromTheirFrames) {
    Score score;
    for (int kind = 0; kind < 3; ++kind) {
        const Hidden hidden = hidden_camera(kind, 0, 128);
        const CloneMeasurement m = measure(hidden.camera, hidden.pictures, hidden.flat_e, 1);
        score.add(checks(m, hidden.camera, hidden.pattern), fmt::format("kind {}", kind));
        expect_found(m, hidden);
        expect_correlations(m, hidden, fmt::format("kind {}", kind));
    }
    score.expect_gaussian();
}

// Another camera's figures are not these: a test that compares with a wrong truth fails.
TEST(Clone, AnotherCameraIsSeenToBeAnother) {
    const Hidden hidden = hidden_camera(0, 0, 128);
    const CloneMeasurement m = measure(hidden.camera, hidden.pictures, hidden.flat_e, 1);
    CameraModel other = hidden.camera;
    other.gain_dn_e *= 1.01, other.read_noise_e *= 1.03, other.dark_doubling_k *= 1.05, other.dsnu_e *= 1.1;
    other.full_well_e *= 1.02, other.prnu_fraction *= 1.1, other.nonlinearity[0] += 0.005;
    const std::set<std::string> changed = {"gain_dn_e",   "read_noise_e",  "dark_doubling_k", "dsnu_e",
                                           "full_well_e", "prnu_fraction", "nonlinearity_a2"};
    for (const Check& c : checks(m, other, hidden.pattern)) {
        if (changed.count(c.key) == 0) continue;
        EXPECT_GT(std::abs(c.sigmas()), 2) << c.key;
    }
    const Hidden stranger = hidden_camera(0, 1, 128);
    EXPECT_LT(std::abs(correlation(m.offset_e.value, stranger.pattern.offset_e, m.good)), 0.1);
}

class TemporaryFolder {
  public:
    explicit TemporaryFolder(const char* name)
        : path_(std::filesystem::temp_directory_path() / (std::string(name) + std::to_string(getpid()))) {
        std::filesystem::create_directories(path_);
    }
    ~TemporaryFolder() { std::filesystem::remove_all(path_); }
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

// The written camera is read, takes the same series, and is cloned again.
void expect_same_clone(int kind, int size, Score& score) {
    const Hidden hidden = hidden_camera(kind, 5, size);
    const CloneMeasurement first = measure(hidden.camera, hidden.pictures, hidden.flat_e, 1);
    const TemporaryFolder folder("hilcam_clone_");
    const auto like = folder.path() / "sheet.yaml", file = folder.path() / "clone.yaml";
    std::ofstream(like) << sheet_yaml(size);
    write_clone(first, {"frames", 1000, like, sheet(size), {}}, file);
    CameraModel camera;
    read_config(file, section_of(camera));
    const CloneMeasurement second = measure(camera, load_detector_pictures(camera), hidden.flat_e, 2);
    const auto a = clone_figures(first, camera), b = clone_figures(second, camera);
    std::vector<Check> checks;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i].measured && b[i].measured && b[i].measured->uncertainty > 0 && a[i].measured->value != 0)
            checks.push_back({a[i].key, a[i].measured->value, *b[i].measured});
    score.add(checks, fmt::format("clone of kind {}", kind));
    const auto hot = [](const CloneMeasurement& m) {
        return std::count_if(m.defects.begin(), m.defects.end(),
                             [](const ListedDefect& d) { return d.kind == DefectKind::kHot; });
    };
    // Those near the limit may be on either side of it.
    EXPECT_NEAR(static_cast<double>(hot(second)), static_cast<double>(hot(first)),
                0.1 * static_cast<double>(hot(first)) + 2);
}

TEST(Clone, AClonesCloneIsTheSame) {
    Score score;
    for (int kind = 0; kind < 3; ++kind) expect_same_clone(kind, 128, score);
    score.expect_gaussian();
}

// The long one: prints a table, which docs/clone.md has.
TEST(Clone, TwentySeeds) {
    Score score;
    std::map<std::string, Score> by_key;
    Found hot, dead, blinking;
    const auto sum = [](Found& to, const Found& one) {
        to.made += one.made, to.above += one.above, to.found += one.found, to.false_ones += one.false_ones;
    };
    double least_offset = 1, least_gain = 1, least_dark = 1;
    for (unsigned seed = 1; seed <= 20; ++seed)
        for (int kind = 0; kind < 3; ++kind) {
            const Hidden hidden = hidden_camera(kind, seed, 128);
            const CloneMeasurement m = measure(hidden.camera, hidden.pictures, hidden.flat_e, seed);
            const std::vector<Check> all = checks(m, hidden.camera, hidden.pattern);
            score.add(all, fmt::format("kind {} seed {}", kind, seed));
            for (const Check& c : all) by_key[c.key].add({c}, c.key);
            expect_found(m, hidden);
            expect_correlations(m, hidden, fmt::format("kind {} seed {}", kind, seed));
            sum(hot,
                found(m, hidden, DefectKind::kHot, hidden.camera.dark_current_e_s + 1.5 * m.hot_limit_e_s));
            sum(dead, found(m, hidden, DefectKind::kDead, 0));
            sum(blinking, found(m, hidden, DefectKind::kBlinking, 0));
            least_offset =
                std::min(least_offset, correlation(m.offset_e.value, hidden.pattern.offset_e, m.good));
            least_gain = std::min(least_gain, correlation(m.gain.value, hidden.pattern.gain, m.good));
            least_dark = std::min(least_dark, correlation(m.dark_e_s.value, hidden.pattern.dark_e_s, m.good));
        }
    fmt::print("within two sigma: {} of {}, {:.1f} %\n", score.within, score.all,
               100.0 * score.within / score.all);
    for (const auto& [key, one] : by_key) fmt::print("  {:<24}{:>4} of {}\n", key, one.within, one.all);
    const auto row = [](const char* name, const Found& f) {
        fmt::print("{:<10} made {:>6}, above the limit {:>6}, found {:>6}, false {}\n", name, f.made, f.above,
                   f.found, f.false_ones);
    };
    row("hot", hot), row("dead", dead), row("blinking", blinking);
    fmt::print("least correlation: offset {:.4f}, gain {:.4f}, dark current {:.4f}\n", least_offset,
               least_gain, least_dark);
    score.expect_gaussian();
    EXPECT_GE(blinking.found, 0.98 * blinking.made);
    EXPECT_LE(blinking.false_ones, 0.02 * blinking.made);
}

}  // namespace
}  // namespace hilcam
