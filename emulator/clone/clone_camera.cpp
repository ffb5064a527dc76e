#include "emulator/clone/clone_camera.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "emulator/clone/clone_figures.h"
#include "io/config/config_yaml.h"
#include "io/files/defect_list.h"
#include "io/images/fits_file.h"
#include "io/system/input_file.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLine = 108;
constexpr std::uintmax_t kMostYaml_bytes = std::uintmax_t{4} << 20;

// Keys that the measurement always replaces.
const std::vector<std::string> kReplaced = {
    "name",          "source",       "bits",          "gain_dn_e",     "gain_e_dn",
    "offset_dn",     "read_noise_e", "row_noise_e",   "reset_noise_e", "flicker_noise_e",
    "prnu_fraction", "dsnu_e",       "fixed_pattern", "defects"};

// Returns the key at the beginning of a line of a YAML mapping; empty when there is none.
std::string top_key(const std::string& line) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos || colon == 0 || line[0] == ' ' || line[0] == '#') return {};
    std::string key = line.substr(0, colon);
    std::erase_if(key, [](char c) { return c == '"' || c == '\''; });
    return key;
}

// Breaks words into lines that begin with `indent`.
std::string folded(const std::string& text, const std::string& indent) {
    std::istringstream words(text);
    std::string out, line;
    for (std::string word; words >> word;) {
        if (!line.empty() && indent.size() + line.size() + 1 + word.size() > kLine)
            out += indent + line + "\n", line.clear();
        line += (line.empty() ? "" : " ") + word;
    }
    return out + indent + line + "\n";
}

std::string number_text(double value) { return fmt::format("{:.7g}", value); }

class CloneText {
  public:
    CloneText(const CloneMeasurement& clone, const CloneSource& source, std::string maps)
        : m_(clone), source_(source), maps_(std::move(maps)), figures_(clone_figures(clone, source.like)) {}

    std::string write() {
        head();
        figures();
        lens();
        blur();
        maps();
        std::string out = std::move(out_);
        out += "\n# --- What the frames do not tell: as of " + source_.like.name + "\n";
        for (const CloneFigure& f : figures_)
            if (!f.measured && !f.why.empty()) out += "# " + f.key + ": " + f.why + "\n";
        for (const std::string& one : source_.overrides) {
            const std::size_t equals = one.find('=');
            out += one.substr(0, equals) + ": " + one.substr(equals + 1) + "   # --set\n";
            replaced_.push_back(one.substr(0, equals));
        }
        return out + without_keys(read_input_file(source_.like_file, {kMostYaml_bytes, "a camera file"}),
                                  replaced_);
    }

