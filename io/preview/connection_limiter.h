#pragma once
// Ends connections to a TCP port of this process that last too long, send too much, are slow to send a
// request, or come from an address that is not allowed. The HTTP library limits neither the number of a
// request's headers nor the time in which a client sends them, byte by byte, while a worker waits.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>

namespace hilcam {

class ConnectionLimiter {
  public:
    struct Limits {
        std::chrono::milliseconds age;
        std::uint64_t received_bytes;
        // Longest time until a request is complete. The shorter one applies while more than `crowd` are
        // connected, so that slow clients do not delay the others.
        std::chrono::milliseconds request_age, request_age_in_crowd;
        std::size_t crowd;
        std::function<bool(std::uint32_t address)> allows;  // host order
    };
    ~ConnectionLimiter() { stop(); }

    // port: as bound. Checks connections every 50 ms.
    void start(std::uint16_t port, const Limits& limits);
    // Says that this peer's request is complete. Any thread.
    void heard(const std::string& address, int port);
    // Ends all connections, and new ones until stop().
    void end_all();
    void stop() noexcept;

  private:
    using Clock = std::chrono::steady_clock;
    using Peer = std::pair<std::uint32_t, std::uint16_t>;  // address, port; host order
    void run();
    void look();

    std::uint16_t port_ = 0;
    Limits limits_{};
    std::mutex mutex_;
    std::condition_variable changed_;
    bool stopping_ = false, ending_ = false;
    std::map<Peer, Clock::time_point> first_seen_;
    std::set<Peer> heard_;
    std::thread thread_;
};

}  // namespace hilcam
