#include "io/config/yaml_flag.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <string_view>

namespace hilcam {

std::optional<bool> flag_of(const std::string& word) {
    for (const bool value : {true, false})
        for (const char* known : {value ? "true" : "false", value ? "yes" : "no", value ? "on" : "off"}) {
            const std::string small = known;
            std::string first = small, capitals = small;
            first[0] = static_cast<char>(std::toupper(first[0]));
            for (char& c : capitals) c = static_cast<char>(std::toupper(c));
            if (word == small || word == first || word == capitals) return value;
        }
    return {};
}

std::string known_key(const std::string& key, const Fields& known) {
    const auto is_known = [&](std::string_view word) {
        return std::any_of(known.begin(), known.end(), [&](const Field& f) { return f.key == word; });
    };
    const std::optional<bool> flag = is_known(key) ? std::nullopt : flag_of(key);
    return flag && is_known(*flag ? "on" : "off") ? (*flag ? "on" : "off") : key;
}

YAML::Node value_of_key(const YAML::Node& map, const std::string& key, const Fields& known) {
    if (const YAML::Node own = map[key]; own.IsDefined() || !flag_of(key)) return own;
    for (const auto& entry : map)
        if (entry.first.IsScalar() && known_key(entry.first.Scalar(), known) == key) return entry.second;
    return YAML::Node(YAML::NodeType::Undefined);
}

}  // namespace hilcam
