#pragma once
// Keys of an earlier version: the name that each of them has now, or what to use instead.

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

// Returns the key that was removed; null: there was no such key.
const RemovedKey* removed_key(std::string_view key);
// Returns the new name of a key; empty: there was no such key.
std::string_view renamed_key(std::string_view key);
// Returns the new word of a key's value; empty: it had no such word.
std::string_view renamed_value(std::string_view key, std::string_view value);

}  // namespace hilcam
