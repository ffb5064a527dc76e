#pragma once
// Files that keep on disk what takes long to make: numbers and lists of them as they lie in memory, for this
// machine alone. Whoever reads one checks that it is what he wrote; a file that is not is made anew.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <type_traits>
#include <vector>

#include "render/vocabulary/mesh.h"

namespace hilcam {

class CacheWriter {
  public:
    explicit CacheWriter(const std::filesystem::path& file) : out_(file, std::ios::binary) {}
    template <class T>
    void operator()(const T& v) {
        static_assert(std::is_trivially_copyable_v<T>);
        out_.write(reinterpret_cast<const char*>(&v), sizeof v);
    }
    template <class T>
    void operator()(const std::vector<T>& values) {
        static_assert(std::is_trivially_copyable_v<T>);
        (*this)(static_cast<std::uint64_t>(values.size()));
        out_.write(reinterpret_cast<const char*>(values.data()),
                   static_cast<std::streamsize>(values.size() * sizeof(T)));
    }
    bool good() { return static_cast<bool>(out_.flush()); }

  private:
    std::ofstream out_;
};

// Reads values; after the first that is not there whole, nothing is read any more.
class CacheReader {
  public:
    explicit CacheReader(const std::filesystem::path& file);
    template <class T>
    void operator()(T& v) {
        static_assert(std::is_trivially_copyable_v<T>);
        if (take(sizeof v)) in_.read(reinterpret_cast<char*>(&v), sizeof v);
    }
    template <class T>
    void operator()(std::vector<T>& values) {
        static_assert(std::is_trivially_copyable_v<T>);
        std::uint64_t size = 0;
        (*this)(size);
        // No more is allocated than the file can hold.
        if (size > left_ / sizeof(T) || !take(size * sizeof(T))) {
            left_ = 0, good_ = false;
            return;
        }
        values.resize(size);
        in_.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(size * sizeof(T)));
    }
    bool good() const { return good_ && static_cast<bool>(in_); }
    bool at_end() const { return left_ == 0; }

  private:
    std::ifstream in_;
    std::uint64_t left_ = 0;  // bytes of the file
    bool good_ = false;

    bool take(std::uint64_t bytes) {
        if (bytes > left_) good_ = false;
        if (good_) left_ -= bytes;
        return good_;
    }
};

// Writes a file beside first, then renames it: two programs may do this at once. A folder that cannot be
// written is no failure.
void write_cache_file(const std::filesystem::path& file, const std::function<void(CacheWriter&)>& write);

// FNV-1a (fnv.h) over words, of all that a mesh is made of but its looks.
std::uint64_t hash_of(const Mesh& mesh);
// Goes on from a hash.
std::uint64_t hash_of(std::uint64_t hash, const void* data, std::size_t size);

}  // namespace hilcam
