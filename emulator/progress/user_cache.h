#pragma once
// The cache of whoever runs the program (io/cache/cache.h), which tells the log what it makes anew.

#include "io/cache/cache.h"

namespace hilcam {

// Returns the cache of $HILCAM_CACHE and $HILCAM_CACHE_MB. writes: what is made is kept. Throws InputError when
// the bound is no number.
Cache user_cache(bool writes = true);
// The same with a folder of its own; empty: the user's.
Cache user_cache_at(const std::filesystem::path& folder, bool writes);

}  // namespace hilcam
