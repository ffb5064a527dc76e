#include "emulator/scenario/scenario_listing.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <map>
#include <sstream>
#include <vector>

#include "io/config/renamed_keys.h"
#include "io/system/crc32.h"
#include "io/system/input_file.h"
#include "render/vocabulary/overloaded.h"

namespace hilcam {
namespace {

// Writes enough digits to read the same number back.
std::string exact(double value) {
    std::array<char, 32> text;
    const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
    return std::string(text.data(), end);
}

template <class Values>
std::string exact_list(const Values& values, double si_per_unit = 1) {
    std::string out;
    for (const double value : values) out += (out.empty() ? "" : ", ") + exact(value / si_per_unit);
    return "[" + out + "]";
}

std::string exact_pairs(const std::vector<double>& x, const std::vector<double>& y) {
    std::string out;
    for (std::size_t i = 0; i < y.size(); ++i)
        out += (out.empty() ? "[" : ", [") + (i < x.size() ? exact(x[i]) + ", " : "") + exact(y[i]) + "]";
    return "[" + out + "]";
}

std::string file_text(const std::filesystem::path& file) {
    std::error_code error;
    std::string out = file.filename().string();
    if (file.empty() || !std::filesystem::is_regular_file(file, error)) return out;
    // The file has been read for the scene, by readers that limit its size.
    InputStream in(file, {std::numeric_limits<std::int64_t>::max(), "a file"});
    std::vector<std::uint8_t> piece(1u << 20);
    std::uint32_t crc = 0;
    std::uint64_t size = 0;
    while (in) {
        in.read(reinterpret_cast<char*>(piece.data()), static_cast<std::streamsize>(piece.size()));
        const auto count = static_cast<std::size_t>(in.gcount());
        crc = crc32_of(std::span(piece).first(count), crc);
        size += count;
    }
    return out + " (" + std::to_string(size) + " bytes, CRC-32 " + std::to_string(crc) + ")";
}

// Returns a value as a line of text; sections have none.
std::string value_of(const Field& field) {
    return std::visit(
        Overloaded{
            [](const NumberField& f) { return f.holds_word() ? f.word : exact(*f.value / f.si_per_unit); },
            [](const IntegerField& f) { return std::to_string(*f.value); },
            [](const FlagField& f) { return std::string(*f.value ? "true" : "false"); },
            [](const TextField& f) { return *f.value; },
            [](const TextsField& f) {
                std::string out;
                for (const std::string& text : *f.value) out += (out.empty() ? "" : ", ") + text;
                return "[" + out + "]";
            },
            [](const PathField& f) { return file_text(*f.value); },
            [](const ChoiceField& f) { return f.words[f.get()]; },
            [](const NumbersField& f) { return exact_list(*f.value, f.si_per_unit); },
            [](const Vec3Field& f) {
                return exact_list(std::array{f.value->x, f.value->y, f.value->z}, f.si_per_unit);
            },
            [](const QuatField& f) {
                return exact_list(std::array{f.value->w, f.value->x, f.value->y, f.value->z});
            },
            [](const CurveField& f) { return exact_pairs(f.value->wavelength_um, f.value->value); },
            [](const TableField& f) { return exact_pairs(f.value->x, f.value->y); },
            [](const auto&) { return std::string(); },
        },
        field.target);
}

void list(const SectionField& section, const std::string& prefix, std::string& out) {
    for (const Field& field : section.fields) {
        if (!field.changes_frames) continue;
        const std::string key = prefix + field.key;
        const auto* may_lack = std::get_if<OptionalSectionField>(&field.target);
        const bool lacks = may_lack ? !may_lack->given() : field.present && !*field.present;
        if (lacks && !field.required) {
            out += key + " = (not given)\n";
        } else if (const std::optional<SectionField> nested = section_in(field)) {
            list(*nested, key + ".", out);
        } else if (const auto* many = std::get_if<SectionsField>(&field.target)) {
            if (many->holds_word && *many->holds_word) out += key + " = " + many->word + "\n";
            for (std::size_t i = 0; i < many->count(); ++i)
                list(many->at(i), key + "." + std::to_string(i) + ".", out);
        } else {
            std::string value = value_of(field);
            std::replace(value.begin(), value.end(), '\n', ' ');
            out += key + " = " + value + "\n";
        }
    }
}

std::map<std::string, std::string> parsed(const std::string& listing) {
    std::map<std::string, std::string> out;
    std::istringstream lines(listing);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t equals = std::min(line.find(" = "), line.size());
        std::string key = line.substr(0, equals), value = line.substr(std::min(equals + 3, line.size()));
        // Recordings use the names of an earlier version.
        const std::size_t last = key.rfind('.') + 1;
        if (const std::string_view now = renamed_key(key.substr(last)); !now.empty())
            key = key.substr(0, last) + std::string(now);
        const RemovedKey* const removed = removed_key(key.substr(last));
        if (removed && (removed->no_effect.empty() || removed->no_effect == value)) continue;
        if (const std::string_view now = renamed_value(key.substr(last), value); !now.empty()) value = now;
        out[std::move(key)] = std::move(value);
    }
    return out;
}

}  // namespace

std::string section_listing(const SectionField& section) {
    std::string out;
    list(section, "", out);
    return out;
}

std::string scenario_listing(ScenarioConfig scenario) {
    scenario.has_seed = true;  // frames have a seed, stated or not
    return section_listing(section_of(scenario));
}

std::string listed_value(const std::string& listing, const std::string& key) {
    const std::map<std::string, std::string> values = parsed(listing);
    const auto found = values.find(key);
    return found == values.end() ? std::string() : found->second;
}

std::string listing_difference(const std::string& there, const std::string& here) {
    const std::map<std::string, std::string> a = parsed(there), b = parsed(here);
    std::string first;
    std::size_t count = 0;
    const auto differs = [&](const std::string& key, const std::string& in_a, const std::string& in_b) {
        if (count++ == 0) first = key + ": '" + in_a + "' there, '" + in_b + "' here";
    };
    for (const auto& [key, value] : a) {
        const auto other = b.find(key);
        if (other == b.end())
            differs(key, value, "(no such key)");
        else if (other->second != value)
            differs(key, value, other->second);
    }
    for (const auto& [key, value] : b)
        if (!a.contains(key)) differs(key, "(no such key)", value);
    if (count > 1) first += " (and " + std::to_string(count - 1) + " more)";
    return first;
}

}  // namespace hilcam
