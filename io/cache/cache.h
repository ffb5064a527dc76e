#pragma once
// The cache folder: what takes long to make is kept there from run to run, and what is needed again is taken
// from there. Several programs may use one folder at the same time.
//
// A file takes its place whole or not at all, and its last bytes are a checksum (cache_file.h, glb_seal.h): what
// was cut, or has lost or changed a bit, is made anew, and the log says so. A checksum tells damage, not
// intent. So a folder that others may write is refused: whoever writes there decides what frames look like.
// The folder has a bound; what was used longest ago goes first (cache_room.h).

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "io/cache/cache_file.h"
#include "io/system/fd.h"

namespace hilcam {

// Returns the folder of $HILCAM_CACHE, else $XDG_CACHE_HOME/hilcam, else ~/.cache/hilcam; empty when there is
// neither: a folder that everybody could have made first is no cache.
std::filesystem::path cache_folder();
// Returns the bound of $HILCAM_CACHE_MB, else 4096 MB [bytes]. Throws InputError when that is no number.
std::uint64_t cache_bound_bytes();
// Returns why a folder cannot be trusted, and what helps; empty when it can, or is not there. Trusted are a folder
// of one's own or root's that no other user may write; members of one's own group may.
std::string mistrust_of(const std::filesystem::path& folder);

struct CacheSettings {
    std::filesystem::path folder;               // empty: nothing is kept, and nothing found
    std::uint64_t bound_bytes = 4'096'000'000;  // 0: what is there is found, nothing is written
    bool writes = true;
    std::function<void(const std::string&)> log;
};

// A file that is there for as long as the object lives: nobody who makes room removes it.
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
    std::filesystem::path own_folder_;  // goes with the object; empty: the file is the cache's
};

class Cache {
  public:
    // Keeps nothing and finds nothing.
    Cache() = default;
    explicit Cache(CacheSettings settings) : settings_(std::move(settings)) {}
    explicit Cache(std::filesystem::path folder) { settings_.folder = std::move(folder); }

    const std::filesystem::path& folder() const { return settings_.folder; }
    bool writes() const { return settings_.writes && !settings_.folder.empty() && settings_.bound_bytes > 0; }

    // True when the file of that name was there, `take` took it and its checksum holds; else what `take` has
    // filled is worth nothing. Throws InputError for a folder that cannot be trusted.
    bool read(const std::string& name, const std::function<bool(CacheReader&)>& take) const;
    // Writes the file. One that cannot be written, or is larger than all that may be kept, is no failure: the log
    // says so.
    void write(const std::string& name, const std::function<void(CacheWriter&)>& give) const;
    // Returns the file of that name, which is a binary glTF: the one that is there, or what `make` writes into the
    // path that it is given. Without a folder to write to, the file goes with the object. Throws InputError as
    // read(), DeviceError when no file can be made, and what `make` throws.
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
