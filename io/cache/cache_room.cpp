#include "io/cache/cache_room.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <regex>

#include "io/cache/cache.h"
#include "io/system/fd.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

namespace fs = std::filesystem;

struct Entry {
    fs::path file;
    std::uintmax_t bytes = 0;
    fs::file_time_type used;

    bool is_unfinished() const { return file.filename().string().find(kUnfinished) != std::string::npos; }
};

// Recognises the names that caches give their files, "levels_123.bin", "hilcam-make-spacecraft_seed_1.glb",
// and their unfinished files, "levels_123.bin.part-Ab3dE6", in older versions "levels_123.bin.4711".
std::vector<Entry> entries_of(const fs::path& folder, const std::string& prefix) {
    static const std::regex own(
        R"((atmosphere|levels|reference|transfer)_\d+.*\.bin(\.\d+|\.part-\w{6})?|hilcam-[\w-]+_.*\.glb)");
    std::vector<Entry> entries;
    std::error_code error;
    for (const auto& found : fs::directory_iterator(folder, error)) {
        const std::string name = found.path().filename().string();
        if (!name.starts_with(prefix) || !std::regex_match(name, own) || found.is_symlink(error) ||
            !found.is_regular_file(error))
            continue;
        std::error_code gone;
        Entry entry{found.path(), found.file_size(gone), {}};
        if (!gone) entry.used = found.last_write_time(gone);
        if (!gone) entries.push_back(std::move(entry));
    }
    return entries;
}

// Returns false when another program holds the file (HeldFile).
bool removed(const fs::path& file) {
    const Fd fd(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
    if (fd && flock(fd.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return false;
    if (unlink(file.c_str()) != 0 && errno != ENOENT)
        throw DeviceError(file.string() + " cannot be removed: " + std::strerror(errno));
    return true;
}

}  // namespace

CacheSize cache_size(const fs::path& folder, const std::string& prefix) {
    CacheSize size;
    for (const Entry& entry : entries_of(folder, prefix)) ++size.files, size.bytes += entry.bytes;
    return size;
}

CacheSize clear_cache(const fs::path& folder) {
    if (const std::string why = mistrust_of(folder); !why.empty()) throw InputError(why);
    CacheSize gone;
    for (const Entry& entry : entries_of(folder, ""))
        if (removed(entry.file)) ++gone.files, gone.bytes += entry.bytes;
    return gone;
}

void make_room(const fs::path& folder, std::uint64_t bound_bytes, const std::string& keep) {
    using namespace std::chrono_literals;
    constexpr auto kAbandoned = 24h;  // writing a table never takes that long
    std::vector<Entry> entries = entries_of(folder, "");
    std::uintmax_t bytes = 0;
    for (const Entry& entry : entries) bytes += entry.bytes;
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.used < b.used; });
    const auto now = fs::file_time_type::clock::now();
    for (const Entry& entry : entries) {
        const bool goes = entry.is_unfinished() ? now - entry.used > kAbandoned
                                                : bytes > bound_bytes && entry.file.filename() != keep;
        if (goes && removed(entry.file)) bytes -= entry.bytes;
    }
}

}  // namespace hilcam
