#pragma once
// Files that keep on disk what takes long to make: numbers and lists of them as they lie in memory, for this
// machine alone, and at their end how many bytes there are and their checksum (CRC-32). Whoever reads one
// checks that it is what he wrote; a file that is not is made anew (cache.h).

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <type_traits>
#include <vector>

#include "render/vocabulary/mesh.h"

namespace hilcam {

class CacheWriter {
  public:
    // fd: of a new file, which outlives this.
    explicit CacheWriter(int fd) : fd_(fd) {}
    template <class T>
    void operator()(const T& v) {
        static_assert(std::is_trivially_copyable_v<T>);
        put(&v, sizeof v);
    }
    template <class T>
    void operator()(const std::vector<T>& values) {
        (*this)(static_cast<std::uint64_t>(values.size()));
        list(values.data(), values.size());
    }
    // Writes values without their number.
    template <class T>
    void list(const T* values, std::size_t count) {
        static_assert(std::is_trivially_copyable_v<T>);
        put(values, count * sizeof(T));
    }
    // Writes the end and brings all to the disk; false when something could not be written.
    bool finish();
    int error() const { return error_; }            // errno of what could not be written; 0: all could
    std::uint64_t bytes() const { return bytes_; }  // so far

  private:
    int fd_;
    std::vector<std::uint8_t> waiting_;
    std::uint64_t bytes_ = 0;
    std::uint32_t crc_ = 0;
    int error_ = 0;

    void put(const void* data, std::size_t size);
    void write_out(const void* data, std::size_t size);
    void flush();
};

// Reads values; after the first that is not there whole, nothing is read any more.
class CacheReader {
  public:
    explicit CacheReader(const std::filesystem::path& file);
    template <class T>
    void operator()(T& v) {
        list(&v, 1);
    }
    template <class T>
    void operator()(std::vector<T>& values) {
        std::uint64_t size = 0;
        (*this)(size);
        // No more is allocated than the file can hold.
        if (size > left_ / sizeof(T)) {
            left_ = 0, good_ = false;
            return;
        }
        values.resize(size);
        list(values.data(), values.size());
    }
    template <class T>
    void list(T* values, std::size_t count) {
        static_assert(std::is_trivially_copyable_v<T>);
        take(values, count * sizeof(T));
    }
    // There is a regular file that can be read.
    bool is_there() const { return file_ != nullptr; }
    bool good() const { return good_; }
    std::uint64_t left() const { return left_; }  // bytes that are not read yet
    // All was read, and the checksum is that of what was read.
    bool holds();
    // Says that the file was used now.
    void mark_used();

  private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    std::unique_ptr<std::FILE, Close> file_;
    std::uint64_t left_ = 0;  // bytes before the end
    std::uint64_t bytes_ = 0;
    std::uint32_t crc_ = 0;
    bool good_ = false;

    void take(void* data, std::size_t size);
};

// FNV-1a (fnv.h) over words, of all that a mesh is made of but its looks.
std::uint64_t hash_of(const Mesh& mesh);
// Goes on from a hash.
std::uint64_t hash_of(std::uint64_t hash, const void* data, std::size_t size);

}  // namespace hilcam
