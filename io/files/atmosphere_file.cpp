#include "io/files/atmosphere_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/system/input_file.h"
#include "io/system/text_number.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr std::size_t kTableAxes = AtmosphereTable::kAxes;
constexpr std::size_t kMaxCells = 2'000'000;
constexpr std::uintmax_t kMaxTableBytes = std::uintmax_t{4} << 30;  // 2 KiB a cell
constexpr std::array<const char*, kTableAxes> kAxisNames = {"sun_zenith_deg", "view_zenith_deg",
                                                            "azimuth_deg", "height_km"};
constexpr std::array<double, kTableAxes> kAxisMost = {90, 90, 180, 1e6};
constexpr std::array<double, kTableAxes> kAxisUnit = {kDegree_rad, kDegree_rad, kDegree_rad, 1000};

using Geometry = std::array<double, kTableAxes>;

// The values at one wavelength of one geometry.
struct Sample {
    double wavelength_um = 0;
    double tau_1 = 0, tau_2 = 0, radiance_sr = 0, sky = 0;
};
using Samples = std::map<Geometry, std::vector<Sample>>;

[[noreturn]] void refuse_table(const std::string& where, const std::string& what) {
    throw InputError(where + ": " + what);
}

bool to_number(std::string_view text, double& value) {
    while (text.starts_with(' ')) text.remove_prefix(1);
    while (text.ends_with(' ') || text.ends_with('\r')) text.remove_suffix(1);
    const std::optional<double> number = number_of(text);
    if (number) value = *number;
    return number.has_value();
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
    for (std::size_t k = 0; k < kTableAxes; ++k)
        if (!to_number(cells[k], out[k]) || out[k] < 0 || out[k] > kAxisMost[k])
            refuse_table(where, std::string(kAxisNames[k]) + ": found " + in_quotes(cells[k]) +
                                    "; accepted: a number from 0 to " + plain(kAxisMost[k]));
    return out;
}

void require_physical(const std::string& where, const Sample& s) {
    if (!(s.tau_1 >= 0 && s.tau_1 <= 1 && s.tau_2 >= 0 && s.tau_2 <= 1))
        refuse_table(where, "a transmittance is not within 0 to 1: tau_1 " + plain(s.tau_1) + ", tau_2 " +
                                plain(s.tau_2));
    if (!(s.radiance_sr >= 0 && s.sky >= 0 && s.radiance_sr < 100 && s.sky < 10))
        refuse_table(where, "path radiance or sky irradiance is negative or more than the Sun can give");
}

// --- MODTRAN's text table

// The columns of a run: their names, with underscores for blanks, and where each ends in its line.
struct RunColumns {
    struct Column {
        std::string name;
        std::size_t end = 0;
    };
    std::vector<Column> all;
    bool is_fixed = false;  // names of two words: fields have fixed places and may be blank

    std::optional<std::size_t> find(std::string_view name) const {
        for (std::size_t i = 0; i < all.size(); ++i)
            if (all[i].name == name) return i;
        return std::nullopt;
    }
};

// Reads a line of column names. MODTRAN 3 and 4 write names of two words, which MODTRAN 5 joins with an
// underscore.
RunColumns columns_in(const std::string& line) {
    constexpr std::array<std::pair<const char*, const char*>, 15> kPairs = {{{"TOT", "TRANS"},
                                                                             {"TOTAL", "TRANS"},
                                                                             {"PTH", "THRML"},
                                                                             {"THRML", "SCT"},
                                                                             {"THRML", "EMIS"},
                                                                             {"SURF", "EMIS"},
                                                                             {"SOL", "SCAT"},
                                                                             {"SING", "SCAT"},
                                                                             {"GRND", "RFLT"},
                                                                             {"DRCT", "RFLT"},
                                                                             {"TOTAL", "RAD"},
                                                                             {"REF", "SOL"},
                                                                             {"TOA", "SUN"},
                                                                             {"WAVLEN", "MCRN"},
                                                                             {"WAVLEN", "NM"}}};
    RunColumns out;
    for (std::size_t at = line.find_first_not_of(" \t\r"); at != std::string::npos;) {
        const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
        const std::string word = line.substr(at, end - at);
        const bool joins =
            !out.all.empty() && std::any_of(kPairs.begin(), kPairs.end(), [&](const auto& pair) {
                return out.all.back().name == pair.first && word == pair.second;
            });
        out.is_fixed = out.is_fixed || joins;
        if (joins)
            out.all.back().name += "_" + word, out.all.back().end = end;
        else
            out.all.push_back({word, end});
        at = line.find_first_not_of(" \t\r", end);
    }
    return out;
}

