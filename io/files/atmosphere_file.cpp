#include "io/files/atmosphere_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <string_view>

#include "io/system/input_file.h"
#include "io/system/plain_number.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr std::size_t kAxes = AtmosphereTable::kAxes;
constexpr std::size_t kMaxCells = 2'000'000;
constexpr std::uintmax_t kMaxTableBytes = std::uintmax_t{4} << 30;  // 2 KiB a cell
constexpr std::array<const char*, kAxes> kAxisNames = {"sun_zenith_deg", "view_zenith_deg", "azimuth_deg",
                                                       "height_km"};
constexpr std::array<double, kAxes> kAxisMost = {90, 90, 180, 1e6};
constexpr std::array<double, kAxes> kAxisUnit = {kDegree_rad, kDegree_rad, kDegree_rad, 1000};

using Geometry = std::array<double, kAxes>;

// What one wavelength of one geometry says.
struct Sample {
    double wavelength_um = 0;
    double tau_1 = 0, tau_2 = 0, radiance_sr = 0, sky = 0;
};
using Samples = std::map<Geometry, std::vector<Sample>>;

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
    throw InputError(where + ": " + what);
}

bool to_number(std::string_view text, double& value) {
    while (text.starts_with(' ')) text.remove_prefix(1);
    while (text.ends_with(' ') || text.ends_with('\r')) text.remove_suffix(1);
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
}

std::vector<std::string> split(const std::string& line, char separator) {
    std::vector<std::string> cells;
    std::string cell;
    for (std::istringstream in(line); std::getline(in, cell, separator);) {
        if (cell.ends_with('\r')) cell.pop_back();
        cells.push_back(cell);
    }
    return cells;
}

Geometry read_geometry(const std::string& where, const std::vector<std::string>& cells) {
    Geometry out{};
    for (std::size_t k = 0; k < kAxes; ++k)
        if (!to_number(cells[k], out[k]) || out[k] < 0 || out[k] > kAxisMost[k])
            refuse(where, std::string(kAxisNames[k]) + ": found " + in_quotes(cells[k]) +
                              "; accepted: a number from 0 to " + plain(kAxisMost[k]));
    return out;
}

void require_physical(const std::string& where, const Sample& s) {
    if (!(s.tau_1 >= 0 && s.tau_1 <= 1 && s.tau_2 >= 0 && s.tau_2 <= 1))
        refuse(where,
               "a transmittance is not within 0 to 1: tau_1 " + plain(s.tau_1) + ", tau_2 " + plain(s.tau_2));
    if (!(s.radiance_sr >= 0 && s.sky >= 0 && s.radiance_sr < 100 && s.sky < 10))
        refuse(where, "path radiance or sky irradiance is negative or more than the Sun can give");
}

// --- MODTRAN's text table

// The columns of a run by their names.
std::vector<Sample> read_run(const std::filesystem::path& file, const Geometry& geometry) {
    InputStream in(file, {kMaxTableBytes, "a MODTRAN text table (tape7.scn)"});
    std::vector<std::string> names;
    std::string line;
    int number = 0;
    while (names.empty() && std::getline(in, line)) {
        ++number;
        std::istringstream words(line);
        std::string word;
        if (!(words >> word) || !(word.starts_with("WAVLEN") || word.starts_with("FREQ"))) continue;
        names.push_back(word);
        while (words >> word) names.push_back(word);
    }
    const auto column = [&](std::initializer_list<const char*> accepted) {
        for (const char* name : accepted) {
            const auto at = std::find(names.begin(), names.end(), name);
            if (at != names.end()) return static_cast<std::size_t>(at - names.begin());
        }
        refuse(file.string() + ":" + std::to_string(number), std::string("no column ") + *accepted.begin());
    };
    if (names.empty()) refuse(file.string(), "has no line of column names that begins with WAVLEN or FREQ");
    const std::size_t trans = column({"TOT_TRANS", "TRANS"}), scatter = column({"SOL_SCAT"}),
                      ground = column({"GRND_RFLT"}), direct = column({"DRCT_RFLT"}),
                      path = column({"REF_SOL"}), sun = column({"TOA_SUN", "SOL@OBS"});
    if (names[sun] == "SOL@OBS" && geometry[AtmosphereTable::kHeight] < 100)
        refuse(file.string(),
               "has no column TOA_SUN, and SOL@OBS is the Sun's only for an observer above 100 km");
    const bool frequency = names[0].starts_with("FREQ"),
               nanometres = names[0].find("NM") != std::string::npos;
    const double mu_s = std::cos(geometry[AtmosphereTable::kSunZenith] * kDegree_rad);
    std::vector<Sample> samples;
    while (std::getline(in, line)) {
        ++number;
        std::istringstream words(line);
        std::vector<double> v;
        std::string word;
        double value = 0;
        while (words >> word && to_number(word, value)) v.push_back(value);
        if (v.empty()) continue;  // units
        if (v.front() <= -9999) break;
        const std::string where = file.string() + ":" + std::to_string(number);
        if (v.size() < names.size())
            refuse(where, "found " + std::to_string(v.size()) + " numbers for " +
                              std::to_string(names.size()) + " columns");
        if (v[0] <= 0) refuse(where, "found " + plain(v[0]) + " as wavelength or frequency");
        Sample s;
        s.wavelength_um = frequency ? 1e4 / v[0] : (nanometres ? v[0] * 1e-3 : v[0]);
        if (!(v[sun] > 0)) refuse(where, "the Sun's irradiance is not above 0");
        // tau_1 from the way Sun - ground - observer; the diffuse part of the ground's light against its
        // direct one.
        s.tau_2 = v[trans];
        s.tau_1 = s.tau_2 > 0 ? std::min(1.0, v[path] / (v[sun] * s.tau_2)) : 0;
        s.radiance_sr = v[scatter] / v[sun];
        s.sky = v[direct] > 0 ? std::max(0.0, v[ground] - v[direct]) / v[direct] * mu_s * s.tau_1 : 0;
        require_physical(where, s);
        samples.push_back(s);
    }
    if (samples.empty()) refuse(file.string(), "holds no row of numbers");
    return samples;
}

