#pragma once
// Files that keep on disk what takes long to make: numbers and lists in the memory layout of this machine,
// then their size in bytes and their checksum (CRC-32). A reader checks these; a file that fails is made anew
// (cache.h).

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
    // fd: of a new file, which must stay open as long as this exists.
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
    // Writes the end and syncs the file to the disk; false when something could not be written.
    bool finish();
    int error() const { return error_; }            // errno of a failed write; 0: none failed
    std::uint64_t bytes() const { return bytes_; }  // written so far

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

// Reads values. After the first that is incomplete, nothing more is read.
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
        // Allocates no more than the file can hold.
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
    // True when the file is a regular one and can be read.
    bool is_there() const { return file_ != nullptr; }
    bool good() const { return good_; }
    std::uint64_t left() const { return left_; }  // bytes not read yet
    // True when everything was read and the checksum is right.
    bool holds();
    // Marks the file as used just now.
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

// Returns the FNV-1a hash (fnv.h), over words, of a mesh without its materials and textures.
std::uint64_t hash_of(const Mesh& mesh);
// Continues a hash.
std::uint64_t hash_of(std::uint64_t hash, const void* data, std::size_t size);

}  // namespace hilcam
