#pragma once
// A proxy before a listening ZeroMQ socket: it forwards connections byte by byte and ends those with messages
// that are too large. ZeroMQ itself limits the size of a message's parts (ZMQ_MAXMSGSIZE) and the number of
// whole messages that wait (ZMQ_RCVHWM), but neither the number of parts nor of connections: a peer that
// keeps adding parts would use up all memory.
//
// A connection without a whole message so far is a stranger. Strangers do not count as peers. There may be
// kMaxStrangers of them; for one more, the oldest is ended.
//
// Basilisk leaves the connection of each run open until its process ends, so most peers are silent for good.
// Many are allowed; for one more, the peer with the oldest last message is ended. (It reconnects by itself,
// as a stranger, and stays one.) The memory limit is on the sum of what all have sent and not got an answer
// to; above it, the connection with the most is ended.
//
// Connections come in over TCP and go on to an abstract Unix socket of this process. A thread forwards; each
// connection has 2 x 64 KiB of buffers.

#include <atomic>
#include <functional>
#include <list>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "io/system/fd.h"
#include "io/vizard/zmtp_meter.h"

namespace hilcam {

struct ZmqFrontendSetup {
    std::string address;  // "tcp://ADDRESS:PORT", with an address or interface of this machine, or *
    std::string inner;    // name of the abstract Unix socket, without ZeroMQ's "@"
    std::size_t max_peers = 8;
    ZmtpMeter::Limits limits{};      // limits of one message
    std::uint64_t max_held_bytes{};  // limit of all messages without an answer yet, together
    // Gets the reason why a connection was ended; called on its thread.
    std::function<void(const std::string&)> ended;
};

class ZmqFrontend {
  public:
    static constexpr std::size_t kMaxStrangers = 16;

    explicit ZmqFrontend(ZmqFrontendSetup setup) : setup_(std::move(setup)) {}
    ~ZmqFrontend() { stop(); }

    // Throws InputError and DeviceError. Owner thread, as stop().
    void start();
    void stop() noexcept;

  private:
    // Bytes on their way from one socket to the other.
    struct Way {
        std::vector<std::uint8_t> bytes = std::vector<std::uint8_t>(64 * 1024);
        std::size_t begin = 0, end = 0;
        bool empty() const { return begin == end; }
        std::span<const std::uint8_t> waiting() const { return {bytes.data() + begin, end - begin}; }
    };
    struct Connection {
        Fd outer, inner;
        Way in, out;
        ZmtpMeter asked, answered;
        std::uint64_t settled_bytes = 0;  // request bytes that have their answer
        std::uint64_t last_message = 0;   // number of its last message among all peers', from 1; 0: none yet
        bool gone = false;

        bool is_peer() const { return !gone && last_message > 0; }
        std::uint64_t held_bytes() const { return asked.announced_bytes() - settled_bytes; }
    };
    void run();
    std::size_t peers() const;
    void accept_connection();
    void make_room_for_a_stranger();
    void make_room_for_a_peer();
    void bound_memory();
    void take_from_outside(Connection& connection);
    void take_from_inside(Connection& connection);
    void serve(Connection& connection, short outer_events, short inner_events);
    void end(Connection& connection, const std::string& why);
    static bool read_into(Way& way, const Fd& from);
    static bool write_from(Way& way, const Fd& to);

    ZmqFrontendSetup setup_;
    Fd listener_, wakeup_ = open_wakeup();
    std::atomic<bool> stopping_{false};
    std::list<Connection> connections_;
    std::uint64_t messages_ = 0;
    std::thread thread_;
};

}  // namespace hilcam
