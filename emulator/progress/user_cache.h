#pragma once
// The cache of the user who runs the program (io/cache/cache.h). It logs what it computes and stores.

#include "io/cache/cache.h"

namespace hilcam {

// Returns the cache that $HILCAM_CACHE and $HILCAM_CACHE_MB describe. writes: new entries are stored. Throws
// InputError when the size limit is not a number.
Cache user_cache(bool writes = true);
// Returns such a cache in another folder; an empty path stands for the user's.
Cache user_cache_at(const std::filesystem::path& folder, bool writes);

}  // namespace hilcam
