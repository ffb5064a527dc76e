#pragma once
// The connection to 42, made again whenever it has gone: as a client that asks until 42 listens, or as a
// server that waits for 42.

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "io/system/allow_list.h"
#include "io/system/fd.h"

namespace hilcam {

class Ip42Peer {
  public:
    struct Setup {
        bool serves = false;
        std::string address;
        std::uint16_t port = 0;
        std::vector<std::string> allow;  // peers that a server admits
    };
    // Throws InputError.
    explicit Ip42Peer(Setup setup);

    // A server listens from now on. Throws DeviceError. Owner thread.
    void open();
    void close() { listener_.reset(); }
    // Returns the connected socket; an empty one after a while without success, or when `wakeup` is woken.
    // Receiver's thread, as leave().
    Fd meet(const Fd& wakeup);
    void leave() { met_ = false; }
    // Returns "127.0.0.1:10001" of the present peer. Receiver's thread.
    const std::string& name() const { return name_; }

    // Any thread.
    bool is_met() const { return met_.load(); }
    std::uint64_t strangers() const { return strangers_.load(); }
    // Says why a client is not connected; empty: it is, or it has not tried yet.
    std::string trouble() const;

  private:
    Fd call(const Fd& wakeup);
    Fd receive(const Fd& wakeup);
    Fd fail(int error);

    Setup setup_;
    std::uint32_t address_;
    AllowList allow_;
    Fd listener_;
    std::string name_;
    std::atomic<bool> met_{false};
    std::atomic<std::uint64_t> strangers_{0};
    mutable std::mutex mutex_;  // guards trouble_
    std::string trouble_;
};

}  // namespace hilcam
