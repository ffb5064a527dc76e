#include "io/config/config_manual.h"

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <variant>

#include "io/config/config_advice.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/overloaded.h"
#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

std::string or_word(const std::string& accepted, const std::string& word) {
    return word.empty() ? accepted : word + ", or " + accepted;
}
std::string number_text(const NumberField& f) {
    return f.holds_word() ? f.word : plain(*f.value / f.si_per_unit);
}

std::string accepted_text(const Field& field) {
    return std::visit(Overloaded{
                          [](const NumberField& f) { return or_word(accepted(f.range), f.word); },
                          [](const IntegerField& f) { return "whole, " + accepted(f.range); },
                          [](const FlagField&) { return std::string("true, false"); },
                          [](const TextField&) { return std::string("text"); },
                          [](const TextsField&) { return std::string("list of texts"); },
                          [](const PathField&) { return std::string("path"); },
                          [](const ChoiceField& f) {
                              std::string words;
                              for (const std::string& w : f.words) words += (words.empty() ? "" : ", ") + w;
                              return words;
                          },
                          [](const NumbersField& f) { return "list, each " + accepted(f.range); },
                          [](const Vec3Field& f) { return "[x, y, z], each " + accepted(f.range); },
                          [](const QuatField&) { return std::string("[w, x, y, z]"); },
                          [](const CurveField& f) { return "number or curve, " + accepted(f.range); },
                          [](const TableField& f) { return "[[" + f.x_name + ", " + f.y_name + "], ...]"; },
                          [](const OneOf<SectionField, OptionalSectionField> auto&) {
                              return std::string("mapping or file");
                          },
                          [](const SectionsField& f) { return or_word("list of mappings, or file", f.word); },
                      },
                      field.target);
}

// Returns the value as YAML would have it; empty where it has no short text.
std::string present_text(const Field& field) {
    return std::visit(Overloaded{
                          [](const NumberField& f) { return number_text(f); },
                          [](const IntegerField& f) { return std::to_string(*f.value); },
                          [](const FlagField& f) { return std::string(*f.value ? "true" : "false"); },
                          [](const TextField& f) { return *f.value; },
                          [](const ChoiceField& f) { return f.words[f.get()]; },
                          [](const CurveField& f) {
                              return f.value->value.size() == 1 ? plain(f.value->value[0])
                                                                : std::string("(curve)");
                          },
                          [](const NumbersField& f) {
                              std::string list;
                              for (const double value : *f.value)
                                  list += (list.empty() ? "[" : ", ") + plain(value / f.si_per_unit);
                              return list.empty() ? list : list + "]";
                          },
                          [](const auto&) { return std::string(); },
                      },
                      field.target);
}

std::string default_text(const Field& field) {
    if (field.required) return "(required)";
    return std::holds_alternative<NumbersField>(field.target) ? std::string() : present_text(field);
}

const char* kind_of(const Field& field) {
    return std::visit(Overloaded{
                          [](const NumberField&) { return "number"; },
                          [](const IntegerField&) { return "integer"; },
                          [](const FlagField&) { return "flag"; },
                          [](const TextField&) { return "text"; },
                          [](const TextsField&) { return "texts"; },
                          [](const PathField&) { return "path"; },
                          [](const ChoiceField&) { return "choice"; },
                          [](const NumbersField&) { return "numbers"; },
                          [](const Vec3Field&) { return "vector"; },
                          [](const QuatField&) { return "quaternion"; },
                          [](const CurveField&) { return "curve"; },
                          [](const TableField&) { return "table"; },
                          [](const OneOf<SectionField, OptionalSectionField> auto&) { return "section"; },
                          [](const SectionsField&) { return "list of sections"; },
                      },
                      field.target);
}

// A key with all keys below it.
struct SectionEntry {
    std::string key;   // full name, "camera.shutter.kind"
    std::string word;  // its last part
    std::string kind, accepted, usual, meaning;
    bool required = false;
    std::vector<SectionEntry> below;
};

std::vector<SectionEntry> entries_of(const SectionField& section, const std::string& prefix) {
    std::vector<SectionEntry> out;
    for (const Field& field : section.fields) {
        SectionEntry entry{prefix + field.key,  field.key,     kind_of(field), accepted_text(field),
                           default_text(field), field.meaning, field.required, {}};
        if (const std::optional<SectionField> nested = section_in(field))
            entry.below = entries_of(*nested, entry.key + ".");
        if (const auto* many = std::get_if<SectionsField>(&field.target))
            entry.below = entries_of(many->append(), entry.key + ".N.");
        out.push_back(std::move(entry));
    }
    return out;
}

