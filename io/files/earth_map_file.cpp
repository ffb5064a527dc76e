#include "io/files/earth_map_file.h"

#include <tbb/parallel_for.h>
#include <zlib.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <string_view>

#include "io/system/input_file.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr std::size_t kHead = 28, kChannels = EarthSample::kChannels;
constexpr std::uintmax_t kMaxMapBytes = 4'000'000'000;

std::uint32_t u32_at(std::span<const std::uint8_t> bytes, std::size_t at) {
    return static_cast<std::uint32_t>(bytes[at]) | static_cast<std::uint32_t>(bytes[at + 1]) << 8 |
           static_cast<std::uint32_t>(bytes[at + 2]) << 16 | static_cast<std::uint32_t>(bytes[at + 3]) << 24;
}

// Restores one channel of a tile from its differences, into every eighth byte.
void restore(std::span<const std::uint8_t> in, std::size_t side, std::span<std::uint8_t> out) {
    std::memcpy(out.data(), in.data(), in.size());
    const auto at = [&](std::size_t y, std::size_t x) -> std::uint8_t& { return out[y * side + x]; };
    for (std::size_t y = 0; y < side; ++y)
        for (std::size_t x = 0; x < side; ++x) {
            int expected = 0;
            if (x > 0 && y > 0) {
                const int left = at(y, x - 1), above = at(y - 1, x), corner = at(y - 1, x - 1);
                expected =
                    std::max(std::min(left, above), std::min(std::max(left, above), left + above - corner));
            } else if (x > 0) {
                expected = at(y, x - 1);
            } else if (y > 0) {
                expected = at(y - 1, x);
            }
            at(y, x) = static_cast<std::uint8_t>(at(y, x) + expected);
        }
}

}  // namespace

EarthMap decode_earth_map(std::span<const std::uint8_t> bytes, const std::string& name) {
    const auto refuse = [&](const std::string& what) { throw InputError(name + ": " + what); };
    const auto begins_with = [&](std::string_view magic) {
        return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
    };
    // A picture that has to be packed first.
    for (const std::string_view picture : {"II*", "MM", "II+", "\x89PNG", "\xff\xd8"})
        if (begins_with(picture)) refuse("is a picture; accepted: what tools/make_earth_map.py makes of it");
    if (bytes.size() < kHead || !begins_with("HILEARTH"))
        refuse("is no map of the Earth; accepted: what tools/make_earth_map.py writes");
    const std::uint32_t version = u32_at(bytes, 8), width = u32_at(bytes, 12), height = u32_at(bytes, 16),
                        side = u32_at(bytes, 20), channels = u32_at(bytes, 24);
    if (version != 1) refuse("has version " + std::to_string(version) + "; accepted: 1");
    if (channels != kChannels) refuse("has " + std::to_string(channels) + " channels; accepted: 8");
    const bool power = (height & (height - 1)) == 0;
    if (!power || height < 16 || height > static_cast<std::uint32_t>(EarthMap::kMaxHeight) ||
        width != 2 * height)
        refuse("is " + std::to_string(width) + " x " + std::to_string(height) +
               "; accepted: twice as wide as high, and a height that is a power of two from 16 to " +
               std::to_string(EarthMap::kMaxHeight));
    if (side < 16 || side > height || (side & (side - 1)) != 0)
        refuse("has tiles of " + std::to_string(side) +
               "; accepted: powers of two from 16 to the map's height");
    const std::size_t across = width / side, tiles = across * (height / side);
    if (bytes.size() < kHead + 4 * tiles) refuse("ends within its list of tiles");
    std::vector<std::span<const std::uint8_t>> streams;
    std::size_t at = kHead + 4 * tiles;
    for (std::size_t i = 0; i < tiles; ++i) {
        const std::size_t length = u32_at(bytes, kHead + 4 * i);
        if (length > bytes.size() - at)
            refuse("ends within tile " + std::to_string(i) + " of " + std::to_string(tiles));
        streams.push_back(bytes.subspan(at, length));
        at += length;
    }
    if (at != bytes.size()) refuse("has " + std::to_string(bytes.size() - at) + " bytes after its last tile");
    // A stream too short for a tile is found before the map's memory is allocated: deflate compresses 1032
    // times at most.
    const std::size_t plane = std::size_t{side} * side;
    for (std::size_t i = 0; i < tiles; ++i)
        if (streams[i].size() * 1100 + 64 < plane * kChannels)
            refuse("tile " + std::to_string(i) + " has " + std::to_string(streams[i].size()) +
                   " bytes, which cannot hold it");

    EarthMap::Level finest{static_cast<int>(width), static_cast<int>(height), {}};
    finest.texels.resize(std::size_t{width} * height);
    std::atomic<std::size_t> broken = tiles;
    tbb::parallel_for(std::size_t{0}, tiles, [&](std::size_t i) {
        std::vector<std::uint8_t> planes(plane * kChannels), channel(plane);
        auto length = static_cast<uLongf>(planes.size());
        if (uncompress(planes.data(), &length, streams[i].data(), static_cast<uLong>(streams[i].size())) !=
                Z_OK ||
            length != planes.size()) {
            broken = i;
            return;
        }
        const std::size_t x0 = i % across * side, y0 = i / across * side;
        for (std::size_t c = 0; c < kChannels; ++c) {
            restore({planes.data() + c * plane, plane}, side, channel);
            for (std::size_t y = 0; y < side; ++y)
                for (std::size_t x = 0; x < side; ++x)
                    finest.texels[(y0 + y) * width + x0 + x][c] = channel[y * side + x];
        }
    });
    if (broken != tiles)
        refuse("a tile is damaged: number " + std::to_string(broken) + " of " + std::to_string(tiles));
    return EarthMap(EarthMap::halves(std::move(finest)));
}

EarthMap read_earth_map(const std::filesystem::path& file) {
    const std::string bytes =
        read_input_file(file, {kMaxMapBytes, "a map of the Earth (tools/make_earth_map.py)"});
    return decode_earth_map({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()},
                            file.string());
}

}  // namespace hilcam
