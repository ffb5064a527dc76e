#include "render/vocabulary/config_field.h"

namespace hilcam {

Field::Field(std::string_view key_, std::string_view meaning_, FieldTarget target_)
    : key(key_), meaning(meaning_), target(std::move(target_)) {}
Field::Field(const Field&) = default;
Field::Field(Field&&) noexcept = default;
Field& Field::operator=(const Field&) = default;
Field& Field::operator=(Field&&) noexcept = default;
Field::~Field() = default;

std::optional<SectionField> section_in(const Field& field) {
    if (const auto* section = std::get_if<SectionField>(&field.target)) return *section;
    if (const auto* section = std::get_if<OptionalSectionField>(&field.target)) return section->open();
    return {};
}

Field number(std::string_view key, double& value, double si_per_unit, Range range, std::string_view meaning) {
    return {key, meaning, NumberField{&value, si_per_unit, range}};
}

Field integer(std::string_view key, std::int64_t& value, Range range, std::string_view meaning) {
    return {key, meaning, IntegerField{&value, range}};
}

Field flag(std::string_view key, bool& value, std::string_view meaning) {
    return {key, meaning, FlagField{&value}};
}

Field text(std::string_view key, std::string& value, std::string_view meaning) {
    return {key, meaning, TextField{&value}};
}

Field texts(std::string_view key, std::vector<std::string>& value, std::string_view meaning) {
    return {key, meaning, TextsField{&value}};
}

Field path(std::string_view key, std::filesystem::path& value, std::string_view meaning) {
    return {key, meaning, PathField{&value}};
}

Field path(std::string_view key, std::filesystem::path& value, std::string& where, std::string_view meaning) {
    return {key, meaning, PathField{&value, &where}};
}

Field choice_field(std::string_view key, ChoiceField choice, std::string_view meaning) {
    return {key, meaning, std::move(choice)};
}

std::vector<std::string> words_of(std::initializer_list<std::string_view> words) {
    return {words.begin(), words.end()};
}

Field numbers(std::string_view key, std::vector<double>& value, double si_per_unit, Range range,
              std::array<std::size_t, 2> count, std::string_view meaning) {
    return {key, meaning, NumbersField{&value, si_per_unit, range, count[0], count[1]}};
}

Field vector3(std::string_view key, Vec3d& value, double si_per_unit, Range range, std::string_view meaning) {
    return {key, meaning, Vec3Field{&value, si_per_unit, range}};
}

Field quaternion(std::string_view key, Quat& value, std::string_view meaning) {
    return {key, meaning, QuatField{&value}};
}

Field curve(std::string_view key, Curve& value, Range range, std::string_view meaning) {
    return {key, meaning, CurveField{&value, range}};
}

Field table(std::string_view key, Table& value, std::array<std::string_view, 2> names, Range x_range,
            Range y_range, std::string_view meaning) {
    return {key, meaning, TableField{&value, std::string(names[0]), std::string(names[1]), x_range, y_range}};
}

Field section_field(std::string_view key, SectionField section, std::string_view meaning) {
    return {key, meaning, std::move(section)};
}

Field optional_section_field(std::string_view key, OptionalSectionField section, std::string_view meaning) {
    return {key, meaning, std::move(section)};
}

Field sections_field(std::string_view key, SectionsField sections, std::string_view meaning) {
    return {key, meaning, std::move(sections)};
}

Field or_word(Field field, std::string_view word, double word_value) {
    auto& number = std::get<NumberField>(field.target);
    number.word = word, number.word_value = word_value;
    return field;
}

Field or_word(Field field, std::string_view word, bool& holds_word) {
    auto& many = std::get<SectionsField>(field.target);
    many.word = word, many.holds_word = &holds_word;
    return field;
}

Field required(Field field, bool* present) {
    field.required = true;
    field.present = present;
    return field;
}

Field optional(Field field, bool& present) {
    field.present = &present;
    return field;
}

Field beside_frames(Field field) {
    field.changes_frames = false;
    return field;
}

Field per_frame(Field field) {
    field.per_frame = true;
    return field;
}

}  // namespace hilcam
