#include "emulator/tradeoff/tradeoff_report.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "emulator/recording/machine_report.h"
#include "emulator/run/page_maker.h"
#include "emulator/run/report.h"
#include "emulator/tradeoff/tradeoff_ladder.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

using nlohmann::json;

const char* word_of(MeasuredSetting::Kind kind) {
    switch (kind) {
        case MeasuredSetting::Kind::kOwn:
            return "own";
        case MeasuredSetting::Kind::kSingle:
            return "single";
        case MeasuredSetting::Kind::kCombination:
            return "combination";
    }
    return "";
}

bool resolved(const Tradeoff& t, const MeasuredSetting& s) {
    return s.error() >= 3 * t.reference_standard_error.p99;
}

// A column: its name and its value.
struct Column {
    const char* name;
    std::optional<double> value;
};
std::vector<Column> columns_of(const MeasuredSetting& s) {
    const PictureErrors& e = s.errors;
    return {{"frame_ms", s.times.frame_ms},
            {"render_ms", s.times.render_ms},
            {"frame_least_ms", s.times.min_ms},
            {"frame_most_ms", s.times.max_ms},
            {"error_sigma_p99", e.noise.p99},
            {"error_sigma_rms", e.noise.rms},
            {"within_half_sigma_fraction", e.noise.within_half_fraction},
            {"false_lights", e.false_lights},
            {"centroid_shift_px", e.centroid_px},
            {"photometric_error_fraction", e.photometric_fraction},
            {"limb_error_px", e.limb_px},
            {"ssim", e.similarity}};
}

std::string joined(const std::vector<std::string>& words, const char* separator) {
    std::string out;
    for (const std::string& word : words) out.append(out.empty() ? "" : separator).append(word);
    return out;
}

// Describes the differences from the scenario's own setting.
std::string changes_of(const Tradeoff& t, const MeasuredSetting& s) {
    std::vector<std::string> words;
    for (std::size_t k = 0; k < t.knobs.size(); ++k)
        if (s.choices[k] != 0) words.push_back(t.knobs[k].name + " " + t.knobs[k].value(s.choices[k]).label);
    return words.empty() ? "as the scenario has it" : joined(words, ", ");
}

// Quotes cells with commas (RFC 4180).
std::string cell(const std::string& text) {
    if (text.find_first_of(",\"") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) out.append(c == '"' ? 2 : 1, c);
    return out.append("\"");
}

json error_json(const NoiseError& e) { return {{"p99", e.p99}, {"rms", e.rms}, {"lit_px", e.lit_px}}; }

json setting_json(const Tradeoff& t, std::size_t index) {
    const MeasuredSetting& s = t.settings[index];
    json out = {{"id", index},
                {"kind", word_of(s.kind)},
                {"front", s.on_front},
                {"resolved", resolved(t, s)},
                {"changes", changes_of(t, s)},
                {"set", t.overrides_of(s.choices)}};
    for (const Column& f : columns_of(s)) out[f.name] = f.value ? json(*f.value) : json(nullptr);
    return out;
}

json index_json(const std::optional<std::size_t>& index) { return index ? json(*index) : json(nullptr); }

json knobs_json(const Tradeoff& t) {
    json out = json::array();
    for (const Knob& knob : t.knobs) {
        json others = json::array();
        for (const KnobValue& value : knob.others) others.push_back(value.label);
        out.push_back({{"name", knob.name}, {"own", knob.own.label}, {"others", others}});
    }
    return out;
}

std::string set_options(const std::vector<std::string>& overrides) {
    std::string out;
    for (const std::string& o : overrides) {
        const bool quoted = o.find_first_of(" [") != std::string::npos;
        out += quoted ? fmt::format(" --set '{}'", o) : fmt::format(" --set {}", o);
    }
    return out.empty() ? " nothing to change" : out;
}

std::string answer_text(const Tradeoff& t, const std::string& question,
                        const std::optional<std::size_t>& found, const std::string& none) {
    if (!found) return fmt::format("{}: {}\n", question, none);
    const MeasuredSetting& s = t.settings[*found];
    return fmt::format("{}: setting {}, {:.2f} ms, error {:.3f} sigma:{}\n", question, *found,
                       s.times.frame_ms, s.error(), set_options(t.overrides_of(s.choices)));
}

std::vector<std::size_t> front_by_time(const Tradeoff& t) {
    std::vector<std::size_t> front;
    for (std::size_t i = 0; i < t.settings.size(); ++i)
        if (t.settings[i].on_front) front.push_back(i);
    std::sort(front.begin(), front.end(), [&](std::size_t a, std::size_t b) {
        return t.settings[a].times.frame_ms < t.settings[b].times.frame_ms;
    });
    return front;
}

