#include "io/files/brdf_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "io/system/input_file.h"
#include "render/scene/color_bands.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr std::string_view kHeader = "theta_i_deg,phi_deg,theta_o_deg,wavelength_um,brdf_sr";
constexpr std::size_t kRowValues = 5;
constexpr std::array<std::array<double, 2>, kRowValues> kRanges = {
    {{0, 90}, {0, 180}, {0, 90}, {0.1, 100}, {0, 1e6}}};
constexpr std::array<const char*, 4> kAxisKeys = {"theta_i_deg", "phi_deg", "theta_o_deg", "wavelength_um"};
constexpr std::size_t kMaxValues = 50'000'000;
constexpr std::uintmax_t kMaxBrdfBytes = std::uintmax_t{4} << 30;  // 80 a value

using Row = std::array<double, kRowValues>;

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
    throw InputError(file.string() + ": " + what);
}

bool parse_row(std::string_view line, Row& row) {
    if (line.ends_with('\r')) line.remove_suffix(1);
    for (std::size_t i = 0; i < kRowValues; ++i) {
        const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), row[i]);
        if (error != std::errc{} || !(row[i] >= kRanges[i][0] && row[i] <= kRanges[i][1])) return false;
        line.remove_prefix(static_cast<std::size_t>(end - line.data()));
        if (i + 1 == kRowValues) return line.empty();
        if (!line.starts_with(',')) return false;
        line.remove_prefix(1);
    }
    return false;
}

struct Sheet {
    std::vector<Row> rows;
    std::array<std::vector<double>, 4> axes;
    bool hold = false;

    std::size_t index(const Row& row) const {
        std::size_t out = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const auto at = std::lower_bound(axes[k].begin(), axes[k].end(), row[k]);
            out = out * axes[k].size() + static_cast<std::size_t>(at - axes[k].begin());
        }
        return out;
    }
};

Sheet read_sheet(const std::filesystem::path& file) {
    InputStream in(file, {kMaxBrdfBytes, "a BRDF in CSV"});
    Sheet sheet;
    std::string line;
    bool headed = false;
    for (int number = 1; std::getline(in, line); ++number) {
        const auto at = [&] { return file.string() + ":" + std::to_string(number) + ": "; };
        if (line.starts_with("# hold")) sheet.hold = true;
        if (line.empty() || line == "\r" || line.starts_with('#')) continue;
        if (!headed) {
            if (!line.starts_with(kHeader))
                throw InputError(at() + "found " + in_quotes(line) + "; accepted: the header " +
                                 std::string(kHeader));
            headed = true;
            continue;
        }
        Row row;
        if (!parse_row(line, row))
            throw InputError(at() + "found " + in_quotes(line) + "; accepted: " + std::string(kHeader) +
                             " with angles of 0 to 90 (phi to 180) and a value from 0");
        if (sheet.rows.size() >= kMaxValues) throw InputError(at() + "more than 50 million values");
        sheet.rows.push_back(row);
    }
    if (sheet.rows.empty()) refuse(file, "holds no value");
    for (std::size_t k = 0; k < 4; ++k) {
        std::vector<double>& axis = sheet.axes[k];
        for (const Row& row : sheet.rows) axis.push_back(row[k]);
        std::sort(axis.begin(), axis.end());
        axis.erase(std::unique(axis.begin(), axis.end()), axis.end());
    }
    return sheet;
}

void require_angles(const std::filesystem::path& file, const Sheet& sheet) {
    constexpr std::array<double, 3> kLast = {90, 180, 90};
    for (std::size_t k = 0; k < 3; ++k) {
        const std::vector<double>& axis = sheet.axes[k];
        const bool held = sheet.hold && k != 1;
        if (axis.front() > 0 || (axis.back() < kLast[k] && !held))
            refuse(file, std::string(kAxisKeys[k]) + " reaches from " + plain(axis.front()) + " to " +
                             plain(axis.back()) + "; needed: 0 to " + plain(kLast[k]) +
                             (k == 1 ? "" : ", or a line '# hold' to keep the last values up to there"));
    }
}

