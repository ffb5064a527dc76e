#pragma once
// Ends connections of a TCP port of this process that last too long, send too much, take too long to send a
// request, or come from somebody who may not: the HTTP library bounds neither the number of a request's
// headers nor the time that a client may take to send them, byte by byte, and a worker waits with each.

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
        // Greatest time until a request is there; the shorter one holds while more than `crowd` are
        // connected, so that others do not wait for those who dawdle.
        std::chrono::milliseconds request_age, request_age_in_crowd;
        std::size_t crowd;
        std::function<bool(std::uint32_t address)> allows;  // host order
    };
    ~ConnectionLimiter() { stop(); }

    // `port` as bound. Looks every 50 ms.
    void start(std::uint16_t port, const Limits& limits);
    // The request of this peer has come. Any thread.
    void heard(const std::string& address, int port);
    // Ends all that are left, and goes on ending new ones until stop().
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
