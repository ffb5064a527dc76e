// The Earth of configs/maps/earth.map as a whole, against published figures, and pixels that share an aspect against
// pixels that have their own.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <sstream>
#include <utility>
#include <vector>

#include "io/cache/atmosphere_cache.h"
#include "io/files/earth_map_file.h"
#include "render/earth/earth_albedo.h"
#include "render/earth/earth_impostor.h"
#include "render/earth/earth_patch.h"
#include "render/sky/air_by_place.h"
#include "render/sky/atmosphere_config.h"
#include "render/sky/atmosphere_models.h"
#include "render/sky/bodies.h"
#include "render/sky/sun.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

const SpectralGrid kEarthGrid({0.30, 0.40, 0.48, 0.58, 0.69, 0.80, 1.0, 1.2});

struct ShippedEarth {
    std::unique_ptr<Atmosphere> air;
    std::unique_ptr<EarthModel> model;
    Spectrum sun = solar_irradiance_1au_w_m2_um(kEarthGrid);
    ShippedEarth() {
        AtmosphereConfig config;
        config.model = "precomputed";
        const AtmosphereCache cache{Cache(std::filesystem::temp_directory_path() / "hilcam_earth_test")};
        air = make_precomputed_atmosphere({config, kEarthGrid, nullptr, &cache});
        GroundMaps map = read_earth_map(std::string(HILCAM_SOURCE_DIR) + "/configs/maps/earth.map");
        dynamic_cast<AirByPlace&>(*air).put_over(earth_albedo({}, map, {}, kEarthGrid));
        model =
            std::make_unique<EarthModel>(EarthConfig{}, std::move(map), EarthMap{}, air.get(), kEarthGrid);
    }
    // Mean over bins by what the Sun gives them.
    double mean(const Spectrum& s, int from, int to) const {
        double sum = 0, weights = 0;
        for (int b = from; b < to; ++b) {
            const double w = static_cast<double>(sun[b]) * kEarthGrid.width_um(b);
            sum += w * static_cast<double>(s[b]), weights += w;
        }
        return sum / weights;
    }
};
ShippedEarth& earth() {
    static ShippedEarth shipped;
    return shipped;
}

// What the disk sends at a phase angle, the mean of six longitudes over the equator, the Sun by turns east and west.
Spectrum at_phase(double phase_rad, int looks) {
    Spectrum sum;
    for (int k = 0; k < 6; ++k) {
        const double camera = 2 * kPi * k / 6, sun = camera + (k % 2 ? phase_rad : -phase_rad);
        sum += (1.0f / 6) * earth().model->disk_albedo({std::cos(camera), std::sin(camera), 0},
                                                       {std::cos(sun), std::sin(sun), 0}, looks);
    }
    return sum;
}

constexpr int kDiskLooks = 1200;

// Bond albedo, 2 int p(g) sin g dg. From 0.40 to 0.69 um it is 0.297 +- 0.005 by earthshine (Goode et al., Geophys. Res. Lett. 28,
// 1671, 2001), which the scale of the cloud picture was set by: this holds the map to it, within what looks and longitudes
// scatter. Nothing was set by the geometric albedo: 0.242 +0.005 -0.004 from 0.4 to 0.7 um, by phase curves from
// the ground and from spacecraft (Robinson, Planet. Sci. J. 7, 12, 2026, arXiv:2507.22258), none of which reaches below 5 degrees, where
// the glory is.
TEST(ShippedEarth, ReflectsAsMuchAsTheEarth) {
    const Spectrum geometric = at_phase(0, kDiskLooks);
    Spectrum bond;
    constexpr double kStep = 5 * kDegree_rad;
    for (int i = 0; i < 36; ++i) {
        const double phase = (i + 0.5) * kStep;
        bond += static_cast<float>(2 * std::sin(phase) * kStep) * at_phase(phase, kDiskLooks);
    }
    std::ostringstream bins;
    bins.precision(3);
    for (int b = 0; b < kEarthGrid.size(); ++b)
        bins << kEarthGrid.from_um(b) << "-" << kEarthGrid.to_um(b) << " um " << bond[b] << "; ";
    std::cout << "Bond albedo: " << bins.str() << "0.40-0.69 um " << earth().mean(bond, 1, 4)
              << "; geometric " << earth().mean(geometric, 1, 4) << "\n";
    EXPECT_NEAR(earth().mean(bond, 1, 4), 0.297, 0.008);
    EXPECT_NEAR(earth().mean(geometric, 1, 4), 0.242, 0.015);
    // Molecules make it brighter to the blue.
    EXPECT_GT(bond[0], bond[1]);
    EXPECT_GT(bond[1], bond[2]);
}

