#pragma once
// One list per configuration struct says all about its keys: name with unit, meaning, range, where the value
// goes. Parsing, range check, unknown-key check, --set and the manual's tables all come from it.
//
//     struct PinholeConfig { double focal_length_m = 0.05; };
//     Fields fields(PinholeConfig& c) {
//         return {number("focal_length_mm", c.focal_length_m, 1e-3, {1e-3, 100}, "distance of the image
//         plane")};
//     }
//
// Ranges are in the unit of the file (here mm), inclusive. Values are stored in SI: file value * si_per_unit.
// The struct must outlive the list. Owner thread.

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "render/vocabulary/check.h"
#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/table.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

struct Field;
using Fields = std::vector<Field>;

struct Range {
    double least = -std::numeric_limits<double>::infinity();
    double most = std::numeric_limits<double>::infinity();
};

// A number, or the one word that may stand in its place: the value is `word_value` then, which no number of the range is.
struct NumberField {
    double* value;
    double si_per_unit;
    Range range;
    std::string word{};  // empty: there is none
    double word_value = 0;

    bool holds_word() const { return !word.empty() && *value <= word_value && *value >= word_value; }
};
struct IntegerField {
    std::int64_t* value;
    Range range;
};
struct FlagField {
    bool* value;
};
struct TextField {
    std::string* value;
};
// A list of texts, in brackets; one text alone is a list of one.
struct TextsField {
    std::vector<std::string>* value;
};
// A path; relative ones are taken from the folder of the file that names it. `where`, if asked for, gets the
// place of the key, "bench.yaml:7:11: objects.0.mesh", for messages about what the path leads to.
struct PathField {
    std::filesystem::path* value;
    std::string* where = nullptr;
};
// One of a fixed list of words; `set` gets its index, `get` gives the present one.
struct ChoiceField {
    std::vector<std::string> words;
    std::function<void(std::size_t)> set;
    std::function<std::size_t()> get;
};
// A fixed or variable list of numbers.
struct NumbersField {
    std::vector<double>* value;
    double si_per_unit;
    Range range;
    std::size_t fewest;
    std::size_t most;
};
struct Vec3Field {
    Vec3d* value;
    double si_per_unit;
    Range range;
};
// [w, x, y, z]; accepted when its norm is 1 within 1e-3, then normalised.
struct QuatField {
    Quat* value;
};
// One number (constant), or [[wavelength_um, value], ...] with increasing wavelengths.
struct CurveField {
    Curve* value;
    Range range;
};
// [[x, y], ...] with rising x.
struct TableField {
    Table* value;
    std::string x_name, y_name;
    Range x_range, y_range;
};
// A section's `validate` objects to one of its keys, "up", or to one further down, "objects.0.name": the
// reader says where that stands.
class KeyError : public InputError {
  public:
    KeyError(std::string key, std::string reason)
        : InputError(key + ": " + reason), key_(std::move(key)), reason_(std::move(reason)) {}
    const std::string& key() const { return key_; }
    const std::string& reason() const { return reason_; }

  private:
    std::string key_, reason_;
};

// The same as refused() (check.h), of a key.
inline KeyError refused_key(const std::string& key, const std::string& found, const std::string& accepted) {
    return KeyError(key, "found " + found + "; accepted: " + accepted);
}

// Turns what an InputError of check() says into an objection to that key.
template <class Check>
void at_key(const std::string& key, const Check& check) {
    try {
        check();
    } catch (const InputError& error) {
        throw KeyError(key, error.what());
    }
}

// A nested mapping, or the path of a file that holds the mapping. `validate` runs after it is read and throws
// KeyError, or InputError with a message that names the keys it is about; the reader adds file and line.
struct SectionField {
    Fields fields;
    std::function<void()> validate;
};
// A nested mapping that may be left out, and is then not there at all. `open` gives it, made with its defaults
// where it is not there yet.
struct OptionalSectionField {
    std::function<SectionField()> open;
    std::function<bool()> given;
};
// A list of mappings. `append` adds one default element to the owner and gives its section; references into
// earlier elements need not stay valid, because each element is read before the next is appended.
struct SectionsField {
    std::function<SectionField()> append;
    // The elements that there are, to list them.
    std::function<std::size_t()> count{};
    std::function<SectionField(std::size_t)> at{};
    // A word that may stand in the list's place, and what is set then; empty: there is none.
    std::string word{};
    bool* holds_word = nullptr;
};

struct Field {
    std::string key;
    std::string meaning;  // one line, with the unit where the key has none
    std::variant<NumberField, IntegerField, FlagField, TextField, TextsField, PathField, ChoiceField,
                 NumbersField, Vec3Field, QuatField, CurveField, TableField, SectionField,
                 OptionalSectionField, SectionsField>
        target;
    bool required = false;
    bool* present = nullptr;     // set when the key is given
    bool changes_frames = true;  // false: frames do not depend on it, so that a replay may have another value
    bool per_frame = false;      // true: it may have another value from one frame to the next (loop.levels)
    // Says why the key, where it is given, has no effect beside the section's other keys, which are all read by then;
    // empty: it has one. Null: it always has.
    std::function<std::string()> why_idle{};
};

