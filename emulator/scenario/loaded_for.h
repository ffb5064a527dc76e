#pragma once
// Errors in files that a scenario names.

#include <string>

#include "render/vocabulary/check.h"

namespace hilcam {

// Returns what `load` returns. An error of it in a file says where the scenario names that file; key_where: that place, or empty.
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
