#include "render/earth/earth_impostor.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/earth/earth_figure.h"
#include "render/sky/bodies.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/clones.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr double kEarthRadius_m = kEarthFigure.equatorial_radius_m;
// Spacing of rings and columns, and the width of a ray. With linear interpolation these are close to a
// pixel's mean (ShippedEarth.IsKeptAsAPictureThatIsBetterThanARayAPixel).
constexpr double kSpacing_px = 0.6, kWidth_px = 0.75;
// A step of the Sun lasts 27 s. A step of the camera's distance changes the angles at which the ground is
// seen by as much.
constexpr double kPictureSunStep_rad = 2e-3, kCameraStep_rad = 1e-3, kDistanceStep = 4e-3;
constexpr double kMapStep = 1.0 / 256;  // fraction of the time from one map to the next
// The disk's radius in pixels, and the camera's distance from the middle in radii.
constexpr double kSmallest_px = 6, kLargest_px = 640, kNearest = 4;
constexpr int kPictureRings = 16;  // rings of a band, not counting the one shared with the next band
constexpr int kRunColumns = 64;    // columns of a piece
// The limb's rings begin this far inside [px]; number of its rings per other ring; rays for each across its
// width.
constexpr double kLimb_px = 1.5;
constexpr int kFinerSteps = 3, kLimbLooks = 4;

Vec3d from_steps(double longitude_rad, double latitude_rad) {
    return {std::cos(latitude_rad) * std::cos(longitude_rad),
            std::cos(latitude_rad) * std::sin(longitude_rad), std::sin(latitude_rad)};
}
std::int32_t steps(double value, double step) { return static_cast<std::int32_t>(std::lround(value / step)); }

// Finds 16 places of a tile in the picture: closest approach over the radius, and turns around the Earth's
// middle, 0..1. The arc tangent is a polynomial (Abramowitz & Stegun, 4.4.49, to 2e-8), after reduction to an
// eighth of a turn.
HILCAM_CLONES void place_looks(const EarthImpostor::Tile& tile, const float* x, const float* y,
                               float distance, float* approach, float* turn) {
    const std::array<float, 9>&a = tile.across, &d = tile.down;
    for (std::size_t i = 0; i < EarthImpostor::kCount; ++i) {
        const float s = x[i], t = y[i];
        const float right = a[0] + s * (a[1] + s * a[2]) + t * (a[3] + s * (a[4] + s * a[5])) +
                            t * t * (a[6] + s * (a[7] + s * a[8]));
        const float down = d[0] + s * (d[1] + s * d[2]) + t * (d[3] + s * (d[4] + s * d[5])) +
                           t * t * (d[6] + s * (d[7] + s * d[8]));
        const float squared = right * right + down * down;
        approach[i] = distance * std::sqrt(squared / (1 + squared));
        const float u = std::abs(right), v = std::abs(down);
        const float high = u > v ? u : v, low = u > v ? v : u;
        const float ratio = low / (high > 1e-12f ? high : 1e-12f), q = ratio * ratio;
        const float arc =
            ratio *
            (1 + q * (-0.3333314528f +
                      q * (0.1999355085f +
                           q * (-0.1420889944f +
                                q * (0.1065626393f + q * (-0.0752896400f +
                                                          q * (0.0429096138f + q * (-0.0161657367f +
                                                                                    q * 0.0028662257f))))))));
        const float of_turn = 0.15915494f * arc;
        const float quarter = u > v ? of_turn : 0.25f - of_turn;
        const float half = right < 0 ? 0.5f - quarter : quarter;
        turn[i] = down < 0 ? 1 - half : half;
    }
}

