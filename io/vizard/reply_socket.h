#pragma once
// The answering end of ZeroMQ's request and reply. The library is looked for when the first socket is made: it brings a dozen others
// into the process, which a camera without Basilisk has no use for.

#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace hilcam {

// One thread at a time. Where the library refuses, DeviceError has its words.
class ReplySocket {
  public:
    // Messages above `max_bytes` end their connection. Throws InputError, which says what to install, where there is no ZeroMQ.
    explicit ReplySocket(std::int64_t max_bytes);
    ~ReplySocket();

    // Listens at an address of ZeroMQ's own form.
    void listen(const std::string& address);
    // From then on, of those that come by Unix sockets, only this process is let in.
    void admit_only(pid_t process);
    // Waits until there is a request (true), or something else: `wakeup` was woken, or a signal came.
    bool wait(int wakeup_fd);
    // Returns a request's parts, the first `most` of them: all of a message arrive together.
    std::vector<std::string> receive(std::size_t most);
    void send(const std::vector<std::string>& parts);
    void close() noexcept;

  private:
    struct Handles;
    std::unique_ptr<Handles> handles_;
};

}  // namespace hilcam
