#pragma once
// Runs work on untrusted bytes in a child process with limits.
//
// Libraries that read pictures and meshes allocate what a header promises, compute for minutes, or abort. In
// a child, such a file costs a bounded amount and ends in a message. The child has limits of memory (address
// space), of processor time, and of time without any processor time. It dies with its parent, prints nothing,
// and inherits none of its parent's descriptors. As far as the kernel supports it (confinement.h), the child
// reads only what it is given, writes no file, and creates no socket or process. Its result comes back as
// bytes.

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "io/system/fd.h"

namespace hilcam {

// The child's resources at its start. The work asks for more when it learns of more (allow_more()).
struct ConfinedLimits {
    std::uint64_t memory_bytes;  // beyond what the program has when the child starts
    double cpu_s;                // processor time
    unsigned waiting_s = 30;     // longest time without any processor time
};

// Takes the results of the work, in the child.
class ConfinedOutput {
  public:
    explicit ConfinedOutput(int fd) : fd_(fd) {}
    template <class T>
    void value(const T& v) {
        static_assert(std::is_trivially_copyable_v<T>);
        write(&v, sizeof v);
    }
    template <class T>
    void list(std::span<const T> values) {
        static_assert(std::is_trivially_copyable_v<T>);
        value(static_cast<std::uint64_t>(values.size()));
        write(values.data(), values.size_bytes());
    }
    void text(const std::string& v) { list(std::span<const char>(v)); }

  private:
    int fd_;
    void write(const void* from, std::size_t size);
};

// The results, in the order in which they were written. What the child read may have corrupted it, so nothing
// is trusted: a value that is missing throws InputError.
class ConfinedResult {
  public:
    // name: stands for the file in messages.
    ConfinedResult(const Fd& file, std::string name);

    template <class T>
    T value() {
        static_assert(std::is_trivially_copyable_v<T>);
        T v{};
        std::memcpy(&v, take(1, sizeof v), sizeof v);
        return v;
    }
    template <class T>
    std::vector<T> list() {
        static_assert(std::is_trivially_copyable_v<T>);
        const auto count = value<std::uint64_t>();
        const void* const from = take(count, sizeof(T));
        std::vector<T> out(count);
        if (count > 0) std::memcpy(out.data(), from, count * sizeof(T));
        return out;
    }
    std::string text() {
        const std::vector<char> v = list<char>();
        return {v.begin(), v.end()};
    }
    [[noreturn]] void refuse() const;

  private:
    std::string name_;
    std::shared_ptr<const std::uint8_t> bytes_;  // mapped
    std::uint64_t size_ = 0, at_ = 0;

    const std::uint8_t* take(std::uint64_t count, std::uint64_t size_each);
};

// Does the work in a child, which may read below these folders, and returns what it wrote. An InputError of
// the work is thrown here with the same words. Throws an InputError that begins with `name` when the work
// exceeds a limit or the child ends in another way. Owner thread.
ConfinedResult run_confined(const std::string& name, const ConfinedLimits& limits,
                            std::span<const std::filesystem::path> readable,
                            const std::function<void(ConfinedOutput&)>& work);

// Raises the limits of the child that calls it, for a good reason: a header that promises that many texels,
// another file of that size. Memory is bounded by half of the machine's. Does nothing where there is no
// limit.
void allow_more(std::uint64_t memory_bytes, double cpu_s);

}  // namespace hilcam