// Geometric albedo times phase function against the curve through what earthshine, DSCOVR's EPIC, EPOXI, Galileo and LCROSS saw from 5 to
// 144 degrees, 0.4 to 0.7 um: 0.23 P(180 - g) / P(180) with Henyey and Greenstein's P of g = -0.33 (Robinson 2026, eq. 14). One day's
// clouds are one draw of the weather: the tolerances are what is found, for change to be seen.
TEST(ShippedEarth, DimsWithPhaseAsTheEarth) {
    const auto seen = [](double phase_rad) {
        constexpr double g = -0.33;
        return 0.23 * std::pow((1 + g) * (1 + g) / (1 + g * g + 2 * g * std::cos(phase_rad)), 1.5);
    };
    for (const auto& [degrees, most] : {std::pair{8.0, 0.17},
                                        {15.0, 0.17},
                                        {30.0, 0.1},
                                        {45.0, 0.08},
                                        {60.0, 0.06},
                                        {75.0, 0.05},
                                        {90.0, 0.05},
                                        {105.0, 0.06},
                                        {120.0, 0.06},
                                        {135.0, 0.12}}) {
        const double phase = degrees * kDegree_rad;
        const double p = earth().mean(at_phase(phase, kDiskLooks), 1, 4);
        const double lambert = 2.0 / 3 * (std::sin(phase) + (kPi - phase) * std::cos(phase)) / kPi;
        std::cout << degrees << " deg: " << p << ", over the published " << p / seen(phase)
                  << ", over Lambert's sphere of albedo 1 " << p / lambert << "\n";
        EXPECT_NEAR(p / seen(phase), 1, most) << degrees;
    }
}

// Zonal means of albedo at the top of the air against CERES' of 2018 (Loeb et al. 2018). The model has one day's clouds, no
// sea ice, no water vapour and nothing beyond 1.2 um: what is asked is that bright and dark zones are those of the Earth.
TEST(ShippedEarth, ZonesAreAsBrightAsCeresHasThem) {
    std::ifstream in(std::string(HILCAM_SOURCE_DIR) +
                     "/../shared/data/earth/Earth_ALB_2018_CERES_All_1x1.csv");
    if (!in) GTEST_SKIP() << "no ../shared/data/earth: there are no values of CERES to compare with";
    std::vector<double> rows;
    for (std::string line; std::getline(in, line);) {
        std::istringstream cells(line);
        double sum = 0;
        int count = 0;
        for (std::string cell; std::getline(cells, cell, ','); ++count) sum += std::stod(cell);
        rows.push_back(sum / count);
    }
    ASSERT_EQ(rows.size(), 180u);
    double squares = 0, squares_about_mean = 0, mean = 0;
    constexpr int kZones = 7;
    std::array<double, kZones> ceres{}, model{};
    for (int z = 0; z < kZones; ++z) {
        const int latitude = -60 + 20 * z;
        for (int d = -10; d < 10; ++d)
            ceres[static_cast<std::size_t>(z)] += rows[static_cast<std::size_t>(90 + latitude + d)] / 20;
        double up = 0, down = 0;
        for (const int declination : {-23, 0, 23})
            for (int step = 0; step < 24; ++step)
                for (int hour = 0; hour < 8; ++hour) {
                    const double lat = (latitude - 8 + step % 5 * 4) * kDegree_rad, lon = 2 * kPi * step / 24,
                                 sun_lon = lon + (hour - 3.5) * kPi / 8, dec = declination * kDegree_rad;
                    const Vec3d point = earth_fixed_position_m({lon, lat, 0}), n = earth_normal(point);
                    const Vec3d sun{std::cos(dec) * std::cos(sun_lon), std::cos(dec) * std::sin(sun_lon),
                                    std::sin(dec)};
                    if (dot(n, sun) <= 0) continue;
                    down += dot(n, sun);
                    const Vec3d east{-std::sin(lon), std::cos(lon), 0}, north = cross(n, east);
                    // Even shares of mu d mu.
                    for (int v = 0; v < 12; ++v) {
                        const double mu = std::sqrt((v % 4 + 0.5) / 4),
                                     phi = 2 * kPi * (v / 4 + 0.25 * (v % 4)) / 3;
                        const double sine = std::sqrt(1 - mu * mu);
                        const Vec3d to_viewer =
                            mu * n + sine * std::cos(phi) * east + sine * std::sin(phi) * north;
                        EarthModel::Ray ray{point + 4e6 * to_viewer, -to_viewer, sun, 0.02, {}};
                        ray.irradiance_w_m2_um.bin.fill(1);
                        Spectrum weight, light;
                        weight.bin.fill(1);
                        earth().model->add(ray, weight, light);
                        up += kPi / 12 * earth().mean(light, 0, kEarthGrid.size());
                    }
                }
        model[static_cast<std::size_t>(z)] = up / down;
        mean += (ceres[static_cast<std::size_t>(z)]) / kZones;
    }
    for (std::size_t z = 0; z < kZones; ++z) {
        std::cout << -60 + 20 * static_cast<int>(z) << " deg: CERES " << ceres[z] << ", model " << model[z]
                  << "\n";
        squares += (model[z] - ceres[z]) * (model[z] - ceres[z]) / kZones;
        squares_about_mean += (ceres[z] - mean) * (ceres[z] - mean) / kZones;
    }
    // Better than one albedo for all zones.
    EXPECT_LT(squares, squares_about_mean);
    EXPECT_LT(std::sqrt(squares), 0.06);
}

