#pragma once
// Runs one of hilcam's own programs (program_files.h) as a helper process. It answers one request at a time
// and shares a piece of memory with its parent. It ends with its parent, and nothing that it says is trusted.

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "io/system/fd.h"

namespace hilcam {

// The helper's descriptors: a socket (SOCK_SEQPACKET, one message each way per request) and the shared
// memory.
inline constexpr int kHelperSocket = 3, kHelperMemory = 4;

// One thread at a time.
class HelperProcess {
  public:
    // The time after which a request ends the helper.
    struct Limits {
        double cpu_s;
        unsigned waiting_s;  // longest time without any processor time
    };

    // Throws DeviceError when the program cannot be started.
    HelperProcess(const std::filesystem::path& program, std::size_t memory_bytes);
    ~HelperProcess();
    HelperProcess(const HelperProcess&) = delete;
    HelperProcess& operator=(const HelperProcess&) = delete;

    // True in the process that started the helper. Only this one may ask it; a forked process starts its own.
    bool is_own() const;
    // Both processes may write here at any time.
    std::span<std::uint8_t> memory() const { return {memory_, memory_bytes_}; }
    // Sends a request and waits for an answer of exactly that size. Returns empty on success. Otherwise it
    // returns the reason; the helper is then ended and cannot be asked again.
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
