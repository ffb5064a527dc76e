#pragma once
// A YAML document with the places of its values, shared by the reader of configurations (config_yaml.cpp) and
// the reader of single values (yaml_value.cpp). Every error is an InputError, one line: file:line:column, the
// key's path, what was found.

#include <filesystem>
#include <string>
#include <string_view>

namespace YAML {
class Node;
}

namespace hilcam {

// The place of values: a file, or the command line.
struct YamlPlace {
    std::string name;              // file, or "--set KEY"
    std::filesystem::path folder;  // relative paths begin here
    bool command_line = false;
};

// Returns "file:line:column"; the place's name for a value without a line.
std::string where_is(const YAML::Node& node, const YamlPlace& place);
// Throws InputError. path: of the key; empty: the whole file.
[[noreturn]] void fail_at(const YamlPlace& place, const YAML::Node& node, const std::string& path,
                          const std::string& what);
// Returns a value for messages: a scalar in quotes, a mapping or a list by its kind.
std::string shown(const YAML::Node& node);

// Parses the bytes of a file. Throws InputError for malformed YAML and for a second document.
YAML::Node only_document(std::string_view bytes, const YamlPlace& place);
// Parses the same. Throws InputError also for a document that is not a mapping. path: of the key that the
// mapping is for.
YAML::Node only_mapping(std::string_view bytes, const YamlPlace& place, const std::string& path);

}  // namespace hilcam
