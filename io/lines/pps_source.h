#pragma once
// A pulse per second as a line's edges, by the kernel's PPS device (linux/pps.h, after RFC 2783): the
// receiver of a navigation system, or a pin with the driver pps-gpio.
//
// The assert edge is the line's rising one, with the kernel's time. The clear edge is the falling one where
// the device captures it; otherwise the pulse is taken to last kPulse_ns.

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

#include "io/system/fd.h"

namespace hilcam {

// Returns why the device cannot be used; empty: it can.
std::string fault_of_pps(const std::string& device);

class PpsSource {
  public:
    static constexpr std::int64_t kPulse_ns = 10'000'000;
    struct Edge {
        bool level = false;
        std::int64_t monotonic_ns = 0;
        std::uint32_t sequence = 0;  // the kernel's number of the pulse
    };
    // Opens the device. Throws DeviceError that says what is missing.
    explicit PpsSource(std::string device);
    ~PpsSource() { stop(); }

    // Calls tell(edge) on a thread of its own until stop().
    void start(std::function<void(const Edge&)> tell);
    void stop() noexcept;

  private:
    void run();

    std::string device_;
    Fd fd_;
    bool has_clear_ = false;
    std::function<void(const Edge&)> tell_;
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace hilcam
