#include "io/config/yaml_value.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "io/config/config_advice.h"
#include "io/config/config_files.h"
#include "io/config/config_manual.h"
#include "io/config/renamed_keys.h"
#include "io/config/yaml_flag.h"
#include "io/system/text_number.h"
#include "render/vocabulary/plain_number.h"

namespace hilcam {
namespace {

std::optional<double> to_number(const YAML::Node& node) {
    return node.IsScalar() ? number_of(node.Scalar()) : std::nullopt;
}

// Returns an integer, which scripts may write as a decimal (256.0, 2.56e2).
std::optional<std::int64_t> to_whole(const std::string& text) {
    if (const auto value = parsed_as<std::int64_t>(text)) return value;
    constexpr double kExact = 9007199254740992;  // 2^53: each whole number up to it is a double
    const auto value = number_of(text);
    if (!value || std::abs(*value) > kExact || *value != std::floor(*value)) return {};
    return static_cast<std::int64_t>(*value);
}

}  // namespace

std::string accepted_or_word(const std::string& accepted, const std::string& word) {
    return word.empty() ? accepted : accepted + ", or '" + word + "'";
}

bool YamlValue::is_word(const std::string& word) const {
    return !word.empty() && node_.IsScalar() && node_.Scalar() == word;
}

void YamlValue::refuse(const std::string& accepted) const { refuse(node_, accepted); }

void YamlValue::refuse(const YAML::Node& at, const std::string& accepted, const std::string& advice) const {
    fail_at(place_, at, path_,
            "found " + shown(at) + "; accepted: " + accepted + " (" + field_.meaning + ")" + advice);
}

// Through an alias, a list of thousands may appear in thousands of places. 4 MiB of pairs in ordinary
// notation are half a million numbers.
void YamlValue::count_number(const YAML::Node& at) const {
    if (++numbers_ > 1000000)
        fail_at(place_, at, path_, "the configuration has more than 1000000 numbers in its lists");
}

double YamlValue::number(const YAML::Node& at, const Range& range, std::string_view column) const {
    count_number(at);
    const std::optional<double> value = to_number(at);
    if (!value || *value < range.least || *value > range.most)
        refuse(at, "a number, " + accepted(range),
               value ? unit_advice(column.empty() ? field_.key : column, *value, range) : "");
    return *value;
}

void YamlValue::require_list(std::size_t fewest, std::size_t most) const {
    if (node_.IsSequence() && node_.size() >= fewest && node_.size() <= most) return;
    const std::string count =
        fewest == most ? std::to_string(most) : std::to_string(fewest) + " to " + std::to_string(most);
    refuse("a list of " + count + " numbers");
}

void YamlValue::read(const NumberField& f) const {
    if (is_word(f.word))
        *f.value = f.word_value;
    else if (!f.word.empty() && !to_number(node_))
        refuse(accepted_or_word("a number, " + accepted(f.range), f.word));
    else
        *f.value = number(node_, f.range) * f.si_per_unit;
}

void YamlValue::read(const IntegerField& f) const {
    const auto value = node_.IsScalar() ? to_whole(node_.Scalar()) : std::nullopt;
    const auto as_double = static_cast<double>(value.value_or(0));
    if (!value || as_double < f.range.least || as_double > f.range.most)
        refuse("a whole number, " + accepted(f.range));
    *f.value = *value;
}

void YamlValue::read(const FlagField& f) const {
    const std::optional<bool> flag = node_.IsScalar() ? flag_of(node_.Scalar()) : std::nullopt;
    if (!flag) refuse("true or false");
    *f.value = *flag;
}

void YamlValue::read(const TextField& f) const {
    if (!node_.IsScalar()) refuse("a text");
    if (const std::string_view now = renamed_value(field_.key, node_.Scalar()); !now.empty())
        refuse(std::string(now) + ", as it was renamed");
    *f.value = node_.Scalar();
}

void YamlValue::read(const TextsField& f) const {
    if (!node_.IsScalar() && !node_.IsSequence()) refuse("a list of texts");
    std::vector<std::string> texts;
    if (node_.IsScalar()) texts.push_back(node_.Scalar());
    for (const auto& item : node_) {
        count_number(item);
        if (!item.IsScalar()) refuse(item, "a text");
        texts.push_back(item.Scalar());
    }
    *f.value = texts;
}

void YamlValue::read(const PathField& f) const {
    if (!node_.IsScalar() || node_.Scalar().empty()) refuse("a path");
    *f.value = file_named_from(place_.folder, node_.Scalar(), path_);
    if (f.where) *f.where = where_is(node_, place_) + (place_.command_line ? "" : ": " + path_);
}

void YamlValue::read(const ChoiceField& f) const {
    // free-run is accepted for free_run.
    std::string given = node_.IsScalar() ? node_.Scalar() : "";
    std::replace(given.begin(), given.end(), '-', '_');
    auto word = std::find(f.words.begin(), f.words.end(), given);
    // A script that read `off` may have written false.
    if (word == f.words.end())
        word = std::find_if(f.words.begin(), f.words.end(),
                            [&](const std::string& w) { return flag_of(w) && flag_of(w) == flag_of(given); });
    if (word == f.words.end()) {
        std::string words;
        for (const std::string& w : f.words) words += (words.empty() ? "" : " | ") + w;
        refuse(words);
    }
    f.set(static_cast<std::size_t>(word - f.words.begin()));
}

void YamlValue::read(const NumbersField& f) const {
    require_list(f.fewest, f.most);
    std::vector<double> values;
    for (const auto& item : node_) values.push_back(number(item, f.range) * f.si_per_unit);
    *f.value = values;
}

void YamlValue::read(const Vec3Field& f) const {
    require_list(3, 3);
    *f.value = f.si_per_unit *
               Vec3d{number(node_[0], f.range), number(node_[1], f.range), number(node_[2], f.range)};
}

void YamlValue::read(const QuatField& f) const {
    require_list(4, 4);
    const Range unit{-1.001, 1.001};
    const Quat q{number(node_[0], unit), number(node_[1], unit), number(node_[2], unit),
                 number(node_[3], unit)};
    if (std::abs(norm(q) - 1) > 1e-3)
        fail_at(place_, node_, path_,
                "found a quaternion of norm " + plain(norm(q)) + "; accepted: [w, x, y, z] of norm 1");
    *f.value = normalized(q);
}

void YamlValue::read(const CurveField& f) const {
    if (node_.IsScalar()) {
        *f.value = Curve::constant(number(node_, f.range));
    } else {
        if (!node_.IsSequence() || node_.size() == 0) refuse("a number, or [[wavelength_um, value], ...]");
        Table pairs = table({nullptr, "wavelength_um", "value", {0.1, 100}, f.range});
        *f.value = {std::move(pairs.x), std::move(pairs.y), {}};
    }
    f.value->where = where_is(node_, place_);
}

void YamlValue::read(const TableField& f) const { *f.value = table(f); }

Table YamlValue::table(const TableField& f) const {
    const std::string pair_text = "[" + f.x_name + ", " + f.y_name + "]";
    if (!node_.IsSequence() || node_.size() == 0) refuse("[" + pair_text + ", ...]");
    Table out;
    for (const auto& pair : node_) {
        if (!pair.IsSequence() || pair.size() != 2) refuse(pair, "a pair " + pair_text);
        const double x = number(pair[0], f.x_range, f.x_name);
        if (!out.x.empty() && x <= out.x.back()) refuse(pair[0], f.x_name + " that rises from pair to pair");
        out.x.push_back(x);
        out.y.push_back(number(pair[1], f.y_range, f.y_name));
    }
    return out;
}

}  // namespace hilcam
