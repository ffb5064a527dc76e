#include "emulator/tradeoff/reference_cache.h"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <set>
#include <sstream>
#include <type_traits>

#include "emulator/scenario/scenario_listing.h"
#include "render/vocabulary/fnv.h"

namespace hilcam {
namespace {

std::uint64_t hash_of(const std::string& text) {
    Fnv1a hash;
    hash.take_bytes(text);
    return hash.value();
}

// Has no padding between members.
struct Header {
    std::array<char, 8> magic = {'h', 'i', 'l', 'c', 'a', 'm', 'R', 'P'};
    std::uint32_t version = kReferenceVersion;
    std::uint32_t unused = 0;
    std::uint64_t hash = 0;
    std::int32_t width = 0, height = 0;
    std::int64_t frames = 0;
    std::uint64_t lit_px = 0;
    double p99 = 0, rms = 0, within_half_fraction = 0, seconds = 0;
};
static_assert(sizeof(Header) == 80 && std::is_trivially_copyable_v<Header>);

// Refuses impossible sizes before memory is allocated.
bool is_size(const Header& header) {
    constexpr std::int32_t kMax_px = 1 << 16;
    return header.width >= 1 && header.height >= 1 && header.width <= kMax_px && header.height <= kMax_px;
}

bool read_picture(CacheReader& in, const std::string& key, std::span<ElectronImage* const> beside,
                  std::optional<ReferencePicture>& picture) {
    const Header expected;
    Header header;
    in(header);
    if (!in.good() || header.magic != expected.magic || header.version != expected.version ||
        header.hash != hash_of(key) || !is_size(header) ||
        in.left() != (2 + beside.size()) * sizeof(float) * static_cast<std::uint64_t>(header.width) *
                         static_cast<std::uint64_t>(header.height))
        return false;
    picture = {ElectronImage(header.width, header.height),
               ElectronImage(header.width, header.height),
               {header.p99, header.rms, header.within_half_fraction, header.lit_px},
               static_cast<int>(header.frames),
               header.seconds};
    for (ElectronImage* image : {&picture->mean, &picture->dark}) in.list(image->data(), image->pixels());
    for (ElectronImage* image : beside) {
        *image = ElectronImage(header.width, header.height);
        in.list(image->data(), image->pixels());
    }
    return in.good();
}

}  // namespace

std::string reference_key(const ScenarioConfig& reference, const Pose& body, const ReferenceLimits& limits) {
    const Vec3d& p = body.position_world_m;
    const Quat& q = body.world_from_body;
    std::string key =
        fmt::format("frames: {}\nstandard error: {}\nposition: {} {} {}\nattitude: {} {} {} {}\n",
                    limits.max_frames, limits.standard_error_sigma, p.x, p.y, p.z, q.w, q.x, q.y, q.z);
    std::set<std::string> defaults;
    ScenarioConfig plain;
    std::istringstream own(scenario_listing(plain)), given(scenario_listing(reference));
    for (std::string line; std::getline(own, line);)
        if (line.starts_with("quality.")) defaults.insert(line);
    for (std::string line; std::getline(given, line);)
        if (!defaults.contains(line)) key += line + "\n";
    return key;
}

std::string reference_name(const std::string& key) {
    return "reference_" + std::to_string(hash_of(key)) + ".bin";
}

std::optional<ReferencePicture> kept_reference(const Cache& cache, const std::string& key,
                                               std::span<ElectronImage* const> beside) {
    std::optional<ReferencePicture> out;
    if (cache.read(reference_name(key), [&](CacheReader& in) { return read_picture(in, key, beside, out); }))
        return out;
    return std::nullopt;
}

void keep_reference(const Cache& cache, const std::string& key, const ReferencePicture& p,
                    std::span<const ElectronImage* const> beside) {
    Header header;
    header.hash = hash_of(key);
    header.width = p.mean.width(), header.height = p.mean.height();
    header.frames = p.frames, header.seconds = p.seconds;
    header.p99 = p.standard_error.p99, header.rms = p.standard_error.rms;
    header.within_half_fraction = p.standard_error.within_half_fraction;
    header.lit_px = p.standard_error.lit_px;
    cache.write(reference_name(key), [&](CacheWriter& out) {
        out(header);
        for (const ElectronImage* image : {&p.mean, &p.dark}) out.list(image->data(), image->pixels());
        for (const ElectronImage* image : beside) out.list(image->data(), image->pixels());
    });
}

}  // namespace hilcam
