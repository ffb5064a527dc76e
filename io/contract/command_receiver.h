#pragma once
// A transport that commands come in by and telemetry goes out by: UDP, TCP, a Unix socket, USB. The emulator
// runs a list of them.

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
    // Opens what it needs and starts a thread. Throws InputError or DeviceError. Owner thread.
    virtual void start() = 0;
    // Idempotent. Owner thread.
    virtual void stop() noexcept = 0;
    // "udp 127.0.0.1:5010". Any thread.
    virtual std::string name() const = 0;
    virtual CommandReport report() const = 0;
    virtual std::vector<SenderReport> senders() const = 0;
    // Why nothing can come at present (a device that may not be opened); empty: nothing is known to be wrong.
    virtual std::string trouble() const { return {}; }
    // Its peer has asked for the run's end. Any thread.
    virtual bool asks_to_end() const { return false; }
    // To the senders that subscribed to it; never waits for one of them. Any thread but the loop, also before
    // start() and after stop().
    virtual void notify(const Telemetry& telemetry) noexcept = 0;
};

// Telemetry on its way to a receiver's own thread. Bounded: the newest is dropped when nobody takes it.
class TelemetryQueue {
  public:
    // False when it is full. Any thread.
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