  private:
    void head() {
        out_ += folded(
            "One particular camera, measured by hilcam clone. Each figure is followed by one standard "
            "deviation; figures after the second heading are not measured.",
            "# ");
        out_ += "name: " + source_.like.name + "-clone\nsource: >-\n";
        out_ += folded(
            fmt::format("hilcam clone of {} frames in {}; the rest as {}: {}", source_.frame_count,
                        fs::path(source_.frames).filename().string(), source_.like.name, source_.like.source),
            "  ");
        out_ += "\n# --- Measured\n";
        out_ += fmt::format("bits: {}\n", m_.bits);
    }
    // Writes a measured figure with its uncertainty; one that was not measured is left to the other camera.
    void figure(const std::string& key) {
        const CloneFigure& f = figure_of(figures_, key.c_str());
        if (!f.measured) return;
        if (std::find(kReplaced.begin(), kReplaced.end(), key) == kReplaced.end()) replaced_.push_back(key);
        std::string line = key + ": " + number_text(f.measured->value);
        line.resize(std::max<std::size_t>(line.size() + 1, 30), ' ');
        out_ += line + fmt::format("# +- {:.2g}\n", f.measured->uncertainty);
    }
    void figures() {
        replaced_ = kReplaced;
        for (const char* key : {"gain_dn_e", "offset_dn", "read_noise_e", "row_noise_e"}) figure(key);
        figure("full_well_e");
        if (!m_.full_well_e && m_.full_well_at_least_e > source_.like.full_well_e) {
            replaced_.emplace_back("full_well_e");
            out_ += "full_well_e: " + number_text(m_.full_well_at_least_e) +
                    "   # at least; the flats reach this\n";
        }
        if (m_.nonlinearity) {
            replaced_.emplace_back("nonlinearity");
            const Bend& b = *m_.nonlinearity;
            out_ += fmt::format("nonlinearity: [{:.6g}, {:.6g}]   # +- {:.2g}, {:.2g}\n", b.a2.value,
                                b.a3.value, b.a2.uncertainty, b.a3.uncertainty);
        }
        if (m_.dark_current_e_s) {
            if (m_.dark_current_e_s->value > 0) {
                figure("dark_current_e_s");
            } else {
                replaced_.emplace_back("dark_current_e_s");
                out_ += fmt::format("dark_current_e_s: 0   # below {:.2g}, two standard deviations\n",
                                    2 * m_.dark_current_e_s->uncertainty);
            }
            out_ += fmt::format("dark_reference_c: {:g}\n", m_.temperature_c);
            replaced_.emplace_back("dark_reference_c");
            figure("dark_doubling_k");
        }
        if (m_.temperature_told) {
            out_ += fmt::format("temperature_c: {:g}\n", m_.temperature_c);
            replaced_.emplace_back("temperature_c");
        }
    }
    void lens() {
        if (!m_.optics.lens) return;
        const LensCalibration& l = *m_.optics.lens;
        replace({"principal_point_px", "distortion", "distortion_x_mm", "distortion_y_mm"});
        figure("focal_length_mm");
        out_ += fmt::format("principal_point_px: [{:.2f}, {:.2f}]   # +- {:.2g}, {:.2g}\n",
                            l.principal_x_px.value, l.principal_y_px.value, l.principal_x_px.uncertainty,
                            l.principal_y_px.uncertainty);
        std::string values, errors;
        for (const std::optional<Measured>& term : {l.k1, l.k2, l.p1, l.p2, l.k3}) {
            const Measured seen = term.value_or(Measured{});
            values += (values.empty() ? "" : ", ") + fmt::format("{:.6g}", seen.value);
            errors += (errors.empty() ? "" : ", ") + fmt::format("{:.2g}", seen.uncertainty);
        }
        out_ += "distortion: [" + values + "]   # +- " + errors + "; 0 +- 0: not seen\n";
        out_ += fmt::format(
            "# {} boards, {:.2g} px from the model; beyond {:.0f} % of the corner's image height "
            "nothing was seen\n",
            l.boards, l.residual_px, 100 * std::min(1.0, l.field_fraction));
    }
    void blur() {
        if (!m_.optics.blur || m_.optics.blur->zones.empty()) return;
        const LensBlur& b = *m_.optics.blur;
        replace({"wavefront_rms_nm", "defocus_um", "zernike_nm", "measured_mtf", "field_zones"});
        const char* key = b.kind == BlurKind::kWavefront ? "wavefront_rms_nm" : "defocus_um";
        const double unit_m = b.kind == BlurKind::kWavefront ? 1e-9 : 1e-6;
        if (b.zones.size() > 1) out_ += "field_zones:\n";
        for (const LensZone& z : b.zones) {
            const std::string value = fmt::format("{}: {:.5g}", key, z.blur_m.value / unit_m);
            std::string line = b.zones.size() == 1 ? value
                                                   : fmt::format("  - {{field_fraction: {:.3f}, {}}}",
                                                                 z.field_fraction, value);
            line.resize(std::max<std::size_t>(line.size() + 1, 60), ' ');
            out_ += line + fmt::format("# +- {:.2g}; MTF within {:.3f} of the measured one\n",
                                       z.blur_m.uncertainty / unit_m, z.misfit);
        }
    }
    void replace(const std::vector<std::string>& keys) {
        replaced_.insert(replaced_.end(), keys.begin(), keys.end());
    }
    void maps() {
        out_ += "# Differences between pixels are in the maps, with the spreads below.\n";
        for (const char* key : {"prnu_fraction", "column_gain_fraction", "dsnu_e", "row_e", "column_e",
                                "dark_current_fraction"})
            if (const CloneFigure& f = figure_of(figures_, key); f.measured)
                out_ += fmt::format("#   {}: {:.4g} +- {:.2g}\n", key, f.measured->value,
                                    f.measured->uncertainty);
        out_ +=
            "fixed_pattern:\n  prnu_map: " + maps_ + "/gain.fits\n  offset_map: " + maps_ + "/offset.fits\n";
        if (!m_.dark_e_s.value.empty())
            out_ += fmt::format("  dark_map: {}/dark.fits\n  dark_map_c: {:g}\n", maps_, m_.temperature_c);
        if (m_.defects.empty()) return;
        out_ += "defects:\n  list: " + maps_ + "/defects.csv\n";
        if (m_.blinking_frames.value > 0)
            out_ += fmt::format("  telegraph_frames: {}   # +- {:.2g}\n",
                                std::max(1l, std::lround(m_.blinking_frames.value)),
                                m_.blinking_frames.uncertainty);
    }

    const CloneMeasurement& m_;
    const CloneSource& source_;
    std::string maps_, out_;
    std::vector<CloneFigure> figures_;
    std::vector<std::string> replaced_;
};

void write_bytes(const fs::path& file, const std::string& bytes) {
    std::ofstream out(file, std::ios::binary);
    out << bytes;
    out.close();
    if (!out) throw DeviceError(file.string() + ": cannot be written");
}

void write_map(const fs::path& file, const std::vector<double>& values, int width, int height,
               const std::string& unit) {
    ElectronImage image(width, height);
    std::transform(values.begin(), values.end(), image.all().begin(),
                   [](double value) { return static_cast<float>(value); });
    write_bytes(file, encode_fits(image, {{}, unit, {}}));
}

}  // namespace

std::string without_keys(const std::string& yaml, const std::vector<std::string>& keys) {
    std::istringstream lines(yaml);
    std::string out;
    bool skips = false;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("# yaml-language-server") || line.starts_with("---")) continue;
        if (const std::string key = top_key(line); !key.empty())
            skips = std::find(keys.begin(), keys.end(), key) != keys.end();
        else if (line.starts_with("#"))
            skips = false;  // a comment at the margin belongs to what follows
        if (!skips) out += line + "\n";
    }
    return out;
}

std::string clone_yaml(const CloneMeasurement& clone, const CloneSource& source, const std::string& maps) {
    return CloneText(clone, source, maps).write();
}

void write_clone(const CloneMeasurement& clone, const CloneSource& source, const fs::path& file) {
    const std::string maps = file.stem().string() + "_maps";
    const fs::path folder = file.parent_path() / maps;
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw DeviceError(folder.string() + ": cannot be made: " + error.message());
    write_map(folder / "gain.fits", clone.gain.value, clone.width, clone.height, "1");
    write_map(folder / "offset.fits", clone.offset_e.value, clone.width, clone.height, "electron");
    if (!clone.dark_e_s.value.empty())
        write_map(folder / "dark.fits", clone.dark_e_s.value, clone.width, clone.height, "electron/s");
    if (!clone.defects.empty()) write_bytes(folder / "defects.csv", defect_list_text(clone.defects));
    write_bytes(file, clone_yaml(clone, source, maps));
    CameraModel camera;
    read_config(file, section_of(camera));
}

}  // namespace hilcam
