#include "io/config/config_manual.h"

#include <cmath>
#include <variant>

#include "io/system/plain_number.h"
#include "render/vocabulary/overloaded.h"

namespace hilcam {
namespace {

std::string accepted_text(const Field& field) {
    return std::visit(Overloaded{
                          [](const NumberField& f) { return accepted(f.range); },
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
                          [](const SectionField&) { return std::string("mapping or file"); },
                          [](const SectionsField&) { return std::string("list of mappings"); },
                      },
                      field.target);
}

// As YAML would have it; empty where it has no short text.
std::string present_text(const Field& field) {
    return std::visit(Overloaded{
                          [](const NumberField& f) { return plain(*f.value / f.si_per_unit); },
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

void manual_rows(const SectionField& section, const std::string& prefix, std::string& out) {
    for (const Field& field : section.fields) {
        out += "| `" + prefix + field.key + "` | " + accepted_text(field) + " | " + default_text(field) +
               " | " + field.meaning + " |\n";
        if (const auto* nested = std::get_if<SectionField>(&field.target))
            manual_rows(*nested, prefix + field.key + ".", out);
        if (const auto* many = std::get_if<SectionsField>(&field.target))
            manual_rows(many->append(), prefix + field.key + ".N.", out);
    }
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
        const auto* nested = std::get_if<SectionField>(&field.target);
        return nested ? value_text(*nested, key.substr(dot + 1)) : std::string();
    }
    return {};
}

std::string config_manual(const SectionField& root) {
    std::string out = "| key | accepted | default | meaning |\n|---|---|---|---|\n";
    manual_rows(root, "", out);
    return out;
}

}  // namespace hilcam