// Stores radiance from 2^-21 W m^-2 sr^-1 um^-1 in 16 bits: five of the exponent and eleven digits, so the
// error is at most 1 / 4096. Values above 2^11, brighter than any cloud, are clamped.
constexpr std::uint32_t kDropped = 12, kLowestBits = (127u - 21) << 23;
constexpr float kDarkestCoded = 0x1p-21f;
static_assert(std::bit_cast<std::uint32_t>(kDarkestCoded) == kLowestBits);
std::uint16_t coded(float value) {
    const auto bits =
        std::bit_cast<std::uint32_t>(std::max(0.0f, value) + kDarkestCoded) + (1u << (kDropped - 1));
    return static_cast<std::uint16_t>(std::min((bits - kLowestBits) >> kDropped, 0xFFFFu));
}

// Sixteen lookups: where they start in the picture's columns, and their weights.
struct Looks {
    static constexpr std::size_t kCount = EarthImpostor::kCount;
    std::array<const std::uint16_t*, kCount> light;  // place in the previous row and column
    std::array<std::size_t, kCount> stride;          // to the next column; the next row is adjacent
    EarthImpostor::Floats in_row, in_column;         // from there, 0..1
    std::array<bool, kCount> at_limb;
    std::array<EarthImpostor::LimbRows, kCount> by_row;  // used at the limb instead of in_row
};

using Bins = float __attribute__((vector_size(32), may_alias));
using BinBits = std::uint32_t __attribute__((vector_size(32)));
using BinCodes = std::uint16_t __attribute__((vector_size(16), may_alias));
static_assert(sizeof(Bins) == sizeof(Spectrum));

HILCAM_CLONES void mix_looks(const Looks& looks, std::size_t count, Spectrum* out) {
    for (std::size_t i = 0; i < count; ++i) {
        const auto* light = reinterpret_cast<const BinCodes*>(looks.light[i]);
        const std::size_t stride = looks.stride[i];
        const auto value = [&](std::size_t at) {
            return reinterpret_cast<Bins>((__builtin_convertvector(light[at], BinBits) << kDropped) +
                                          kLowestBits);
        };
        const auto row = [&](std::size_t r) {
            const Bins left = value(r);
            return left + looks.in_column[i] * (value(r + stride) - left);
        };
        Bins sum;
        if (looks.at_limb[i]) {
            sum = looks.by_row[i][0] * row(0);
            for (std::size_t r = 1; r < EarthImpostor::kLimbRows; ++r) sum += looks.by_row[i][r] * row(r);
        } else {
            const Bins before = row(0);
            sum = before + looks.in_row[i] * (row(1) - before);
        }
        *reinterpret_cast<Bins*>(out + i) = sum - kDarkestCoded;
    }
}

}  // namespace

EarthImpostor::Key EarthImpostor::key_of(Vec3d camera_m, Vec3d sun_dir, MapNumbers numbers) {
    const double distance_m = length(camera_m);
    return {{steps(std::atan2(camera_m.y, camera_m.x), kCameraStep_rad),
             steps(std::asin(camera_m.z / distance_m), kCameraStep_rad),
             steps(std::log(distance_m / kEarthRadius_m), kDistanceStep)},
            {steps(std::atan2(sun_dir.y, sun_dir.x), kPictureSunStep_rad),
             steps(std::asin(std::clamp(sun_dir.z, -1.0, 1.0)), kPictureSunStep_rad)},
            {steps(numbers.clouds, kMapStep), steps(numbers.ground, kMapStep)}};
}

bool EarthImpostor::is_for(Vec3d camera_m, double pixel_rad) {
    const double distance = length(camera_m) / kEarthRadius_m;
    const double radius_px = 1 / (distance * pixel_rad);
    return distance > kNearest && radius_px > kSmallest_px && radius_px < kLargest_px;
}

EarthImpostor::EarthImpostor(double pixel_rad, double top_m, double edge_m)
    : pixel_rad_(pixel_rad), top_m_(top_m), radius_m_(kEarthRadius_m + edge_m) {
    bands_.reserve(static_cast<std::size_t>(kLargest_px / kSpacing_px) / kPictureRings + 4);
    // Reserves addresses for the widest disk; take_memory() uses their pages. One and a half grid steps
    // nearer.
    distance_m_ =
        (1 - 1.5 * kDistanceStep) * kEarthRadius_m * std::max(kNearest, 1 / (kLargest_px * pixel_rad));
    place_bands();
    light_.reserve(used_);
}

