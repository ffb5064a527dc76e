#include "emulator/progress/user_cache.h"

#include <spdlog/spdlog.h>

namespace hilcam {

Cache user_cache(bool writes) { return user_cache_at({}, writes); }

Cache user_cache_at(const std::filesystem::path& folder, bool writes) {
    return Cache({folder.empty() ? cache_folder() : folder, cache_bound_bytes(), writes,
                  [](const std::string& line) { spdlog::info("cache: {}", line); }});
}

}  // namespace hilcam
