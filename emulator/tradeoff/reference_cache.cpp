#include "emulator/tradeoff/reference_cache.h"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <set>
#include <sstream>
#include <type_traits>

#include "emulator/scenario/scenario_listing.h"
#include "io/system/crc32.h"

namespace hilcam {
namespace {

// FNV-1a (Fowler, Noll & Vo, 1991).
std::uint64_t hash_of(const std::string& text) {
    std::uint64_t hash = 14695981039346656037u;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
    return hash;
}

// No holes between the members: all bytes are checked.
struct Header {
    std::array<char, 8> magic = {'h', 'i', 'l', 'c', 'a', 'm', 'R', 'P'};
    std::uint32_t version = kReferenceVersion;
    std::uint32_t crc = 0;  // of the header, in which it is 0, and of both pictures
    std::uint64_t hash = 0;
    std::int32_t width = 0, height = 0;
    std::int64_t frames = 0;
    std::uint64_t lit_px = 0;
    double p99 = 0, rms = 0, within_half_fraction = 0, seconds = 0;
};
static_assert(sizeof(Header) == 80 && std::is_trivially_copyable_v<Header>);

std::span<const std::uint8_t> bytes_of(const void* data, std::size_t size) {
    return {static_cast<const std::uint8_t*>(data), size};
}
std::span<const std::uint8_t> bytes_of(const ElectronImage& image) {
    return bytes_of(image.data(), image.pixels() * sizeof(float));
}

std::uint32_t crc_of(Header header, const ElectronImage& mean, const ElectronImage& dark) {
    header.crc = 0;
    return crc32_of(bytes_of(dark), crc32_of(bytes_of(mean), crc32_of(bytes_of(&header, sizeof header))));
}

bool read(std::ifstream& in, void* to, std::size_t size) {
    return static_cast<bool>(in.read(static_cast<char*>(to), static_cast<std::streamsize>(size)));
}

// The image is as large as the file says, which must be so long.
bool has_pictures(const Header& header, std::uintmax_t file_size) {
    constexpr std::int32_t kMax_px = 1 << 16;
    if (header.width < 1 || header.height < 1 || header.width > kMax_px || header.height > kMax_px)
        return false;
    const auto pixels =
        static_cast<std::uintmax_t>(header.width) * static_cast<std::uintmax_t>(header.height);
    return file_size == sizeof header + 2 * pixels * sizeof(float);
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

std::filesystem::path reference_file(const std::filesystem::path& folder, const std::string& key) {
    return folder / ("reference_" + std::to_string(hash_of(key)) + ".bin");
}

std::optional<ReferencePicture> kept_reference(const std::filesystem::path& file, const std::string& key) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) return std::nullopt;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    std::ifstream in(file, std::ios::binary);
    const Header expected;
    Header header;
    if (error || !read(in, &header, sizeof header) || header.magic != expected.magic ||
        header.version != expected.version || header.hash != hash_of(key) || !has_pictures(header, size))
        return std::nullopt;
    ReferencePicture out{ElectronImage(header.width, header.height),
                         ElectronImage(header.width, header.height),
                         {header.p99, header.rms, header.within_half_fraction, header.lit_px},
                         static_cast<int>(header.frames),
                         header.seconds};
    for (ElectronImage* image : {&out.mean, &out.dark})
        if (!read(in, image->data(), image->pixels() * sizeof(float))) return std::nullopt;
    if (header.crc != crc_of(header, out.mean, out.dark)) return std::nullopt;
    return out;
}

// Beside it first, then renamed: two programs may do this at once.
void keep_reference(const std::filesystem::path& file, const std::string& key, const ReferencePicture& p) {
    Header header;
    header.hash = hash_of(key);
    header.width = p.mean.width(), header.height = p.mean.height();
    header.frames = p.frames, header.seconds = p.seconds;
    header.p99 = p.standard_error.p99, header.rms = p.standard_error.rms;
    header.within_half_fraction = p.standard_error.within_half_fraction;
    header.lit_px = p.standard_error.lit_px;
    header.crc = crc_of(header, p.mean, p.dark);

    std::error_code ignored;
    std::filesystem::create_directories(file.parent_path(), ignored);
    const std::filesystem::path beside = file.string() + "." + std::to_string(::getpid());
    std::ofstream out(beside, std::ios::binary);
    const auto write = [&out](std::span<const std::uint8_t> bytes) {
        out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    };
    write(bytes_of(&header, sizeof header));
    write(bytes_of(p.mean));
    write(bytes_of(p.dark));
    if (out.flush())
        std::filesystem::rename(beside, file, ignored);
    else
        std::filesystem::remove(beside, ignored);
}

}  // namespace hilcam
