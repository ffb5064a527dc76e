#include "io/cache/atmosphere_cache.h"

#include <algorithm>
#include <string>
#include <vector>

#include "render/vocabulary/fnv.h"

namespace hilcam {
namespace {

std::string file_name_of(std::span<const double> key) {
    const std::uint64_t hash = hash_of(Fnv1a().value(), key.data(), key.size_bytes());
    return "atmosphere_" + std::to_string(hash) + ".bin";
}

}  // namespace

// The file begins with the whole key, so a hash collision is no hit.
bool AtmosphereCache::find(std::span<const double> key, std::span<float> values) const {
    return cache_.read(file_name_of(key), [&](CacheReader& in) {
        std::vector<double> head(key.size());
        in.list(head.data(), head.size());
        if (!in.good() || !std::equal(head.begin(), head.end(), key.begin())) return false;
        in.list(values.data(), values.size());
        return in.good();
    });
}

void AtmosphereCache::keep(std::span<const double> key, std::span<const float> values) const {
    cache_.write(file_name_of(key), [&](CacheWriter& out) {
        out.list(key.data(), key.size());
        out.list(values.data(), values.size());
    });
}

}  // namespace hilcam
