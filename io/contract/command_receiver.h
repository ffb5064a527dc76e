#pragma once
// A transport that brings commands and carries telemetry: UDP, TCP, a Unix socket or USB. The emulator runs a
// list of them.

#include <array>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "io/contract/command.h"
#include "io/contract/telemetry_records.h"

namespace hilcam {

class CommandReceiver {
  public:
    virtual ~CommandReceiver() = default;
    // Opens what it needs and starts its thread. Throws InputError or DeviceError. Owner thread.
    virtual void start() = 0;
    // Ends the thread and closes everything. Idempotent. Owner thread.
    virtual void stop() noexcept = 0;
    // Returns the transport and its address, "udp 127.0.0.1:5010". Any thread.
    virtual std::string name() const = 0;
    virtual CommandReport report() const = 0;
    virtual std::vector<SenderReport> senders() const = 0;
    // Returns why no command can come at present, such as a device that cannot be opened; empty: no known
    // trouble.
    virtual std::string trouble() const { return {}; }
    // True when the peer has asked the run to end. Any thread.
    virtual bool asks_to_end() const { return false; }
    // Sends telemetry to the senders that subscribed to it, without waiting for any of them. Any thread but
    // the loop, also before start() and after stop().
    virtual void notify(const Telemetry& telemetry) noexcept = 0;
};

// A queue of telemetry to a receiver's own thread. It holds kMax items; when it is full, a new one is
// dropped.
class TelemetryQueue {
  public:
    // Returns false when the queue is full. Any thread.
    bool put(const Telemetry& telemetry) {
        const std::lock_guard lock(mutex_);
        if (count_ == kMax) return false;
        items_[(first_ + count_++) % kMax] = telemetry;
        return true;
    }
    bool take(Telemetry& telemetry) {
        const std::lock_guard lock(mutex_);
        if (count_ == 0) return false;
        telemetry = items_[first_];
        first_ = (first_ + 1) % kMax;
        --count_;
        return true;
    }

  private:
    static constexpr std::size_t kMax = 256;
    std::mutex mutex_;
    std::array<Telemetry, kMax> items_;
    std::size_t first_ = 0, count_ = 0;
};

}  // namespace hilcam
