#pragma once
// Stands before a ZeroMQ socket that listens: passes connections on to it, byte by byte, but ends those whose
// messages are too large. ZeroMQ itself bounds a message's single parts (ZMQ_MAXMSGSIZE) and the number of
// whole messages that wait (ZMQ_RCVHWM), but neither the parts of one message nor connections: a peer that
// goes on with one more part takes all memory there is.
//
// A connection that has brought no whole message is a stranger's. Strangers take no peer's place: there may be
// kMaxStrangers of them besides, and for one more the oldest is ended.
//
// Basilisk leaves the connection of each of its runs open until its process ends, so that most peers are
// silent for good: there may be many, and for one more the one whose last message is the oldest is ended. (It
// comes back by itself, as a stranger, and stays that.) What bounds memory is the sum of what all have sent
// and have no answer to yet; above it, the connection with the most is ended.
//
// Connections come in by TCP and go on to an abstract Unix socket of this process. A thread of its own passes
// on; for each connection it holds 2 x 64 KiB.

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
    std::string inner;    // the abstract Unix socket's name, without ZeroMQ's "@"
    std::size_t max_peers = 8;
    ZmtpMeter::Limits limits{};                     // bound one message
    std::uint64_t max_held_bytes{};                 // bounds all messages together that have no answer yet
    std::function<void(const std::string&)> ended;  // told, in its thread, why a connection was ended
};

class ZmqFrontend {
  public:
    static constexpr std::size_t kMaxStrangers = 16;

    explicit ZmqFrontend(ZmqFrontendSetup setup) : setup_(std::move(setup)) {}
    ~ZmqFrontend() { stop(); }

    // Throws InputError, DeviceError. Owner thread, as is stop().
    void start();
    void stop() noexcept;

  private:
    // Bytes on their way from one socket to another.
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
        std::uint64_t settled_bytes = 0;  // asked bytes that have their answer
        std::uint64_t last_message = 0;   // its place among all peers' messages, from 1; 0: it sent none
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
