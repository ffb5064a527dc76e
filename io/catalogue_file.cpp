#include "io/catalogue_file.h"

#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

#include "io/input_file.h"
#include "render/check.h"
#include "render/units.h"

namespace hilcam {
namespace {

constexpr std::string_view kHeader = "hd,ra_deg,dec_deg,pm_ra_mas_yr,pm_dec_mas_yr,v_mag,b_v";
constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 30;  // ten times Tycho-2's stars
constexpr std::size_t kColumns = 7;

// Least and most of each column.
constexpr std::array<std::array<double, 2>, kColumns> kRanges = {
    {{0, 1e7}, {0, 360}, {-90, 90}, {-20000, 20000}, {-20000, 20000}, {-3, 30}, {-3, 10}}};

bool parse_row(std::string_view line, std::array<double, kColumns>& values) {
    for (std::size_t i = 0; i < kColumns; ++i) {
        const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), values[i]);
        if (error != std::errc{} || !(values[i] >= kRanges[i][0] && values[i] <= kRanges[i][1])) return false;
        line.remove_prefix(static_cast<std::size_t>(end - line.data()));
        const bool last = i + 1 == kColumns;
        if (last) return line.empty() || line == "\r";
        if (!line.starts_with(',')) return false;
        line.remove_prefix(1);
    }
    return false;
}

}  // namespace

StarCatalogue load_catalogue(const std::filesystem::path& file) {
    InputStream in(file, {kMostBytes, "a star catalogue in CSV"});
    constexpr double kMas_rad = kArcsecond_rad * 1e-3;
    StarCatalogue catalogue;
    std::string line;
    std::array<double, kColumns> v{};
    for (int number = 1; std::getline(in, line); ++number) {
        if (line.empty() || line.starts_with('#') || line.starts_with(kHeader)) continue;
        if (!parse_row(line, v))
            throw InputError(file.string() + ":" + std::to_string(number) + ": found '" + line.substr(0, 60) +
                             "'; accepted: " + std::string(kHeader));
        catalogue.stars.push_back({static_cast<int>(v[0]), v[1] * kDegree_rad, v[2] * kDegree_rad,
                                   v[3] * kMas_rad, v[4] * kMas_rad, v[5], v[6]});
    }
    if (catalogue.stars.empty()) throw InputError(file.string() + ": holds no star");
    return catalogue;
}

}  // namespace hilcam
