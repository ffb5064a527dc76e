#pragma once
// Reads the value of one key: a number, a word, a path, a list, a curve. config_yaml.cpp reads sections and
// whole files.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "io/config/yaml_place.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

class YamlValue {
  public:
    // All arguments must outlive this. numbers: counts the numbers in all lists of the configuration.
    YamlValue(const YAML::Node& node, const YamlPlace& place, const Field& field, const std::string& path,
              std::size_t& numbers)
        : node_(node), place_(place), field_(field), path_(path), numbers_(numbers) {}

    // Each stores the value in the field's target. They throw InputError: found, accepted.
    void read(const NumberField& f) const;
    void read(const IntegerField& f) const;
    void read(const FlagField& f) const;
    void read(const TextField& f) const;
    void read(const TextsField& f) const;
    void read(const PathField& f) const;
    void read(const ChoiceField& f) const;
    void read(const NumbersField& f) const;
    void read(const Vec3Field& f) const;
    void read(const QuatField& f) const;
    void read(const CurveField& f) const;
    void read(const TableField& f) const;

    // True when the value is a word in place of a number or a list.
    bool is_word(const std::string& word) const;
    // Throws InputError: what was found, what is accepted, the key's meaning. at: the value, or a part of it.
    [[noreturn]] void refuse(const YAML::Node& at, const std::string& accepted,
                             const std::string& advice = "") const;

  private:
    const YAML::Node& node_;
    const YamlPlace& place_;
    const Field& field_;
    const std::string& path_;
    std::size_t& numbers_;

    [[noreturn]] void refuse(const std::string& accepted) const;
    // column: of a table.
    double number(const YAML::Node& at, const Range& range, std::string_view column = {}) const;
    void require_list(std::size_t fewest, std::size_t most) const;
    void count_number(const YAML::Node& at) const;
    Table table(const TableField& f) const;
};

// Returns what a key accepts, including the word.
std::string accepted_or_word(const std::string& accepted, const std::string& word);

}  // namespace hilcam
