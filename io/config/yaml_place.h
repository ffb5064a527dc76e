#pragma once
// A YAML document, and the places of its values, as the reader of configurations (config_yaml.cpp) and the reader of single values
// (yaml_value.cpp) share them. Every error is one InputError line: file:line:column, the key's path, what was found.

#include <filesystem>
#include <string>
#include <string_view>

namespace YAML {
class Node;
}

namespace hilcam {

// Where values stand: in a file, or on the command line.
struct YamlPlace {
    std::string name;              // file, or "--set KEY"
    std::filesystem::path folder;  // relative paths begin here
    bool command_line = false;
};

// Returns "file:line:column"; the place's name for a value that has no line.
std::string where_is(const YAML::Node& node, const YamlPlace& place);
// Throws InputError. path: of the key; empty: that of the whole file.
[[noreturn]] void fail_at(const YamlPlace& place, const YAML::Node& node, const std::string& path,
                          const std::string& what);
// Returns a value as messages have it: a scalar in quotes, a mapping or a list by its kind alone.
std::string shown(const YAML::Node& node);

// Parses the bytes of a file. InputError for what is no YAML, and for a second document.
YAML::Node only_document(std::string_view bytes, const YamlPlace& place);
// The same, and InputError for a document that is no mapping. path: of the key that the mapping is for.
YAML::Node only_mapping(std::string_view bytes, const YamlPlace& place, const std::string& path);

}  // namespace hilcam
