#include "io/cache/cache.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>

#include "io/cache/cache_room.h"
#include "io/cache/glb_seal.h"
#include "io/system/text_number.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

constexpr std::uint64_t kMegabyte = 1'000'000;

// A new file in the same folder, under an unpredictable name. It is removed unless it takes the final file's
// place.
class FileBeside {
  public:
    // Throws DeviceError.
    FileBeside(const std::filesystem::path& file, const std::string& ending)
        : place_(file), name_(file.string() + kUnfinished + "XXXXXX" + ending) {
        fd_ = Fd(mkostemps(name_.data(), static_cast<int>(ending.size()), O_CLOEXEC));
        if (!fd_) throw DeviceError(file.string() + " cannot be written: " + std::strerror(errno));
        // Others may read it if the folder lets them.
        fchmod(fd_.get(), 0644);
    }
    ~FileBeside() {
        if (!name_.empty()) unlink(name_.c_str());
    }
    FileBeside(const FileBeside&) = delete;
    FileBeside& operator=(const FileBeside&) = delete;

    int fd() const { return fd_.get(); }
    const std::string& path() const { return name_; }
    void take_place() {
        if (std::rename(name_.c_str(), place_.c_str()) != 0)
            throw DeviceError(place_.string() + " cannot be written: " + std::strerror(errno));
        name_.clear();
    }

  private:
    std::filesystem::path place_;
    std::string name_;
    Fd fd_;
};

std::filesystem::path made_own_folder() {
    std::string name = (std::filesystem::temp_directory_path() / "hilcam-XXXXXX").string();
    if (!mkdtemp(name.data())) throw DeviceError(name + " cannot be made: " + std::strerror(errno));
    return name;
}

// Returns false when the file was removed after it was opened.
bool is_in_place(int fd, const std::filesystem::path& file) {
    struct stat opened {
    }, there{};
    return fstat(fd, &opened) == 0 && stat(file.c_str(), &there) == 0 && opened.st_dev == there.st_dev &&
           opened.st_ino == there.st_ino;
}

}  // namespace

std::filesystem::path cache_folder() {
    if (const char* own = std::getenv("HILCAM_CACHE"); own && *own) return own;
    if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && *xdg)
        return std::filesystem::path(xdg) / "hilcam";
    if (const char* home = std::getenv("HOME"); home && *home)
        return std::filesystem::path(home) / ".cache" / "hilcam";
    return {};
}

std::uint64_t cache_bound_bytes() {
    const char* const text = std::getenv("HILCAM_CACHE_MB");
    if (!text || !*text) return CacheSettings{}.bound_bytes;
    const auto megabytes = parsed_as<std::uint64_t>(text);
    constexpr std::uint64_t kMax = 1'000'000'000;
    if (!megabytes || *megabytes > kMax)
        throw InputError("HILCAM_CACHE_MB: found " + in_quotes(text) +
                         "; accepted: a whole number of megabytes, 0 to " + std::to_string(kMax));
    return *megabytes * kMegabyte;
}

std::string mistrust_of(const std::filesystem::path& folder) {
    struct stat about {};
    if (folder.empty() || stat(folder.c_str(), &about) != 0) return {};
    const std::string name = "cache folder " + harmless(folder.string());
    const std::string else_where = ", or another folder in HILCAM_CACHE";
    if (!S_ISDIR(about.st_mode)) return name + ": is no folder; accepted: a folder" + else_where;
    if (about.st_uid != geteuid() && about.st_uid != 0)
        return name + ": belongs to user " + std::to_string(about.st_uid) + "; accepted: one of user " +
               std::to_string(geteuid()) + " (this one)" + else_where;
    const bool group_writes = (about.st_mode & S_IWGRP) != 0 && about.st_gid != getegid();
    if ((about.st_mode & S_IWOTH) != 0 || group_writes)
        return name + ": others may write there; accepted: one that they may not write (chmod go-w)" +
               else_where;
    return {};
}

HeldFile::HeldFile(HeldFile&& other) noexcept
    : file_(std::move(other.file_)),
      lock_(std::move(other.lock_)),
      own_folder_(std::exchange(other.own_folder_, {})) {}

HeldFile::~HeldFile() {
    std::error_code ignored;
    if (!own_folder_.empty()) std::filesystem::remove_all(own_folder_, ignored);
}

void Cache::require_trust() const {
    if (const std::string why = mistrust_of(settings_.folder); !why.empty()) throw InputError(why);
}

// Only the last folder belongs to the cache.
void Cache::make_folder() const {
    std::error_code error;
    std::filesystem::create_directories(settings_.folder.parent_path(), error);
    if (mkdir(settings_.folder.c_str(), 0700) != 0 && errno != EEXIST)
        throw DeviceError("cache folder " + settings_.folder.string() +
                          " cannot be made: " + std::strerror(errno));
    require_trust();
}

bool Cache::read(const std::string& name, const std::function<bool(CacheReader&)>& take) const {
    if (settings_.folder.empty()) return false;
    require_trust();
    const std::filesystem::path file = settings_.folder / name;
    CacheReader in(file);
    if (!in.is_there()) return false;
    if (take(in) && in.holds()) {
        in.mark_used();
        return true;
    }
    say(file.string() + " is damaged, or of another version: it is made anew");
    return false;
}

void Cache::write(const std::string& name, const std::function<void(CacheWriter&)>& give) const {
    if (!writes()) return;
    const std::filesystem::path file = settings_.folder / name;
    try {
        make_folder();
        FileBeside beside(file, "");
        CacheWriter out(beside.fd());
        give(out);
        if (!out.finish())
            throw DeviceError(file.string() + " cannot be written: " + std::strerror(out.error()));
        if (out.bytes() > settings_.bound_bytes)
            return say(file.string() + " is not kept: it is larger than all that the cache may hold");
        beside.take_place();
        make_room(settings_.folder, settings_.bound_bytes, name);
    } catch (const std::exception& problem) {
        say(std::string(problem.what()) + "; what was made is not kept");
    }
}

HeldFile Cache::glb(const std::string& name,
                    const std::function<void(const std::filesystem::path&)>& make) const {
    const std::filesystem::path file = settings_.folder / name;
    if (!settings_.folder.empty()) {
        require_trust();
        // Locked before it is checked, so that the file checked is the file used.
        Fd there(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
        if (there) {
            flock(there.get(), LOCK_SH);
            if (!is_in_place(there.get(), file)) there.reset();
        }
        if (there) {
            if (is_sealed_glb(there.get())) {
                futimens(there.get(), nullptr);
                return {file, std::move(there), {}};
            }
            say(file.string() + " is damaged, or of another version: it is made anew");
        }
    }
    std::optional<FileBeside> beside;
    try {
        if (writes()) make_folder(), beside.emplace(file, ".glb");
    } catch (const DeviceError& problem) {
        say(std::string(problem.what()) + "; what is made is not kept");
    }
    if (!beside) {
        const std::filesystem::path own = made_own_folder();
        HeldFile out(own / name, {}, own);
        make(out.path());
        return out;
    }
    make(beside->path());
    seal_glb(beside->path());
    Fd held(open(beside->path().c_str(), O_RDONLY | O_CLOEXEC));
    if (!held) throw DeviceError(file.string() + " cannot be read: " + std::strerror(errno));
    flock(held.get(), LOCK_SH);
    beside->take_place();
    make_room(settings_.folder, settings_.bound_bytes, name);
    return {file, std::move(held), {}};
}

}  // namespace hilcam
