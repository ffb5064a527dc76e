#pragma once
// A program of hilcam's own (program_files.h) that works for it in a process of its own: it takes one request at a time, answers it,
// and has a piece of memory in common with whoever asks. It ends with whoever started it, and nothing that it says is believed.

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "io/system/fd.h"

namespace hilcam {

// The descriptors at which the helper finds its socket (SOCK_SEQPACKET, a message each way for a request) and the memory.
inline constexpr int kHelperSocket = 3, kHelperMemory = 4;

// One thread at a time.
class HelperProcess {
  public:
    // The time that a request may take before the helper is ended.
    struct Limits {
        double cpu_s;
        unsigned waiting_s;  // without any processor time
    };

    // Throws DeviceError when no process can be made of the program.
    HelperProcess(const std::filesystem::path& program, std::size_t memory_bytes);
    ~HelperProcess();
    HelperProcess(const HelperProcess&) = delete;
    HelperProcess& operator=(const HelperProcess&) = delete;

    // True in the process that started the helper, which alone may ask it: a forked one starts another.
    bool is_own() const;
    // Both processes may write here at any time.
    std::span<std::uint8_t> memory() const { return {memory_, memory_bytes_}; }
    // Sends a request and waits for an answer of exactly that size. Returns why there is none, after which the helper is ended and
    // may not be asked any more; empty: there is one.
    std::string ask(std::span<const std::uint8_t> request, std::span<std::uint8_t> answer, Limits limits);

  private:
    pid_t owner_;
    pid_t process_ = -1;  // -1: ended
    Fd socket_;
    std::uint8_t* memory_ = nullptr;
    std::size_t memory_bytes_;

    std::string end(bool worked);
};

}  // namespace hilcam