// Writes `quality` as a file; other changes of the setting do not belong there and become a comment.
std::string preset(const Tradeoff& t, const std::string& title, const std::vector<std::string>& overrides) {
    std::vector<std::string> others;
    for (const std::string& o : overrides)
        if (!o.starts_with("quality.")) others.push_back(o);
    std::string out = fmt::format("# {}\n# By hilcam tradeoff, for {}.\n", title, t.scenario.name);
    if (!others.empty()) out += fmt::format("# With it in the scenario: {}\n", joined(others, "; "));
    return out + quality_yaml(t.source.load(overrides));
}

}  // namespace

std::string tradeoff_csv(const Tradeoff& t) {
    std::string out = "id,kind,front,resolved";
    for (const Column& f : columns_of(t.settings.front())) out.append(",").append(f.name);
    for (const Knob& knob : t.knobs) out.append(",").append(cell(knob.name));
    out += ",set\n";
    for (std::size_t i = 0; i < t.settings.size(); ++i) {
        const MeasuredSetting& s = t.settings[i];
        out += fmt::format("{},{},{},{}", i, word_of(s.kind), s.on_front ? 1 : 0, resolved(t, s) ? 1 : 0);
        for (const Column& f : columns_of(s))
            out += f.value ? fmt::format(",{:.6g}", *f.value) : std::string(",");
        for (std::size_t k = 0; k < t.knobs.size(); ++k)
            out.append(",").append(cell(t.knobs[k].value(s.choices[k]).label));
        out.append(",").append(cell(joined(t.overrides_of(s.choices), " "))).append("\n");
    }
    return out;
}

json tradeoff_json(const Tradeoff& t) {
    json settings = json::array();
    for (std::size_t i = 0; i < t.settings.size(); ++i) settings.push_back(setting_json(t, i));
    return {{"scenario", t.scenario.name},
            {"width", t.scenario.camera.width_px},
            {"height", t.scenario.camera.height_px},
            {"reference",
             {{"frames", t.reference_frames},
              {"seconds", t.reference_s},
              {"standard_error_sigma", error_json(t.reference_standard_error)},
              {"set", t.reference_overrides}}},
            {"knobs", knobs_json(t)},
            {"settings", settings},
            {"asked", {{"frame_ms", t.frame_ms}, {"error_sigma", t.error_sigma}}},
            {"recommended",
             {{"within_frame_ms", index_json(t.within_time)},
              {"within_error_sigma", index_json(t.within_error)}}},
            {"remarks", t.remarks},
            {"machine", machine_report()}};
}

std::string tradeoff_text(const Tradeoff& t) {
    std::string out = fmt::format(
        "{}: {} settings measured; reference of {} frames, standard error {:.4f} sigma (99 % of lit "
        "pixels)\n\n"
        "{:>4} {:>9} {:>9} {:>9} {:>7} {:>9} {:>9} {:>9} {:>8}  {}\n",
        t.scenario.name, t.settings.size(), t.reference_frames, t.reference_standard_error.p99, "id",
        "frame ms", "render ms", "error", "false", "centroid", "photom.", "limb px", "SSIM", "setting");
    const auto shown = [](const std::optional<double>& value, int digits) {
        return value ? fmt::format("{:.{}f}", *value, digits) : std::string("n/a");
    };
    for (const std::size_t i : front_by_time(t)) {
        const MeasuredSetting& s = t.settings[i];
        const PictureErrors& e = s.errors;
        out += fmt::format("{:>4} {:>9.2f} {:>9.2f} {:>9.3f} {:>7.1f} {:>9} {:>9} {:>9} {:>8}  {}\n", i,
                           s.times.frame_ms, s.times.render_ms, s.error(), e.false_lights,
                           shown(e.centroid_px, 4), shown(e.photometric_fraction, 5), shown(e.limb_px, 4),
                           shown(e.similarity, 5), changes_of(t, s));
    }
    out += "\n";
    out += answer_text(t, fmt::format("least error within {:.2f} ms", t.frame_ms), t.within_time,
                       "no measured setting is that fast");
    out += answer_text(t, fmt::format("fastest within {:g} sigma", t.error_sigma), t.within_error,
                       "no measured setting is that accurate");
    return out;
}

void write_tradeoff(const Tradeoff& t, const std::filesystem::path& folder) {
    make_folder(folder);
    write_text(folder / "tradeoff.csv", tradeoff_csv(t));
    write_json(folder / "tradeoff.json", tradeoff_json(t));
    if (t.within_time)
        write_text(folder / "realtime.yaml",
                   preset(t, fmt::format("The least error within {:.2f} ms a frame.", t.frame_ms),
                          t.overrides_of(t.settings[*t.within_time].choices)));
    if (t.within_error)
        write_text(folder / "balanced.yaml",
                   preset(t, fmt::format("The fastest within {:g} of the sensor's noise.", t.error_sigma),
                          t.overrides_of(t.settings[*t.within_error].choices)));
    write_text(folder / "reference.yaml", preset(t, "For comparison, not for speed.", t.reference_overrides));
    if (const std::string ladder = ladder_yaml(t); !ladder.empty()) write_text(folder / "loop.yaml", ladder);
    run_page_maker("hilcam-plot-tradeoff", {folder.string()});
}

}  // namespace hilcam