// Rotates a vector to the picture's axes.
Vec3d EarthImpostor::to_place(Vec3d v) const { return {dot(v, right_), dot(v, down_), dot(v, ahead_)}; }

void EarthImpostor::place_bands() {
    bands_.clear();
    const double pixel = pixel_rad_ * distance_m_ / radius_m_;  // a pixel's share of the radius
    const double step = kSpacing_px * pixel, fine = step / kFinerSteps;
    pixel_ = static_cast<float>(pixel);
    inner_per_b_ = static_cast<float>(1 / step);
    const double limb_from = 1 - kLimb_px * pixel;
    limb_from_ = static_cast<float>(limb_from);
    used_ = 0;
    const auto add = [&](double first, double spacing, int rows) {
        const double circumference = 2 * kPi * (first + (rows - 1) * spacing) / step;
        const int columns = std::max(8, static_cast<int>(std::ceil(circumference)));
        bands_.push_back({static_cast<float>(first), static_cast<float>(1 / spacing), rows, columns, used_});
        used_ += static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns + 1);
    };
    const int inner = static_cast<int>(std::ceil(limb_from / step)) + 1;
    for (int from = 0; from < inner; from += kPictureRings)
        add(from * step, step, std::min(kPictureRings, inner - from) + 1);
    // The middle of a ring is half a step off the limb of the ground; dark rings end them.
    const int below = static_cast<int>(std::ceil(kLimb_px * pixel / fine)) + 3;
    const int above = static_cast<int>(std::ceil((top_m_ / radius_m_ + 0.5 * pixel) / fine)) + kLimbRows + 1;
    add(1 - (below - 0.5) * fine, fine, below + above);
    dark_from_ = static_cast<float>(1 + top_m_ / radius_m_ + 0.5 * pixel + fine);
}

int EarthImpostor::Band::runs() const { return (columns + kRunColumns - 1) / kRunColumns; }

void EarthImpostor::fill_run(const EarthModel& earth, const Spectrum& irradiance, const Band& band, int row,
                             int first) {
    const bool limb = &band == &bands_.back();
    const int looks = limb ? kLimbLooks : 1;
    const double spacing = 1 / static_cast<double>(band.per_step);
    const double b = static_cast<double>(band.first) + row * spacing;
    const auto rows = static_cast<std::size_t>(band.rows);
    Coded* const ring = light_.data() + band.offset + row;
    EarthModel::Ray ray{camera_m_,
                        {},
                        sun_dir_,
                        kWidth_px * pixel_rad_,
                        irradiance,
                        {numbers_, nullptr},
                        EarthModel::kLooksOfPixel};
    const double per_stretch = kEarthFigure.polar_radius_m / kEarthFigure.equatorial_radius_m;
    const int last = std::min(first + kRunColumns, band.columns);
    for (int column = first; column < last; ++column) {
        const double turn = 2 * kPi * column / band.columns;
        const Vec3d out_dir = std::cos(turn) * right_ + std::sin(turn) * down_;
        Spectrum sum;
        for (int i = 0; i < looks; ++i) {
            const double sine = (b + ((i + 0.5) / looks - 0.5) * spacing) * radius_m_ / distance_m_;
            const Vec3d dir = std::sqrt(1 - sine * sine) * ahead_ + sine * out_dir;
            ray.dir = normalized(Vec3d{dir.x, dir.y, dir.z * per_stretch});
            Spectrum weight;
            weight.bin.fill(1);
            earth.add(ray, weight, sum);
        }
        Coded& out = ring[static_cast<std::size_t>(column) * rows];
        for (int k = 0; k < kMaxBins; ++k)
            out[static_cast<std::size_t>(k)] = coded(sum[k] / static_cast<float>(looks));
    }
    if (first == 0) ring[static_cast<std::size_t>(band.columns) * rows] = ring[0];
}