// A camera above 10 degrees east, towards the north and down.
struct PatchView {
    double latitude_deg, height_m, down_rad, sun_longitude_deg, pixel_rad;
    int pitch_px;

    // Calls tell(shared, own) with the radiance of each so many'th pixel, each way, by a patch and by itself, where patches carry.
    template <class Tell>
    void compare(int half_px, int every_px, const Tell& tell) const {
        const Vec3d origin = earth_fixed_position_m({10 * kDegree_rad, latitude_deg * kDegree_rad, height_m});
        const Vec3d up = earth_normal(origin), east = normalized(cross(Vec3d{0, 0, 1}, up)),
                    north = cross(up, east);
        const Vec3d ahead = std::cos(down_rad) * north - std::sin(down_rad) * up, above = cross(east, ahead);
        const double lon = sun_longitude_deg * kDegree_rad;
        const auto ray_at = [&](double x, double y) {
            EarthModel::Ray ray{origin,
                                normalized(ahead + x * pixel_rad * east - y * pixel_rad * above),
                                {std::cos(lon), std::sin(lon), 0},
                                pixel_rad,
                                {}};
            ray.irradiance_w_m2_um.bin.fill(1);
            ray.looks_across = EarthModel::kLooksOfPixel;
            return ray;
        };
        const auto patch = std::make_unique<EarthPatch>();
        Spectrum one;
        one.bin.fill(1);
        for (int y0 = -half_px; y0 < half_px; y0 += 64)
            for (int x0 = -half_px; x0 < half_px; x0 += 64) {
                patch->place(*earth().model, {x0, y0, x0 + 64, y0 + 64}, pitch_px, ray_at);
                for (int y = y0; y < y0 + 64; y += every_px)
                    for (int x = x0; x < x0 + 64; x += every_px) {
                        Spectrum shared, own, weight = one;
                        if (!patch->add(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, one,
                                        shared))
                            continue;
                        earth().model->add(ray_at(x + 0.5, y + 0.5), weight, own);
                        tell(static_cast<double>(shared[2]), static_cast<double>(own[2]));
                    }
            }
    }
};

// Pixels of 0.6 mrad from geostationary height and from 420 km: a patch's against each pixel's own, where patches carry.
TEST(ShippedEarth, PixelsThatShareAnAspectLookLikeThoseOfTheirOwn) {
    for (const PatchView& view : {PatchView{20, 35786e3, 0.5 * kPi, 75, 6e-4, EarthPatch::kFinePitch_px},
                                  PatchView{20, 420e3, 0.5, 30, 6e-4, EarthPatch::kWidePitch_px}}) {
        double squares = 0, sum = 0;
        int pixels = 0;
        view.compare(192, 3, [&](double shared, double own) {
            squares += (shared - own) * (shared - own), sum += own, ++pixels;
        });
        ASSERT_GT(pixels, 3000);
        const double rms = std::sqrt(squares / pixels) / (sum / pixels);
        std::cout << view.height_m * 1e-3 << " km: " << pixels << " px, rms " << 100 * rms
                  << " % of their mean\n";
        EXPECT_LT(rms, 0.005);
    }
}

