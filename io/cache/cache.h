#pragma once
// The cache folder keeps what takes long to make from run to run. Several programs may use one folder at the
// same time.
//
// A file appears whole or not at all and ends with a checksum (cache_file.h, glb_seal.h). A file that is
// truncated or damaged is made anew, and the log says so. A checksum reveals damage, not intent: anyone who
// can write into the folder decides what frames look like, so a folder that others may write is refused. The
// folder has a bound; what was not used for longest is removed first (cache_room.h).

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "io/cache/cache_file.h"
#include "io/system/fd.h"

namespace hilcam {

// Returns the folder: $HILCAM_CACHE, else $XDG_CACHE_HOME/hilcam, else ~/.cache/hilcam. Empty when none of
// the variables is set, because a folder that anybody could have created first is no cache.
std::filesystem::path cache_folder();
// Returns the bound from $HILCAM_CACHE_MB, else 4096 MB [bytes]. Throws InputError when that is not a number.
std::uint64_t cache_bound_bytes();
// Returns why a folder cannot be trusted, and what helps; empty when it can be, or does not exist. A trusted
// folder is the user's own or root's, and no other user may write it; members of the user's own group may.
std::string mistrust_of(const std::filesystem::path& folder);

struct CacheSettings {
    std::filesystem::path folder;               // empty: nothing is kept and nothing is found
    std::uint64_t bound_bytes = 4'096'000'000;  // 0: files are found, none is written
    bool writes = true;
    std::function<void(const std::string&)> log;
};

// A file that exists as long as this object: no program that makes room removes it.
class HeldFile {
  public:
    HeldFile(std::filesystem::path file, Fd lock, std::filesystem::path own_folder)
        : file_(std::move(file)), lock_(std::move(lock)), own_folder_(std::move(own_folder)) {}
    ~HeldFile();
    HeldFile(HeldFile&& other) noexcept;
    HeldFile& operator=(HeldFile&&) = delete;

    const std::filesystem::path& path() const { return file_; }

  private:
    std::filesystem::path file_;
    Fd lock_;
    std::filesystem::path own_folder_;  // removed with this object; empty: the file is the cache's
};

class Cache {
  public:
    // A cache that keeps and finds nothing.
    Cache() = default;
    explicit Cache(CacheSettings settings) : settings_(std::move(settings)) {}
    explicit Cache(std::filesystem::path folder) { settings_.folder = std::move(folder); }

    const std::filesystem::path& folder() const { return settings_.folder; }
    bool writes() const { return settings_.writes && !settings_.folder.empty() && settings_.bound_bytes > 0; }

    // Reads a file of that name with `take`. Returns true when the file was there, `take` accepted it and the
    // checksum is right; otherwise what `take` has filled must not be used. Throws InputError for a folder
    // that cannot be trusted.
    bool read(const std::string& name, const std::function<bool(CacheReader&)>& take) const;
    // Writes the file. When it cannot be written or exceeds the bound, the log says so; that is no error.
    void write(const std::string& name, const std::function<void(CacheWriter&)>& give) const;
    // Returns the binary glTF of that name: the file in the cache, or what `make` writes to the path that it
    // is given. When nothing can be kept, the file is removed with the object. Throws InputError as read()
    // does, DeviceError when no file can be written, and what `make` throws.
    HeldFile glb(const std::string& name,
                 const std::function<void(const std::filesystem::path&)>& make) const;

  private:
    CacheSettings settings_;

    void say(const std::string& line) const {
        if (settings_.log) settings_.log(line);
    }
    void require_trust() const;
    void make_folder() const;
};

}  // namespace hilcam
