#pragma once
// Keys that had another name in an earlier version, and the name that each of them has now.

#include <string_view>

namespace hilcam {

struct RenamedKey {
    std::string_view was, now;  // last words of the key: "kept_nodes", "probes"
};

// Returns the new name of a key; empty: there was no such key.
std::string_view renamed_key(std::string_view key);
// Returns the new word of a key's value; empty: it had no such word.
std::string_view renamed_value(std::string_view key, std::string_view value);

}  // namespace hilcam