inline bool holds_section(const Field& field) {
    return std::holds_alternative<SectionField>(field.target) ||
           std::holds_alternative<OptionalSectionField>(field.target);
}
// The section that stands at a key, opened where it is not there yet; nothing where the key is of another kind.
inline std::optional<SectionField> section_in(const Field& field) {
    if (const auto* section = std::get_if<SectionField>(&field.target)) return *section;
    if (const auto* section = std::get_if<OptionalSectionField>(&field.target)) return section->open();
    return {};
}

// --- makers, so that a list reads as a table ---
inline Field number(std::string key, double& value, double si_per_unit, Range range, std::string meaning) {
    return {std::move(key), std::move(meaning), NumberField{&value, si_per_unit, range}};
}
inline Field integer(std::string key, std::int64_t& value, Range range, std::string meaning) {
    return {std::move(key), std::move(meaning), IntegerField{&value, range}};
}
inline Field flag(std::string key, bool& value, std::string meaning) {
    return {std::move(key), std::move(meaning), FlagField{&value}};
}
inline Field text(std::string key, std::string& value, std::string meaning) {
    return {std::move(key), std::move(meaning), TextField{&value}};
}
inline Field texts(std::string key, std::vector<std::string>& value, std::string meaning) {
    return {std::move(key), std::move(meaning), TextsField{&value}};
}
inline Field path(std::string key, std::filesystem::path& value, std::string meaning) {
    return {std::move(key), std::move(meaning), PathField{&value}};
}
inline Field path(std::string key, std::filesystem::path& value, std::string& where, std::string meaning) {
    return {std::move(key), std::move(meaning), PathField{&value, &where}};
}
// Enum E with values 0, 1, 2, ... in the order of `words`.
template <class E>
Field choice(std::string key, E& value, std::vector<std::string> words, std::string meaning) {
    return {std::move(key), std::move(meaning),
            ChoiceField{std::move(words), [&value](std::size_t i) { value = static_cast<E>(i); },
                        [&value] { return static_cast<std::size_t>(value); }}};
}
inline Field numbers(std::string key, std::vector<double>& value, double si_per_unit, Range range,
                     std::array<std::size_t, 2> count, std::string meaning) {
    return {std::move(key), std::move(meaning), NumbersField{&value, si_per_unit, range, count[0], count[1]}};
}
inline Field vector3(std::string key, Vec3d& value, double si_per_unit, Range range, std::string meaning) {
    return {std::move(key), std::move(meaning), Vec3Field{&value, si_per_unit, range}};
}
inline Field quaternion(std::string key, Quat& value, std::string meaning) {
    return {std::move(key), std::move(meaning), QuatField{&value}};
}
inline Field curve(std::string key, Curve& value, Range range, std::string meaning) {
    return {std::move(key), std::move(meaning), CurveField{&value, range}};
}
inline Field table(std::string key, Table& value, std::array<std::string, 2> names, Range x_range,
                   Range y_range, std::string meaning) {
    return {std::move(key), std::move(meaning),
            TableField{&value, std::move(names[0]), std::move(names[1]), x_range, y_range}};
}
// T has `Fields fields(T&)` and, when its keys depend on each other, `void validate(const T&)`.
template <class T>
SectionField section_of(T& value) {
    SectionField section{fields(value), {}};
    if constexpr (requires { validate(value); }) section.validate = [&value] { validate(value); };
    return section;
}
template <class T>
Field section(std::string key, T& value, std::string meaning) {
    return {std::move(key), std::move(meaning), section_of(value)};
}
template <class T>
Field section(std::string key, std::optional<T>& value, std::string meaning) {
    return {std::move(key), std::move(meaning),
            OptionalSectionField{[&value] { return section_of(value ? *value : value.emplace()); },
                                 [&value] { return value.has_value(); }}};
}
template <class T>
Field sections(std::string key, std::vector<T>& value, std::string meaning) {
    return {std::move(key), std::move(meaning),
            SectionsField{[&value] { return section_of(value.emplace_back()); },
                          [&value] { return value.size(); },
                          [&value](std::size_t i) { return section_of(value[i]); }}};
}
// The word may stand in place of the number, as "auto" does; `word_value` (SI) is out of the number's range.
inline Field or_word(Field field, std::string word, double word_value) {
    auto& number = std::get<NumberField>(field.target);
    number.word = std::move(word), number.word_value = word_value;
    return field;
}
// The word may stand in place of the list of mappings; `holds_word` is set then.
inline Field or_word(Field field, std::string word, bool& holds_word) {
    auto& many = std::get<SectionsField>(field.target);
    many.word = std::move(word), many.holds_word = &holds_word;
    return field;
}
inline Field required(Field field, bool* present = nullptr) {
    field.required = true;
    field.present = present;
    return field;
}
inline Field optional(Field field, bool& present) {
    field.present = &present;
    return field;
}
// A key, with all below it, that a replay may have otherwise than the recording (docs/recording.md).
inline Field beside_frames(Field field) {
    field.changes_frames = false;
    return field;
}

// A key that may have another value from one frame to the next.
inline Field per_frame(Field field) {
    field.per_frame = true;
    return field;
}

}  // namespace hilcam
