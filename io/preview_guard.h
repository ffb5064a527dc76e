#pragma once
// Ends connections of a TCP port of this process that last too long or send too much: the HTTP library bounds
// neither the number of a request's headers nor the time that a client may take to send them, byte by byte.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

namespace hilcam {

class ConnectionGuard {
  public:
    struct Limits {
        std::chrono::milliseconds age;
        std::uint64_t received_bytes;
    };
    ~ConnectionGuard() { stop(); }

    // `port` as bound. Looks every 50 ms.
    void start(std::uint16_t port, const Limits& limits);
    // Ends all that are left, and goes on ending new ones until stop().
    void end_all();
    void stop() noexcept;

  private:
    void run();

    std::uint16_t port_ = 0;
    Limits limits_{};
    std::mutex mutex_;
    std::condition_variable changed_;
    bool stopping_ = false, ending_ = false;
    std::thread thread_;
};

}  // namespace hilcam
