#include "io/config/yaml_place.h"

#include <yaml-cpp/yaml.h>

#include "io/config/open_bracket.h"
#include "io/config/second_document.h"
#include "io/system/text_mark.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// The library has the same words for each of these.
constexpr const char* kYamlRules =
    " (tabs are not allowed; a space comes after the colon; the keys of one mapping begin in one column)";

}  // namespace

std::string where_is(const YAML::Node& node, const YamlPlace& place) {
    const YAML::Mark mark = node.IsDefined() ? node.Mark() : YAML::Mark::null_mark();
    if (place.command_line || mark.is_null()) return place.name;
    return place.name + ":" + std::to_string(mark.line + 1) + ":" + std::to_string(mark.column + 1);
}

void fail_at(const YamlPlace& place, const YAML::Node& node, const std::string& path,
             const std::string& what) {
    throw InputError(where_is(node, place) + ": " + (path.empty() || place.command_line ? "" : path + ": ") +
                     what);
}

std::string shown(const YAML::Node& node) {
    if (!node.IsDefined() || node.IsNull()) return "nothing";
    if (node.IsScalar()) return in_quotes(node.Scalar());
    return node.IsMap() ? "a mapping" : "a list of " + std::to_string(node.size());
}

YAML::Node only_document(std::string_view bytes, const YamlPlace& place) {
    const std::string text = in_utf8(bytes);
    if (const auto line = line_of_second_document(text))
        throw InputError(place.name + ":" + std::to_string(*line) +
                         ":1: a second document ('---') begins here; accepted: one a file");
    try {
        // Without aliases a text cannot expand; with them, one node appears in many places.
        return YAML::Load(text);
    } catch (const YAML::Exception& error) {
        const std::string open = unpaired_bracket(text);
        throw InputError(place.name + ":" + std::to_string(error.mark.line + 1) + ":" +
                         std::to_string(error.mark.column + 1) + ": not YAML: " + shortened(error.msg) +
                         (open.empty() ? kYamlRules : "; " + open));
    }
}

YAML::Node only_mapping(std::string_view bytes, const YamlPlace& place, const std::string& path) {
    const YAML::Node node = only_document(bytes, place);
    if (!node.IsMap()) fail_at(place, node, path, "found " + shown(node) + "; accepted: a mapping of keys");
    return node;
}

}  // namespace hilcam
