#pragma once
// Each configuration struct has one list of its keys: name with unit, meaning, range, where the value goes.
// Parsing, range check, unknown-key check, --set and the manual's tables all come from that list.
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

// A number, or one word in its place ("auto"). The word stores `word_value`, which is outside the range of
// numbers.
struct NumberField {
    double* value;
    double si_per_unit;
    Range range;
    std::string word{};  // empty: no word is accepted
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
// A list of texts in brackets, or a single text, which is a list of one.
struct TextsField {
    std::vector<std::string>* value;
};
// A path. A relative path starts at the folder of the file that names it. `where`, if given, gets the place
// of the key ("bench.yaml:7:11: objects.0.mesh"), for messages about the file that the path names.
struct PathField {
    std::filesystem::path* value;
    std::string* where = nullptr;
};
// One of a fixed list of words. `set` stores the word's index, `get` returns the present one.
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
// An objection of a section's `validate` to one of its keys ("up") or to a key further down
// ("objects.0.name"). The reader adds where in the file that key is.
class KeyError : public InputError {
  public:
    KeyError(std::string key, std::string reason)
        : InputError(key + ": " + reason), key_(std::move(key)), reason_(std::move(reason)) {}
    const std::string& key() const { return key_; }
    const std::string& reason() const { return reason_; }

  private:
    std::string key_, reason_;
};

// As refused() (check.h), but for a key.
inline KeyError refused_key(const std::string& key, const std::string& found, const std::string& accepted) {
    return KeyError(key, "found " + found + "; accepted: " + accepted);
}

// Runs check() and turns its InputError into an objection to that key.
template <class Check>
void at_key(const std::string& key, const Check& check) {
    try {
        check();
    } catch (const InputError& error) {
        throw KeyError(key, error.what());
    }
}

// A nested mapping, or the path of a file that holds it. `validate` runs after reading and throws KeyError,
// or InputError with a message that names its keys; the reader adds file and line.
struct SectionField {
    Fields fields;
    std::function<void()> validate;
};
// A nested mapping that is absent when it is left out. `open` returns the section and creates it with its
// defaults if needed.
struct OptionalSectionField {
    std::function<SectionField()> open;
    std::function<bool()> given;
};
// A list of mappings. `append` adds one default element to the owner and returns its section. References into
// earlier elements need not stay valid: each element is read before the next one is appended.
struct SectionsField {
    std::function<SectionField()> append;
    // Give the elements that the list has, so that they can be listed.
    std::function<std::size_t()> count{};
    std::function<SectionField(std::size_t)> at{};
    // A word that is accepted in place of the list, and the flag that it sets. Empty: no word is accepted.
    std::string word{};
    bool* holds_word = nullptr;
};

using FieldTarget = std::variant<NumberField, IntegerField, FlagField, TextField, TextsField, PathField,
                                 ChoiceField, NumbersField, Vec3Field, QuatField, CurveField, TableField,
                                 SectionField, OptionalSectionField, SectionsField>;

// Constructors and makers are in config_field.cpp: inline, they took a fifth of the compile time of each
// source that has sections.
struct Field {
    std::string key;
    std::string meaning;  // one line, with the unit where the key has none
    FieldTarget target;
    bool required = false;
    bool* present = nullptr;     // set when the key is given
    bool changes_frames = true;  // false: frames do not depend on it, so a replay may use another value
    bool per_frame = false;      // true: each frame may have another value (loop.levels)
    // Returns why a key that is given has no effect beside the section's other keys, which have all been read
    // by then; empty when it has one. Null: the key always has an effect.
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
// Returns the section at a key, and creates an absent one. Returns nothing if the key is of another kind.
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
// T needs `Fields fields(T&)` and, if its keys depend on each other, `void validate(const T&)`.
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
// Accepts the word, such as "auto", in place of the number; `word_value` (SI) is outside the number's range.
Field or_word(Field field, std::string_view word, double word_value);
// Accepts the word in place of the list of mappings, and sets `holds_word`.
Field or_word(Field field, std::string_view word, bool& holds_word);
Field required(Field field, bool* present = nullptr);
Field optional(Field field, bool& present);
// Marks a key, and all below it, as one that a replay may set otherwise than the recording
// (docs/recording.md).
Field beside_frames(Field field);
// Marks a key that may have another value in each frame.
Field per_frame(Field field);

}  // namespace hilcam