BrdfTable read_csv(const std::filesystem::path& file, const SpectralGrid& grid) {
    const Sheet sheet = read_sheet(file);
    require_angles(file, sheet);
    const std::size_t waves = sheet.axes[3].size();
    std::size_t cells = 1;
    for (const auto& axis : sheet.axes) {
        cells *= axis.size();
        if (cells > kMaxValues)
            refuse(file, "its angles and wavelengths make more than 50 million combinations");
    }
    std::vector<double> values(cells, -1);
    for (const Row& row : sheet.rows) values[sheet.index(row)] = row[4];
    for (std::size_t i = 0; i < cells; ++i) {
        if (values[i] >= 0) continue;
        std::array<std::size_t, 4> at{};
        for (std::size_t k = 4, rest = i; k-- > 0; rest /= sheet.axes[k].size())
            at[k] = rest % sheet.axes[k].size();
        std::string where;
        for (std::size_t k = 0; k < 4; ++k)
            where += (k ? ", " : "") + std::string(kAxisKeys[k]) + " " + plain(sheet.axes[k][at[k]]);
        refuse(file, "has no value at " + where);
    }
    Curve curve{sheet.axes[3], std::vector<double>(waves), file.string()};
    require_cover(curve, grid, "wavelength_um");
    if (waves == 1) refuse(file, "has one wavelength; needed: at least two, about the scenario's bins");
    std::vector<Spectrum> spectra(cells / waves);
    for (std::size_t i = 0; i < spectra.size(); ++i) {
        std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(i * waves), waves, curve.value.begin());
        spectra[i] = grid.average(curve);
    }
    std::array<std::vector<float>, 3> axes;
    for (std::size_t k = 0; k < 3; ++k)
        for (const double degrees : sheet.axes[k])
            axes[k].push_back(static_cast<float>(degrees * kDegree_rad));
    return {BrdfTable::Layout::kAngles, std::move(axes), std::move(spectra)};
}

BrdfTable read_merl(const std::filesystem::path& file, const SpectralGrid& grid) {
    constexpr std::size_t kThetaH = 90, kThetaD = 90, kPhiD = 180, kCells = kThetaH * kThetaD * kPhiD;
    constexpr std::size_t kBytes = 3 * sizeof(std::int32_t) + 3 * kCells * sizeof(double);
    InputStream in(file, {kMaxBrdfBytes, "a BRDF in MERL's binary format"});
    if (in.bytes() != kBytes)
        refuse(file,
               "has " + std::to_string(in.bytes()) + " bytes; a MERL BRDF has " + std::to_string(kBytes));
    std::array<std::int32_t, 3> counts{};
    in.read(reinterpret_cast<char*>(counts.data()), sizeof counts);
    if (counts != std::array<std::int32_t, 3>{90, 90, 180})
        refuse(file, "begins with " + std::to_string(counts[0]) + " " + std::to_string(counts[1]) + " " +
                         std::to_string(counts[2]) + "; a MERL BRDF begins with 90 90 180");
    std::vector<double> values(3 * kCells);
    in.read(reinterpret_cast<char*>(values.data()),
            static_cast<std::streamsize>(values.size() * sizeof(double)));

    // Scales of the database's own reader (Matusik et al. 2003).
    constexpr std::array<double, 3> kScale = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};
    const ColorBands bands(grid);
    std::vector<Spectrum> spectra(kCells);
    for (std::size_t i = 0; i < kCells; ++i) {
        std::array<float, 3> rgb{};
        for (std::size_t c = 0; c < 3; ++c) {
            const double value = values[c * kCells + i] * kScale[c];
            if (!std::isfinite(value))
                refuse(file, "value " + std::to_string(c * kCells + i) + " is no finite number");
            rgb[c] = static_cast<float>(std::max(0.0, value));
        }
        spectra[i] = bands.spectrum({rgb[0], rgb[1], rgb[2]});
    }
    std::array<std::vector<float>, 3> axes;
    // The cells of theta_h are uniform in its square root, which is the axis of the table.
    for (std::size_t i = 0; i < kThetaH; ++i)
        axes[0].push_back(static_cast<float>(std::sqrt(0.5 * kPi) * static_cast<double>(i) / kThetaH));
    for (std::size_t i = 0; i < kThetaD; ++i)
        axes[1].push_back(static_cast<float>(static_cast<double>(i) * kDegree_rad));
    for (std::size_t i = 0; i < kPhiD; ++i)
        axes[2].push_back(static_cast<float>(static_cast<double>(i) * kDegree_rad));
    return {BrdfTable::Layout::kHalfVector, std::move(axes), std::move(spectra)};
}

}  // namespace

BrdfTable read_brdf(const std::filesystem::path& file, const SpectralGrid& grid) {
    if (file.extension() == ".csv") return read_csv(file, grid);
    if (file.extension() == ".binary") return read_merl(file, grid);
    refuse(file, "accepted: a BRDF in .csv, or MERL's .binary");
}

}  // namespace hilcam
