#pragma once
// A TCP server that sends the same lines of text to all its clients and ignores what they send. One thread
// serves them without waiting for any: a client with more than kMaxWaiting_bytes pending is disconnected and
// counted.

#include <atomic>
#include <cstdint>
#include <list>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "io/system/allow_list.h"
#include "io/system/fd.h"
#include "io/system/output_queue.h"

namespace hilcam {

struct LineServerSetup {
    std::string address = "127.0.0.1";
    std::uint16_t port = 0;
    std::vector<std::string> allow;
    std::size_t max_clients = 8;
    std::string key;  // the configuration's key, for messages
};

class LineServer {
  public:
    static constexpr std::size_t kMaxWaiting_bytes = 8 << 20;

    // Throws InputError.
    explicit LineServer(const LineServerSetup& setup);
    ~LineServer() { stop(); }

    // Opens the port. Throws DeviceError when it is taken. Owner thread, as stop().
    void start();
    void stop() noexcept;
    // Sends a line to every client; `line` ends with a newline. Any thread but the loop.
    void notify(std::string_view line);

    // Any thread.
    std::size_t clients() const { return connected_.load(std::memory_order_relaxed); }
    std::uint64_t cut_off() const { return cut_off_.load(std::memory_order_relaxed); }

  private:
    struct Client {
        Fd socket;
        OutputQueue output{kMaxWaiting_bytes};
        bool gone = false;
    };
    void run();
    void serve(Client& client, short events);
    void accept_client();
    void drop_gone();

    LineServerSetup setup_;
    AllowList allow_;
    std::uint32_t address_;
    Fd listener_, wakeup_ = open_wakeup();
    std::mutex mutex_;  // guards the clients
    std::list<Client> clients_;
    std::atomic<std::size_t> connected_{0};
    std::atomic<std::uint64_t> cut_off_{0};
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace hilcam