void EarthImpostor::take_memory(std::size_t used) {
    HILCAM_CHECK(used <= light_.capacity());
    if (light_.size() < used) light_.resize(used);
}

void EarthImpostor::begin(const Key& key) {
    camera_m_ = kEarthRadius_m * std::exp(key.camera[2] * kDistanceStep) *
                from_steps(key.camera[0] * kCameraStep_rad, key.camera[1] * kCameraStep_rad);
    sun_dir_ = from_steps(key.sun[0] * kPictureSunStep_rad, key.sun[1] * kPictureSunStep_rad);
    numbers_ = {key.maps[0] * kMapStep, key.maps[1] * kMapStep};
    const Vec3d from_m = stretched(kEarthFigure, camera_m_);
    distance_m_ = length(from_m);
    ahead_ = from_m / -distance_m_;
    right_ = normalized(cross(ahead_, std::abs(ahead_.z) < 0.9 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0}));
    down_ = cross(ahead_, right_);
    place_bands();
    take_memory(used_);
    pieces_ = 0;
    for (const Band& band : bands_) pieces_ += band.rows * band.runs();
    next_piece_.store(0, std::memory_order_relaxed);
}

void EarthImpostor::make_rest(const EarthModel& earth, const Spectrum& sun_irradiance) {
    const int left = pieces_ - next_piece_.load(std::memory_order_relaxed);
    tbb::parallel_for(0, left, [&](int) {
        const int piece = next_piece_.fetch_add(1, std::memory_order_relaxed);
        if (piece < pieces_) make_piece(earth, sun_irradiance, piece);
    });
}

void EarthImpostor::make_piece(const EarthModel& earth, const Spectrum& sun_irradiance, int piece) {
    std::size_t i = 0;
    while (piece >= bands_[i].rows * bands_[i].runs()) piece -= bands_[i].rows * bands_[i].runs(), ++i;
    const int runs = bands_[i].runs();
    fill_run(earth, sun_irradiance, bands_[i], piece / runs, kRunColumns * (piece % runs));
}

EarthImpostor::Tile EarthImpostor::tile(Vec3d camera_m,
                                        const std::array<Vec3d, kNodes * kNodes>& dirs) const {
    const Vec3d from_m = stretched(kEarthFigure, camera_m), kept_m = -distance_m_ * ahead_;
    std::array<double, 9> across{}, down{};
    for (std::size_t i = 0; i < dirs.size(); ++i) {
        // Where it meets the ground, or its point closest to the middle; both as seen from the picture's
        // place.
        const Vec3d dir = normalized(stretched(kEarthFigure, dirs[i]));
        const double to_closest = -dot(from_m, dir);
        const Vec3d closest = from_m + to_closest * dir;
        const double rest = std::max(0.0, radius_m_ * radius_m_ - dot(closest, closest));
        const Vec3d seen = to_place(from_m - kept_m + (to_closest - std::sqrt(rest)) * dir);
        across[i] = seen.x / seen.z, down[i] = seen.y / seen.z;
    }
    // Lagrange parabolas through 0, 1/2, 1, by powers: rows, then columns.
    const auto powers = [](std::array<double, 9>& v) {
        const auto parabola = [](double& p0, double& p1, double& p2) {
            const double c1 = -3 * p0 + 4 * p1 - p2, c2 = 2 * p0 - 4 * p1 + 2 * p2;
            p1 = c1, p2 = c2;
        };
        for (std::size_t i = 0; i < 3; ++i) parabola(v[3 * i], v[3 * i + 1], v[3 * i + 2]);
        for (std::size_t i = 0; i < 3; ++i) parabola(v[i], v[3 + i], v[6 + i]);
        std::array<float, 9> out;
        for (std::size_t i = 0; i < 9; ++i) out[i] = static_cast<float>(v[i]);
        return out;
    };
    return {powers(across), powers(down)};
}