// Returns the width of a column in MODTRAN 3 and 4: F7.4 in tape7.scn and F11.6 in tape7 for the
// transmittance, E11.3 and E11.4 for radiances, E9.2 for the Sun, F8.3 for the depth (the programs' own
// formats of tape7). 0: another column.
std::size_t fixed_width(const std::string& name) {
    if (name == "TRANS") return 7;
    if (name == "REF_SOL" || name == "SOL@OBS") return 9;
    if (name == "DEPTH") return 8;
    return name.find('_') != std::string::npos ? 11 : 0;
}

// Reads a number as Fortran writes it, which omits the letter of an exponent with three digits (1.36-105).
bool to_fortran_number(std::string_view text, double& value) {
    if (to_number(text, value)) return true;
    const std::size_t sign = text.find_last_of("+-");
    if (sign == std::string_view::npos || sign == 0 ||
        !std::isdigit(static_cast<unsigned char>(text[sign - 1])))
        return false;
    return to_number(std::string(text.substr(0, sign)) + "E" + std::string(text.substr(sign)), value);
}

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

// Returns where column i begins and ends in a row. Columns before the first radiances have the width that is
// left for them.
std::pair<std::size_t, std::size_t> place_of(const RunColumns& columns, std::size_t i) {
    const auto begin_of = [&](std::size_t k) {
        const RunColumns::Column& c = columns.all[k];
        const std::size_t width = fixed_width(c.name);
        return width > 0 && width <= c.end ? c.end - width : columns.all[k - 1].end;
    };
    if (i > 0) return {begin_of(i), columns.all[i].end};
    return {0, columns.all.size() > 1 ? begin_of(1) : columns.all[0].end};
}

// Splits a row with blank fields by the places of its columns; NaN for these and for fields that overflowed
// (***). Nothing when a number continues in the next field: such a row has another layout.
std::vector<double> row_by_places(const RunColumns& columns, const std::string& line) {
    const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
    std::vector<double> out;
    for (std::size_t i = 0; i < columns.all.size(); ++i) {
        auto [begin, end] = place_of(columns, i);
        if (end < line.size() && end > 0 && is_digit(line[end - 1]) &&
            (is_digit(line[end]) || line[end] == '.' || line[end] == 'E'))
            return {};
        begin = std::min(begin, line.size()), end = std::clamp(end, begin, line.size());
        std::string_view field = std::string_view(line).substr(begin, end - begin);
        while (field.starts_with(' ')) field.remove_prefix(1);
        while (field.ends_with(' ') || field.ends_with('\r')) field.remove_suffix(1);
        double value = kAbsent;
        out.push_back(to_fortran_number(field, value) ? value : kAbsent);
    }
    return out;
}

// Returns a row's numbers, one per column; nothing for a line that does not begin with a number. Numbers are
// separated by blanks or, where columns of MODTRAN 3 and 4 are blank or touch, found by their places.
std::vector<double> row_of(const RunColumns& columns, const std::string& line) {
    std::istringstream words(line);
    std::vector<double> out;
    for (std::string word; words >> word;) {
        double value = kAbsent;
        if (!to_fortran_number(word, value) && word.find_first_not_of('*') != std::string::npos) break;
        out.push_back(value);
    }
    if (out.empty() || out.front() <= -9999 || out.size() >= columns.all.size() || !columns.is_fixed)
        return out;
    const std::vector<double> placed = row_by_places(columns, line);
    return !placed.empty() && std::isfinite(placed.front()) ? placed : out;
}

// The places of the columns that are used.
struct RunPlaces {
    std::size_t trans, scatter, ground, direct, path, sun;
};

