#include "io/config/config_schema.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "render/vocabulary/check.h"
#include "render/vocabulary/overloaded.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

using OrderedJson = nlohmann::ordered_json;

// Returns a whole number as an integer, so that 1 does not become 1.0.
OrderedJson plain_end(double end) {
    if (std::abs(end) < 9.1e15 && end == std::trunc(end)) return static_cast<std::int64_t>(end);
    return end;
}

OrderedJson number_in(const Range& range, const char* type = "number") {
    OrderedJson out = {{"type", type}};
    if (std::isfinite(range.least)) out["minimum"] = plain_end(range.least);
    if (std::isfinite(range.most)) out["maximum"] = plain_end(range.most);
    return out;
}

OrderedJson list_of(const OrderedJson& items, std::size_t fewest, std::size_t most) {
    return {{"type", "array"}, {"items", items}, {"minItems", fewest}, {"maxItems", most}};
}

OrderedJson pairs_of(const Range& x, const Range& y) {
    const OrderedJson pair = {
        {"type", "array"}, {"prefixItems", {number_in(x), number_in(y)}}, {"minItems", 2}, {"maxItems", 2}};
    return {{"type", "array"}, {"items", pair}, {"minItems", 1}};
}

OrderedJson mapping_of(const SectionField& section);

// A mapping, or the path of a file that holds it.
OrderedJson section_of_field(const SectionField& section) {
    return {{"anyOf", {OrderedJson{{"type", "string"}, {"minLength", 1}}, mapping_of(section)}}};
}

// Adds the word that may replace the value.
OrderedJson or_word(const OrderedJson& accepted, const std::string& word) {
    return word.empty() ? accepted : OrderedJson{{"anyOf", {OrderedJson{{"enum", {word}}}, accepted}}};
}
OrderedJson list_of_mappings(const SectionsField& f) {
    const OrderedJson list = {{"type", "array"}, {"items", section_of_field(f.append())}};
    return or_word(OrderedJson{{"anyOf", {OrderedJson{{"type", "string"}, {"minLength", 1}}, list}}}, f.word);
}

OrderedJson type_of(const Field& field) {
    return std::visit(
        Overloaded{
            [](const NumberField& f) { return or_word(number_in(f.range), f.word); },
            [](const IntegerField& f) { return number_in(f.range, "integer"); },
            [](const FlagField&) {
                return OrderedJson{{"type", "boolean"}};
            },
            // Any plain value is a text, also a serial number of digits.
            [](const TextField&) {
                return OrderedJson{{"type", {"string", "number", "boolean"}}};
            },
            [](const TextsField&) {
                const OrderedJson text = {{"type", {"string", "number", "boolean"}}};
                return OrderedJson{{"anyOf", {text, OrderedJson{{"type", "array"}, {"items", text}}}}};
            },
            [](const PathField&) {
                return OrderedJson{{"type", "string"}, {"minLength", 1}};
            },
            [](const ChoiceField& f) {
                return OrderedJson{{"enum", f.words}};
            },
            [](const NumbersField& f) { return list_of(number_in(f.range), f.fewest, f.most); },
            [](const Vec3Field& f) { return list_of(number_in(f.range), 3, 3); },
            [](const QuatField&) {
                return list_of(number_in({-1.001, 1.001}), 4, 4);
            },
            [](const CurveField& f) {
                return OrderedJson{{"anyOf", {number_in(f.range), pairs_of({0.1, 100}, f.range)}}};
            },
            [](const TableField& f) { return pairs_of(f.x_range, f.y_range); },
            [](const SectionField& f) { return section_of_field(f); },
            [](const OptionalSectionField& f) { return section_of_field(f.open()); },
            [](const SectionsField& f) { return list_of_mappings(f); },
        },
        field.target);
}

// Returns the value without the key, if that is a single value.
std::optional<OrderedJson> default_of(const Field& field) {
    if (field.required) return {};
    const auto* number = std::get_if<NumberField>(&field.target);
    if (number && number->holds_word()) return number->word;
    if (const auto* f = number)
        if (const double value = *f->value / f->si_per_unit; std::isfinite(value)) {
            // Twelve digits, because a number that was scaled when it was read does not divide back exactly.
            char text[32];
            std::snprintf(text, sizeof text, "%.12g", value);
            return plain_end(std::strtod(text, nullptr));
        }
    if (const auto* f = std::get_if<IntegerField>(&field.target)) return *f->value;
    if (const auto* f = std::get_if<FlagField>(&field.target)) return *f->value;
    if (const auto* f = std::get_if<ChoiceField>(&field.target)) return f->words[f->get()];
    return {};
}

OrderedJson mapping_of(const SectionField& section) {
    OrderedJson properties = OrderedJson::object(), required = OrderedJson::array();
    for (const Field& field : section.fields) {
        OrderedJson of_key = type_of(field);
        of_key["description"] = field.meaning;
        if (const auto value = default_of(field)) of_key["default"] = *value;
        properties[field.key] = std::move(of_key);
        if (field.required) required.push_back(field.key);
    }
    OrderedJson out = {
        {"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
    if (!required.empty()) out["required"] = std::move(required);
    return out;
}

// Returns the section at a key, "objects.N.materials". References into appended elements remain valid in
// their owner.
std::optional<SectionField> section_at(const SectionField& root, std::string_view key) {
    const std::size_t dot = key.find('.');
    for (const Field& field : root.fields) {
        if (field.key != key.substr(0, dot)) continue;
        std::string_view rest = dot == std::string_view::npos ? std::string_view() : key.substr(dot + 1);
        std::optional<SectionField> here = section_in(field);
        if (const auto* many = std::get_if<SectionsField>(&field.target); many && rest.starts_with("N")) {
            here = many->append();
            rest = rest.size() > 2 ? rest.substr(2) : std::string_view();
        }
        if (!here || rest.empty()) return here;
        return section_at(*here, rest);
    }
    return {};
}

}  // namespace

std::string config_schema(const SectionField& root, std::string_view prefix, const std::string& title) {
    const std::optional<SectionField> section =
        prefix.empty() ? std::optional<SectionField>(root) : section_at(root, prefix);
    if (!section)
        throw InputError("manual " + in_quotes(prefix) +
                         ": no such section; accepted: a section as `hilcam manual` prints it, as camera or "
                         "objects.N.materials");
    OrderedJson schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", title}};
    schema.update(mapping_of(*section));
    return schema.dump(1) + "\n";
}

}  // namespace hilcam