void EarthImpostor::look(const Tile& tile, const Floats& x, const Floats& y, std::size_t count, float share,
                         std::array<Spectrum, kCount>& radiance) const {
    Floats approach, turn;
    place_looks(tile, x.data(), y.data(), static_cast<float>(distance_m_ / radius_m_), approach.data(),
                turn.data());
    Looks looks;
    for (std::size_t i = 0; i < count; ++i) {
        Spot spot = spot_of(approach[i], turn[i]);
        looks.in_column[i] = spot.in_column;
        looks.in_row[i] = spot.in_row;
        looks.stride[i] = static_cast<std::size_t>(spot.band.rows);
        looks.at_limb[i] = spot.limb && !spot.dark;
        if (looks.at_limb[i]) spot.row = weigh_limb(approach[i], share, looks.by_row[i]);
        looks.light[i] = spot.of(light_)->data();
    }
    mix_looks(looks, count, radiance.data());
}

EarthImpostor::Spot EarthImpostor::spot_of(float b, float turn) const {
    const float ring = b * inner_per_b_;
    const bool limb = !(b < limb_from_);
    const auto row = static_cast<std::size_t>(ring);
    const Band& band = limb ? bands_.back() : bands_[row / kPictureRings];
    const float column = turn * static_cast<float>(band.columns);
    const int left = std::min(static_cast<int>(column), band.columns - 1);
    Spot out{band,          0, static_cast<std::size_t>(left), 0, column - static_cast<float>(left), limb,
             b > dark_from_};
    if (out.dark)
        out.row = static_cast<std::size_t>(band.rows) - 2;
    else if (!limb)
        out.row = row % kPictureRings, out.in_row = ring - static_cast<float>(row);
    return out;
}

void EarthImpostor::find_squares(const Tile& tile, const Floats& x, const Floats& y, Squares& squares) const {
    Floats approach, turn;
    place_looks(tile, x.data(), y.data(), static_cast<float>(distance_m_ / radius_m_), approach.data(),
                turn.data());
    for (std::size_t i = 0; i < kCount; ++i) {
        const Spot spot = spot_of(approach[i], turn[i]);
        squares.middle[i] = spot.of(light_);
        squares.column_bytes[i] = static_cast<std::size_t>(spot.band.rows) * sizeof(Coded);
    }
}

// Three places to each side: seven columns, each with the two lines of 64 bytes that hold its places.
void EarthImpostor::Squares::fetch(std::size_t square) const {
    constexpr std::uintptr_t kReach = 3, kLine_bytes = 64;
    const auto at = reinterpret_cast<std::uintptr_t>(middle[square]);
    for (std::uintptr_t c = 0; c <= 2 * kReach; ++c) {
        const std::uintptr_t first =
            at + c * column_bytes[square] - kReach * (column_bytes[square] + sizeof(Coded));
        __builtin_prefetch(reinterpret_cast<const void*>(first));
        __builtin_prefetch(reinterpret_cast<const void*>(first + kLine_bytes));
    }
}

// Averages across the limb: four places have the variance of a pixel, at any angle. Returns the first row.
std::size_t EarthImpostor::weigh_limb(float b, float share, LimbRows& by_row) const {
    const Band& band = bands_.back();
    const float middle = (b - band.first) * band.per_step, reach = share * pixel_ * band.per_step;
    const int row = std::clamp(static_cast<int>(middle - 0.375f * reach), 0, band.rows - kLimbRows);
    by_row.fill(0);
    for (const float off : {-0.375f, -0.125f, 0.125f, 0.375f}) {
        const float at = std::max(0.0f, middle + off * reach - static_cast<float>(row));
        const int low = std::min(static_cast<int>(at), kLimbRows - 2);
        const float part = std::min(1.0f, at - static_cast<float>(low));
        by_row[static_cast<std::size_t>(low)] += 0.25f * (1 - part);
        by_row[static_cast<std::size_t>(low) + 1] += 0.25f * part;
    }
    return static_cast<std::size_t>(row);
}

}  // namespace hilcam
