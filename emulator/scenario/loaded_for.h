#pragma once
// Adds the place in the scenario to errors in files that it names.

#include <string>

#include "render/vocabulary/check.h"

namespace hilcam {

// Returns the result of `load`. If it throws InputError, the message is preceded by key_where: the place
// where the scenario names the file, or empty.
template <class Load>
auto loaded_for(const std::string& key_where, const Load& load) {
    try {
        return load();
    } catch (const InputError& error) {
        if (key_where.empty()) throw;
        throw InputError(key_where + ": " + error.what());
    }
}

}  // namespace hilcam
