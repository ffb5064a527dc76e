#pragma once
// The replying end of ZeroMQ's request-reply pattern. The library is loaded when the first socket is made: it
// brings a dozen others into the process, which a camera without Basilisk does not need.

#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace hilcam {

// One thread at a time. A DeviceError carries the library's message.
class ReplySocket {
  public:
    // Messages above `max_bytes` end their connection. Throws InputError, which says what to install, when
    // ZeroMQ is missing.
    explicit ReplySocket(std::int64_t max_bytes);
    ~ReplySocket();

    // Listens on an address in ZeroMQ's form.
    void listen(const std::string& address);
    // From then on, accepts connections over Unix sockets from this process only.
    void admit_only(pid_t process);
    // Waits until there is a request (true), `wakeup_fd` is woken, or a signal comes (false).
    bool wait(int wakeup_fd);
    // Returns the first `most` parts of a request. The parts of a message arrive together.
    std::vector<std::string> receive(std::size_t most);
    void send(const std::vector<std::string>& parts);
    void close() noexcept;

  private:
    struct Handles;
    std::unique_ptr<Handles> handles_;
};

}  // namespace hilcam