// --- the two kinds of CSV

Samples read_rows(const std::filesystem::path& file) {
    InputStream in(file, {kMaxTableBytes, "a table of an atmosphere in CSV"});
    const std::string grid = "sun_zenith_deg,view_zenith_deg,azimuth_deg,height_km,";
    const std::string values = grid + "wavelength_um,tau_1,tau_2,path_radiance_sr,sky_irradiance",
                      runs = grid + "file";
    Samples out;
    std::string line;
    std::size_t columns = 0;
    for (int number = 1; std::getline(in, line); ++number) {
        const std::string where = file.string() + ":" + std::to_string(number);
        if (line.ends_with('\r')) line.pop_back();
        if (line.empty() || line.starts_with('#')) continue;
        if (columns == 0) {
            if (line != values && line != runs)
                refuse(where, "found " + in_quotes(line) + "; accepted: '" + values + "' or '" + runs + "'");
            columns = line == values ? kAxes + 5 : kAxes + 1;
            continue;
        }
        const std::vector<std::string> cells = split(line, ',');
        if (cells.size() != columns)
            refuse(where, "found " + std::to_string(cells.size()) +
                              " columns; accepted: " + std::to_string(columns));
        const Geometry geometry = read_geometry(where, cells);
        if (columns == kAxes + 1) {
            if (!out.emplace(geometry, read_run(file.parent_path() / cells[kAxes], geometry)).second)
                refuse(where, "the same geometry as a line before");
            continue;
        }
        std::array<double, 5> v{};
        for (std::size_t k = 0; k < v.size(); ++k)
            if (!to_number(cells[kAxes + k], v[k]))
                refuse(where, "found " + in_quotes(cells[kAxes + k]) + "; accepted: a number");
        const Sample sample{v[0], v[1], v[2], v[3], v[4]};
        if (!(sample.wavelength_um >= 0.1 && sample.wavelength_um <= 100))
            refuse(where, "wavelength_um: accepted: 0.1 to 100");
        require_physical(where, sample);
        out[geometry].push_back(sample);
    }
    if (out.empty()) refuse(file.string(), "holds no geometry");
    return out;
}

AtmosphereTable::Cell cell_of(const std::string& where, std::vector<Sample> samples,
                              const SpectralGrid& grid) {
    std::sort(samples.begin(), samples.end(),
              [](const Sample& a, const Sample& b) { return a.wavelength_um < b.wavelength_um; });
    std::array<Curve, 4> curves;
    for (const Sample& s : samples) {
        if (!curves[0].wavelength_um.empty() && s.wavelength_um <= curves[0].wavelength_um.back())
            refuse(where, "wavelength " + plain(s.wavelength_um) + " um is given twice");
        const std::array<double, 4> values = {s.tau_1, s.tau_2, s.radiance_sr, s.sky};
        for (std::size_t k = 0; k < 4; ++k) {
            curves[k].wavelength_um.push_back(s.wavelength_um);
            curves[k].value.push_back(values[k]);
        }
    }
    if (samples.size() < 2)
        refuse(where, "has one wavelength; needed: at least two, about the scenario's bins");
    curves[0].where = where;
    require_cover(curves[0], grid, "wavelengths");
    return {grid.average(curves[0]), grid.average(curves[1]), grid.average(curves[2]),
            grid.average(curves[3])};
}

std::string name_of(const Geometry& g) {
    std::string out;
    for (std::size_t k = 0; k < kAxes; ++k) {
        if (k > 0) out.append(", ");
        out.append(kAxisNames[k]).append(" ").append(plain(g[k]));
    }
    return out;
}

}  // namespace

AtmosphereTable read_atmosphere(const std::filesystem::path& file, const SpectralGrid& grid) {
    const Samples samples = read_rows(file);
    std::array<std::vector<double>, kAxes> axes;
    for (const auto& [geometry, unused] : samples)
        for (std::size_t k = 0; k < kAxes; ++k) axes[k].push_back(geometry[k]);
    std::size_t cells = 1;
    for (auto& axis : axes) {
        std::sort(axis.begin(), axis.end());
        axis.erase(std::unique(axis.begin(), axis.end()), axis.end());
        cells *= axis.size();
        if (cells > kMaxCells)
            refuse(file.string(), "its geometries make more than two million combinations");
    }
    AtmosphereTable table;
    for (std::size_t i = 0; i < cells; ++i) {
        Geometry g{};
        for (std::size_t k = kAxes, rest = i; k-- > 0; rest /= axes[k].size())
            g[k] = axes[k][rest % axes[k].size()];
        const auto found = samples.find(g);
        if (found == samples.end()) refuse(file.string(), "has no geometry " + name_of(g));
        table.cells.push_back(cell_of(file.string() + ", " + name_of(g), found->second, grid));
    }
    for (std::size_t k = 0; k < kAxes; ++k)
        for (const double value : axes[k]) table.axes[k].push_back(value * kAxisUnit[k]);
    return table;
}

}  // namespace hilcam