// Returns a text that is equal for two sections with the same description, except for defaults.
std::string shape_of(const SectionEntry& section) {
    std::string out;
    for (const SectionEntry& e : section.below)
        out += e.word + "|" + e.accepted + "|" + e.meaning + "|" + (e.required ? "!" : "") + "{" +
               shape_of(e) + "}";
    return out;
}

// Appends the defaults in which `section` differs from `other`, of the same shape: "albedo 0.3, visible
// false".
void other_defaults(const SectionEntry& section, const SectionEntry& other, const std::string& prefix,
                    std::string& out) {
    for (std::size_t i = 0; i < section.below.size(); ++i) {
        const SectionEntry &mine = section.below[i], &its = other.below[i];
        if (mine.usual != its.usual)
            out += (out.empty() ? "" : ", ") + prefix + mine.word + " " +
                   (mine.usual.empty() ? "none" : mine.usual);
        other_defaults(mine, its, prefix + mine.word + ".", out);
    }
}

constexpr std::size_t kMinFolded = 4;  // keys of a section that is worth folding

class ManualTable {
  public:
    explicit ManualTable(const std::vector<SectionEntry>& entries) {
        // Sections refer to those nearer to the top, not the other way round.
        for (const SectionEntry& e : entries)
            if (e.below.size() >= kMinFolded) seen_.emplace(shape_of(e), &e);
        add_all(entries);
    }
    std::string take() { return std::move(out_); }

  private:
    void add(const SectionEntry& e) {
        out_ += "| `" + e.key + "` | " + e.accepted + " | " + e.usual + " | " + e.meaning + " |\n";
        if (e.below.size() < kMinFolded) return add_all(e.below);
        const SectionEntry& like = *seen_.emplace(shape_of(e), &e).first->second;
        if (&like == &e) return add_all(e.below);
        const std::string keys = e.below.front().key.substr(0, e.below.front().key.rfind('.')) + ".*";
        const std::string& first = like.below.front().key;
        std::string others;
        other_defaults(e, like, "", others);
        out_ += "| `" + keys + "` | as `" + first.substr(0, first.rfind('.')) + ".*` | " + others +
                " | the same keys |\n";
    }
    void add_all(const std::vector<SectionEntry>& entries) {
        for (const SectionEntry& e : entries) add(e);
    }

    std::string out_ = "| key | accepted | default | meaning |\n|---|---|---|---|\n";
    std::map<std::string, const SectionEntry*> seen_;
};

// Returns the entry of a key; null when there is none.
const SectionEntry* find(const std::vector<SectionEntry>& entries, std::string_view key) {
    for (const SectionEntry& e : entries) {
        if (e.key == key || e.key + ".N" == key) return &e;
        if (const SectionEntry* below = find(e.below, key)) return below;
    }
    return nullptr;
}

std::vector<SectionEntry> chosen(const SectionField& root, std::string_view prefix) {
    std::vector<SectionEntry> all = entries_of(root, "");
    if (prefix.empty()) return all;
    const SectionEntry* found = find(all, prefix);
    if (!found)
        throw InputError("manual " + in_quotes(prefix) + ": no such key" + key_advice(prefix, root.fields));
    return {*found};
}

nlohmann::ordered_json json_of(const std::vector<SectionEntry>& entries) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const SectionEntry& e : entries) {
        list.push_back({{"key", e.key},
                        {"kind", e.kind},
                        {"accepted", e.accepted},
                        {"default", e.required ? "" : e.usual},
                        {"required", e.required},
                        {"meaning", e.meaning}});
        for (auto& below : json_of(e.below)) list.push_back(std::move(below));
    }
    return list;
}

}  // namespace

std::string accepted(const Range& range) {
    const bool low = std::isfinite(range.least);
    const bool high = std::isfinite(range.most);
    if (low && high) return plain(range.least) + " to " + plain(range.most);
    if (low) return plain(range.least) + " or more";
    if (high) return plain(range.most) + " or less";
    return "any number";
}

std::string value_text(const SectionField& root, std::string_view key) {
    const std::size_t dot = key.find('.');
    for (const Field& field : root.fields) {
        if (field.key != key.substr(0, dot)) continue;
        if (dot == std::string_view::npos) return present_text(field);
        const std::optional<SectionField> nested = section_in(field);
        return nested ? value_text(*nested, key.substr(dot + 1)) : std::string();
    }
    return {};
}

std::string config_manual(const SectionField& root, std::string_view prefix) {
    const std::vector<SectionEntry> entries = chosen(root, prefix);
    return ManualTable(entries).take();
}

std::string config_manual_json(const SectionField& root, std::string_view prefix) {
    return json_of(chosen(root, prefix)).dump(1) + "\n";
}

}  // namespace hilcam