RunPlaces places_of(const std::filesystem::path& file, int number, const RunColumns& columns) {
    const auto column = [&](std::initializer_list<const char*> accepted) {
        for (const char* const name : accepted)
            if (const auto at = columns.find(name)) return *at;
        refuse_table(file.string() + ":" + std::to_string(number),
                     std::string("no column ") + *accepted.begin());
    };
    return {column({"TOT_TRANS", "TOTAL_TRANS", "TRANS"}),
            column({"SOL_SCAT"}),
            column({"GRND_RFLT"}),
            column({"DRCT_RFLT"}),
            column({"REF_SOL"}),
            column({"TOA_SUN", "SOL@OBS"})};
}

// Makes a sample of a row. tau_1 comes from the path Sun - ground - observer, the sky from the ratio of
// diffuse to direct light reflected by the ground.
Sample sample_of(const std::string& where, const RunPlaces& at, const std::vector<double>& v, double mu_s) {
    for (const std::size_t used : {at.trans, at.scatter, at.ground, at.direct, at.path, at.sun})
        if (used >= v.size() || !std::isfinite(v[used]))
            refuse_table(where, "column " + std::to_string(used + 1) +
                                    " has no number; accepted: a run that writes it, of a sunlit ground");
    if (!(v[at.sun] > 0)) refuse_table(where, "the Sun's irradiance is not above 0");
    Sample s;
    s.tau_2 = v[at.trans];
    s.tau_1 = s.tau_2 > 0 ? std::min(1.0, v[at.path] / (v[at.sun] * s.tau_2)) : 0;
    s.radiance_sr = v[at.scatter] / v[at.sun];
    s.sky = v[at.direct] > 0 ? std::max(0.0, v[at.ground] - v[at.direct]) / v[at.direct] * mu_s * s.tau_1 : 0;
    return s;
}

// Reads lines up to the one with the columns' names.
RunColumns find_columns(InputStream& in, int& number) {
    for (std::string line; std::getline(in, line);) {
        ++number;
        RunColumns columns = columns_in(line);
        const bool begins = !columns.all.empty() && (columns.all[0].name.starts_with("WAVLEN") ||
                                                     columns.all[0].name.starts_with("FREQ"));
        if (begins && columns.all.size() > 1) return columns;
    }
    return {};
}

std::vector<Sample> read_run(const std::filesystem::path& file, const Geometry& geometry) {
    InputStream in(file, {kMaxTableBytes, "a MODTRAN text table (tape7.scn)"});
    int number = 0;
    const RunColumns columns = find_columns(in, number);
    if (columns.all.empty())
        refuse_table(file.string(), "has no line of column names that begins with WAVLEN or FREQ");
    const RunPlaces at = places_of(file, number, columns);
    if (columns.all[at.sun].name == "SOL@OBS" && geometry[AtmosphereTable::kHeight] < 100)
        refuse_table(file.string(),
                     "has no column TOA_SUN, and SOL@OBS is the Sun's only for an observer above 100 km");
    const bool frequency = columns.all[0].name.starts_with("FREQ"),
               nanometres = columns.all[0].name.find("NM") != std::string::npos;
    const double mu_s = std::cos(geometry[AtmosphereTable::kSunZenith] * kDegree_rad);
    std::vector<Sample> samples;
    for (std::string line; std::getline(in, line);) {
        ++number;
        const std::vector<double> v = row_of(columns, line);
        if (v.empty()) continue;  // units
        if (v.front() <= -9999) break;
        const std::string where = file.string() + ":" + std::to_string(number);
        if (v.size() < columns.all.size())
            refuse_table(where, "found " + std::to_string(v.size()) + " numbers for " +
                                    std::to_string(columns.all.size()) + " columns");
        if (!(v[0] > 0)) refuse_table(where, "found " + plain(v[0]) + " as wavelength or frequency");
        Sample s = sample_of(where, at, v, mu_s);
        s.wavelength_um = frequency ? 1e4 / v[0] : (nanometres ? v[0] * 1e-3 : v[0]);
        require_physical(where, s);
        samples.push_back(s);
    }
    if (samples.empty()) refuse_table(file.string(), "holds no row of numbers");
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
                refuse_table(where,
                             "found " + in_quotes(line) + "; accepted: '" + values + "' or '" + runs + "'");
            columns = line == values ? kTableAxes + 5 : kTableAxes + 1;
            continue;
        }
        const std::vector<std::string> cells = split(line, ',');
        if (cells.size() != columns)
            refuse_table(where, "found " + std::to_string(cells.size()) +
                                    " columns; accepted: " + std::to_string(columns));
        const Geometry geometry = read_geometry(where, cells);
        if (columns == kTableAxes + 1) {
            if (!out.emplace(geometry, read_run(file.parent_path() / cells[kTableAxes], geometry)).second)
                refuse_table(where, "the same geometry as a line before");
            continue;
        }
        std::array<double, 5> v{};
        for (std::size_t k = 0; k < v.size(); ++k)
            if (!to_number(cells[kTableAxes + k], v[k]))
                refuse_table(where, "found " + in_quotes(cells[kTableAxes + k]) + "; accepted: a number");
        const Sample sample{v[0], v[1], v[2], v[3], v[4]};
        if (!(sample.wavelength_um >= 0.1 && sample.wavelength_um <= 100))
            refuse_table(where, "wavelength_um: accepted: 0.1 to 100");
        require_physical(where, sample);
        out[geometry].push_back(sample);
    }
    if (out.empty()) refuse_table(file.string(), "holds no geometry");
    return out;
}