// From geostationary height with the terminator in view, where light falls by powers of ten in a few pixels: patches are like pixels
// of their own, or leave them alone. With patches over all of it half of the light of some is off.
TEST(ShippedEarth, PatchesEndWhereLightBends) {
    int pixels = 0;
    double worst = 0;
    PatchView{0, 35786e3, 0.5 * kPi, 75, 1.2e-3, EarthPatch::kFinePitch_px}.compare(
        128, 1, [&](double shared, double own) {
            // White paint in the Sun sends 1 / pi.
            worst = std::max(worst, std::abs(shared - own) / (own + 1e-3)), ++pixels;
        });
    std::cout << pixels << " px, worst " << worst << "\n";
    EXPECT_GT(pixels, 10000);
    EXPECT_LT(worst, 0.06);
}

// Errors in the noise of inspector_1k (13 e-, full well 13500 e-) when the brightest hundredth of the disk has half of its full well.
struct NoiseErrors {
    std::vector<double> errors;
    double squares = 0;
    void add(double error) { errors.push_back(std::abs(error)), squares += error * error; }
    double rms() const { return std::sqrt(squares / static_cast<double>(errors.size())); }
    std::string words() {
        std::sort(errors.begin(), errors.end());
        std::ostringstream text;
        text.precision(3);
        text << "rms " << rms() << ", p99 " << errors[errors.size() * 99 / 100];
        return text.str();
    }
};

// A place and a Sun so many steps beside those for which a picture is kept (earth_impostor.cpp: 1 and 2 mrad, 0.4 % of distance),
// on the equator 10 degrees east in geostationary height.
struct KeptView {
    Vec3d camera_m, sun_dir;
    KeptView(double sun_longitude_deg, double steps_off) {
        const auto at = [&](double value, double step) {
            return step * (std::round(value / step) + steps_off);
        };
        const auto out = [](double lon, double lat) {
            return Vec3d{std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat)};
        };
        camera_m = kEarthEquatorialRadius_m * std::exp(at(std::log(6.62), 4e-3)) *
                   out(at(10 * kDegree_rad, 1e-3), at(0, 1e-3));
        sun_dir = out(at(sun_longitude_deg * kDegree_rad, 2e-3), at(0, 2e-3));
    }
};

