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
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
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

using FieldTarget = std::variant<NumberField, IntegerField, FlagField, TextField, TextsField, PathField,
                                 ChoiceField, NumbersField, Vec3Field, QuatField, CurveField, TableField,
                                 SectionField, OptionalSectionField, SectionsField>;

// Constructors and makers are in config_field.cpp: inline, they took a fifth of the time of compiling a source of
// sections.
struct Field {
    std::string key;
    std::string meaning;  // one line, with the unit where the key has none
    FieldTarget target;
    bool required = false;
    bool* present = nullptr;     // set when the key is given
    bool changes_frames = true;  // false: frames do not depend on it, so that a replay may have another value
    bool per_frame = false;      // true: it may have another value from one frame to the next (loop.levels)
    // Says why the key, where it is given, has no effect beside the section's other keys, which are all read by then;
    // empty: it has one. Null: it always has.
    std::function<std::string()> why_idle{};

    Field(std::string_view key_, std::string_view meaning_, FieldTarget target_);
    Field(const Field&);
    Field(Field&&) noexcept;
    Field& operator=(const Field&);
    Field& operator=(Field&&) noexcept;
    ~Field();
};

inline bool holds_section(const Field& field) {
    return std::holds_alternative<SectionField>(field.target) ||
           std::holds_alternative<OptionalSectionField>(field.target);
}
// Returns the section that stands at a key, opened where it is not there yet; nothing where the key is of another kind.
std::optional<SectionField> section_in(const Field& field);

// --- makers, so that a list reads as a table ---
Field number(std::string_view key, double& value, double si_per_unit, Range range, std::string_view meaning);
Field integer(std::string_view key, std::int64_t& value, Range range, std::string_view meaning);
Field flag(std::string_view key, bool& value, std::string_view meaning);
Field text(std::string_view key, std::string& value, std::string_view meaning);
Field texts(std::string_view key, std::vector<std::string>& value, std::string_view meaning);
Field path(std::string_view key, std::filesystem::path& value, std::string_view meaning);
Field path(std::string_view key, std::filesystem::path& value, std::string& where, std::string_view meaning);
Field choice_field(std::string_view key, ChoiceField choice, std::string_view meaning);
std::vector<std::string> words_of(std::initializer_list<std::string_view> words);
// Enum E with values 0, 1, 2, ... in the order of `words`.
template <class E>
Field choice(std::string_view key, E& value, std::vector<std::string> words, std::string_view meaning) {
    return choice_field(key,
                        {std::move(words), [&value](std::size_t i) { value = static_cast<E>(i); },
                         [&value] { return static_cast<std::size_t>(value); }},
                        meaning);
}
template <class E>
Field choice(std::string_view key, E& value, std::initializer_list<std::string_view> words,
             std::string_view meaning) {
    return choice(key, value, words_of(words), meaning);
}
Field numbers(std::string_view key, std::vector<double>& value, double si_per_unit, Range range,
              std::array<std::size_t, 2> count, std::string_view meaning);
Field vector3(std::string_view key, Vec3d& value, double si_per_unit, Range range, std::string_view meaning);
Field quaternion(std::string_view key, Quat& value, std::string_view meaning);
Field curve(std::string_view key, Curve& value, Range range, std::string_view meaning);
Field table(std::string_view key, Table& value, std::array<std::string_view, 2> names, Range x_range,
            Range y_range, std::string_view meaning);
Field section_field(std::string_view key, SectionField section, std::string_view meaning);
Field optional_section_field(std::string_view key, OptionalSectionField section, std::string_view meaning);
Field sections_field(std::string_view key, SectionsField sections, std::string_view meaning);
// T has `Fields fields(T&)` and, when its keys depend on each other, `void validate(const T&)`.
template <class T>
SectionField section_of(T& value) {
    SectionField section{fields(value), {}};
    if constexpr (requires { validate(value); }) section.validate = [&value] { validate(value); };
    return section;
}
template <class T>
Field section(std::string_view key, T& value, std::string_view meaning) {
    return section_field(key, section_of(value), meaning);
}
template <class T>
Field section(std::string_view key, std::optional<T>& value, std::string_view meaning) {
    return optional_section_field(key,
                                  {[&value] { return section_of(value ? *value : value.emplace()); },
                                   [&value] { return value.has_value(); }},
                                  meaning);
}
template <class T>
Field sections(std::string_view key, std::vector<T>& value, std::string_view meaning) {
    return sections_field(
        key,
        {[&value] { return section_of(value.emplace_back()); }, [&value] { return value.size(); },
         [&value](std::size_t i) { return section_of(value[i]); }},
        meaning);
}
// The word may stand in place of the number, as "auto" does; `word_value` (SI) is out of the number's range.
Field or_word(Field field, std::string_view word, double word_value);
// The word may stand in place of the list of mappings; `holds_word` is set then.
Field or_word(Field field, std::string_view word, bool& holds_word);
Field required(Field field, bool* present = nullptr);
Field optional(Field field, bool& present);
// A key, with all below it, that a replay may have otherwise than the recording (docs/recording.md).
Field beside_frames(Field field);
// A key that may have another value from one frame to the next.
Field per_frame(Field field);

}  // namespace hilcam