AtmosphereTable::Cell cell_of(const std::string& where, std::vector<Sample> samples,
                              const SpectralGrid& grid) {
    std::sort(samples.begin(), samples.end(),
              [](const Sample& a, const Sample& b) { return a.wavelength_um < b.wavelength_um; });
    std::array<Curve, 4> curves;
    for (const Sample& s : samples) {
        if (!curves[0].wavelength_um.empty() && s.wavelength_um <= curves[0].wavelength_um.back())
            refuse_table(where, "wavelength " + plain(s.wavelength_um) + " um is given twice");
        const std::array<double, 4> values = {s.tau_1, s.tau_2, s.radiance_sr, s.sky};
        for (std::size_t k = 0; k < 4; ++k) {
            curves[k].wavelength_um.push_back(s.wavelength_um);
            curves[k].value.push_back(values[k]);
        }
    }
    if (samples.size() < 2)
        refuse_table(where, "has one wavelength; needed: at least two, about the scenario's bins");
    curves[0].where = where;
    require_cover(curves[0], grid, "wavelengths");
    return {grid.average(curves[0]), grid.average(curves[1]), grid.average(curves[2]),
            grid.average(curves[3])};
}

std::string name_of(const Geometry& g) {
    std::string out;
    for (std::size_t k = 0; k < kTableAxes; ++k) {
        if (k > 0) out.append(", ");
        out.append(kAxisNames[k]).append(" ").append(plain(g[k]));
    }
    return out;
}

}  // namespace

AtmosphereTable read_atmosphere(const std::filesystem::path& file, const SpectralGrid& grid) {
    const Samples samples = read_rows(file);
    std::array<std::vector<double>, kTableAxes> axes;
    for (const auto& [geometry, unused] : samples)
        for (std::size_t k = 0; k < kTableAxes; ++k) axes[k].push_back(geometry[k]);
    std::size_t cells = 1;
    for (auto& axis : axes) {
        std::sort(axis.begin(), axis.end());
        axis.erase(std::unique(axis.begin(), axis.end()), axis.end());
        cells *= axis.size();
        if (cells > kMaxCells)
            refuse_table(file.string(), "its geometries make more than two million combinations");
    }
    AtmosphereTable table;
    for (std::size_t i = 0; i < cells; ++i) {
        Geometry g{};
        for (std::size_t k = kTableAxes, rest = i; k-- > 0; rest /= axes[k].size())
            g[k] = axes[k][rest % axes[k].size()];
        const auto found = samples.find(g);
        if (found == samples.end()) refuse_table(file.string(), "has no geometry " + name_of(g));
        table.cells.push_back(cell_of(file.string() + ", " + name_of(g), found->second, grid));
    }
    for (std::size_t k = 0; k < kTableAxes; ++k)
        for (const double value : axes[k]) table.axes[k].push_back(value * kAxisUnit[k]);
    return table;
}

}  // namespace hilcam