// A kept picture against the mean of 16 narrow rays a pixel (64 of the pixel's width at the limb), and a ray a pixel against that, too: the
// picture is to be no worse. What the steps of its grid add, half of each, is told by rays apart: a tenth of the noise.
TEST(ShippedEarth, IsKeptAsAPictureThatIsBetterThanARayAPixel) {
    constexpr double kPixel_rad =
        5.19e-4;  // of inspector_1k with a lens of 10.6 mm: the disk fills a quarter
    constexpr int kTile_px = 32, kHalf_px = 320;
    constexpr float kShare = 1.0f / kTile_px;
    EarthImpostor picture(kPixel_rad, earth().air->top_m(), earth().model->seen_height_m(0));
    for (const double sun_longitude_deg : {40.0, 88.0}) {
        const KeptView kept(sun_longitude_deg, 0), view(sun_longitude_deg, 0.49);
        const Vec3d out = normalized(view.camera_m), east = normalized(cross(Vec3d{0, 0, 1}, out)),
                    north = cross(out, east);
        const auto dir_at = [&](double x, double y) {
            return normalized(x * kPixel_rad * east - y * kPixel_rad * north - out);
        };
        const auto light = [&](Vec3d from_m, Vec3d dir, Vec3d sun_dir, double width_rad, int looks = 1) {
            const EarthModel::Ray ray{from_m, dir, sun_dir, width_rad, earth().sun, {}, looks};
            Spectrum weight, sum;
            weight.bin.fill(1);
            earth().model->add(ray, weight, sum);
            return static_cast<double>(sum[2]);
        };
        picture.begin(EarthImpostor::key_of(view.camera_m, view.sun_dir));
        picture.make_rest(*earth().model, earth().sun);
        struct Pixel {
            double kept, one_ray, mean, step;
            bool limb;
        };
        std::vector<Pixel> pixels;
        for (int i = 0; i < 4 * kHalf_px * kHalf_px / (kTile_px * kTile_px); ++i) {
            const int x0 = i % (2 * kHalf_px / kTile_px) * kTile_px - kHalf_px,
                      y0 = i / (2 * kHalf_px / kTile_px) * kTile_px - kHalf_px;
            std::array<Vec3d, 9> dirs;
            for (int k = 0; k < 9; ++k)
                dirs[static_cast<std::size_t>(k)] =
                    dir_at(x0 + 0.5 * kTile_px * (k % 3), y0 + 0.5 * kTile_px * (k / 3));
            const EarthImpostor::Tile tile = picture.tile(view.camera_m, dirs);
            for (int k = i % 13; k < kTile_px * kTile_px; k += 13) {
                const double x = x0 + k % kTile_px + 0.5, y = y0 + k / kTile_px + 0.5;
                const Vec3d dir = dir_at(x, y);
                const double from_limb_px = (length(cross(view.camera_m, dir)) - kEarthEquatorialRadius_m) /
                                            (length(view.camera_m) * kPixel_rad);
                if (from_limb_px > 4) continue;
                const bool limb = from_limb_px > -3;
                const int n = limb ? 8 : 4;
                double mean = 0;
                for (int s = 0; s < n * n; ++s)
                    mean +=
                        light(view.camera_m, dir_at(x + (s % n + 0.5) / n - 0.5, y + (s / n + 0.5) / n - 0.5),
                              view.sun_dir, kPixel_rad / n) /
                        (n * n);
                EarthImpostor::Floats in_x{}, in_y{};
                std::array<Spectrum, EarthImpostor::kCount> seen;
                in_x[0] = kShare * static_cast<float>(x - x0), in_y[0] = kShare * static_cast<float>(y - y0);
                picture.look(tile, in_x, in_y, 1, 1, seen);
                // The same place on the ground from where the picture is kept, under its Sun.
                const Vec3d ground_m =
                    view.camera_m + std::max(0.0, intersect_earth(view.camera_m, dir)) * dir;
                const double one_ray =
                    light(view.camera_m, dir, view.sun_dir, kPixel_rad, EarthModel::kLooksOfPixel);
                const double step = limb ? 0
                                         : light(kept.camera_m, normalized(ground_m - kept.camera_m),
                                                 kept.sun_dir, kPixel_rad) -
                                               light(view.camera_m, dir, view.sun_dir, kPixel_rad);
                pixels.push_back({static_cast<double>(seen[0][2]), one_ray, mean, step, limb});
            }
        }
        std::vector<double> levels;
        for (const Pixel& pixel : pixels) levels.push_back(pixel.mean);
        std::sort(levels.begin(), levels.end());
        const double electrons = 6750 / levels[levels.size() * 99 / 100];
        NoiseErrors kept_disk, kept_limb, ray_disk, ray_limb, steps;
        for (const Pixel& pixel : pixels) {
            const double per_sigma = electrons / std::sqrt(pixel.mean * electrons + 13 * 13);
            (pixel.limb ? kept_limb : kept_disk).add((pixel.kept - pixel.mean) * per_sigma);
            (pixel.limb ? ray_limb : ray_disk).add((pixel.one_ray - pixel.mean) * per_sigma);
            if (!pixel.limb) steps.add(pixel.step * per_sigma);
        }
        ASSERT_GT(kept_disk.errors.size(), 15000u);
        std::cout << "Sun " << sun_longitude_deg - 10 << " deg from the camera: kept " << kept_disk.words()
                  << ", a ray a pixel " << ray_disk.words() << "; at the limb kept " << kept_limb.words()
                  << ", a ray a pixel " << ray_limb.words() << "; half a step of camera and Sun "
                  << steps.words() << " of the noise; " << static_cast<double>(picture.bytes()) * 1e-6
                  << " MB\n";
        EXPECT_LT(kept_disk.rms(), ray_disk.rms());
        EXPECT_LT(kept_limb.rms(), ray_limb.rms());
        EXPECT_LT(steps.rms(), 0.1);
    }
}

}  // namespace
}  // namespace hilcam
