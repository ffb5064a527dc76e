#pragma once
// Stands before a ZeroMQ socket that listens: passes connections on to it, byte by byte, but ends those whose
// messages are too large. ZeroMQ itself bounds a message's single parts (ZMQ_MAXMSGSIZE) and the number of
// whole messages that wait (ZMQ_RCVHWM), but neither the parts of one message nor connections: a peer that
// goes on with one more part takes all memory there is.
//
// A peer that has not sent ZeroMQ's greeting is a stranger yet. Strangers take no peer's place: there may be kMaxStrangers
// of them besides, and for one more the one that has been silent longest is ended.
//
// Connections come in by TCP and go on to an abstract Unix socket of this process. A thread of its own passes
// on; for each connection it holds 2 x 64 KiB.

#include <atomic>
#include <functional>
#include <list>
#include <string>
#include <thread>
#include <vector>

#include "io/system/fd.h"
#include "io/vizard/zmtp_meter.h"

namespace hilcam {

struct ZmqGuardSetup {
    std::string address;  // "tcp://ADDRESS:PORT", with an address or interface of this machine, or *
    std::string inner;    // the abstract Unix socket's name, without ZeroMQ's "@"
    std::size_t max_connections = 8;  // connections of peers
    ZmtpMeter::Limits limits{};
    std::function<void(const std::string&)> ended;  // told, in its thread, why a connection was ended
};

class ZmqGuard {
  public:
    static constexpr std::size_t kMaxStrangers = 16;

    explicit ZmqGuard(ZmqGuardSetup setup) : setup_(std::move(setup)) {}
    ~ZmqGuard() { stop(); }

    // Throws InputError, DeviceError. Owner thread, as is stop().
    void start();
    void stop() noexcept;

  private:
    // Bytes on their way from one socket to another.
    struct Way {
        std::vector<std::uint8_t> bytes = std::vector<std::uint8_t>(64 * 1024);
        std::size_t begin = 0, end = 0;
        bool empty() const { return begin == end; }
    };
    struct Connection {
        Fd outer, inner;
        Way in, out;
        ZmtpMeter meter;
        bool gone = false;
    };
    void run();
    std::size_t peers() const;  // that have greeted
    void accept_connection();
    void make_room_for_a_stranger();
    void take_from_outside(Connection& connection);
    void serve(Connection& connection, short outer_events, short inner_events);
    static bool read_into(Way& way, const Fd& from);
    static bool write_from(Way& way, const Fd& to);

    ZmqGuardSetup setup_;
    Fd listener_, wakeup_ = open_wakeup();
    std::atomic<bool> stopping_{false};
    std::list<Connection> connections_;
    std::thread thread_;
};

}  // namespace hilcam
