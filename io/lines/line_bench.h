#pragma once
// The wires of a bench: takes edges from UDP, pins and pulses per second to the cameras' inputs, and the
// edges of their outputs to UDP and pins. One thread (and one for each pulse per second) does that, and gives
// the cameras' lines their ticks; the frame loop only posts to them.
//
// An edge by UDP counts from the kernel's receive time stamp, or from the instant it names, at most
// kHorizon_ns from now. Edges of pins and pulses have the kernel's times.

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "io/lines/camera_lines.h"
#include "io/lines/edge_codec.h"
#include "io/lines/lines_config.h"
#include "io/system/allow_list.h"
#include "io/system/fd.h"

namespace hilcam {

class PpsSource;

struct LineReport {
    std::uint64_t edges_in = 0;       // by UDP, pins and pulses
    std::uint64_t edges_refused = 0;  // no edge, no such line or camera, or too far from now
    std::uint64_t strangers = 0;      // datagrams from senders that are not allowed
    std::uint64_t edges_out = 0;
    std::uint64_t edges_lost = 0;  // not sent or set: the kernel refused
    double worst_late_us = 0;      // longest time from an output's nominal edge to its wire
};

class LineBench {
  public:
    static constexpr std::int64_t kHorizon_ns = 60'000'000'000;

    // cameras: in the scenario's order; they must outlive start() to stop(). Throws InputError.
    LineBench(const LinesConfig& config, std::vector<CameraLines*> cameras);
    ~LineBench();

    // Opens sockets and pins. Throws DeviceError. Owner thread.
    void start();
    void stop() noexcept;
    LineReport report() const;

  private:
    struct InputPin {
        std::uint8_t line = 0;
        std::uint16_t camera = 0;
        Fd fd;
    };
    struct OutputPin {
        std::uint8_t line = 0;
        std::uint16_t camera = 0;
        Fd fd;
    };
    void run();
    void receive();
    void read_pin_edges(const InputPin& pin);
    void take(const LineEdge& edge, std::uint16_t camera);
    void put_out(std::uint16_t camera, const LineEdge& edge);
    std::int64_t wake_ns() const;

    LinesConfig config_;
    std::vector<CameraLines*> cameras_;
    AllowList allow_;
    std::vector<sockaddr_in> receivers_;
    Fd socket_, wakeup_ = open_wakeup();
    std::vector<InputPin> inputs_;
    std::vector<OutputPin> outputs_;
    std::vector<std::unique_ptr<PpsSource>> pulses_;
    std::uint32_t sent_ = 0;
    std::atomic<std::uint64_t> edges_in_{0}, edges_refused_{0}, strangers_{0}, edges_out_{0}, edges_lost_{0};
    std::atomic<std::int64_t> worst_late_ns_{0};
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace hilcam
