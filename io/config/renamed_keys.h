#pragma once
// Keys of an earlier version: their new names, or what to use instead.

#include <string_view>

namespace hilcam {

struct RenamedKey {
    std::string_view was, now;  // last words of the key: "kept_nodes", "probes"
};

struct RemovedKey {
    std::string_view was;        // last word of the key
    std::string_view beside;     // last word of a key in the same section
    std::string_view no_effect;  // value with which it changed no frame; empty: no value did by itself
    std::string_view instead;    // end of a message: what replaces it
};

// Returns the removed key; null when no such key was removed.
const RemovedKey* removed_key(std::string_view key);
// Returns the new name of a key; empty when it was not renamed.
std::string_view renamed_key(std::string_view key);
// Returns the new word of a key's value; empty when it was not renamed.
std::string_view renamed_value(std::string_view key, std::string_view value);

}  // namespace hilcam
