#pragma once
// A PTP slave with a thread of its own: joins ptp_port.h and ptp_sockets.h. When the sockets cannot be opened
// the port is Faulty, a note says why, and the thread tries again every few seconds.

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "io/ptp/ptp_port.h"
#include "io/ptp/ptp_sockets.h"
#include "render/vocabulary/shared_latest.h"

namespace hilcam {

class PtpSlave {
  public:
    struct Config {
        PtpTransport transport = PtpTransport::kUdp;
        std::uint8_t domain = 0;
    };
    struct Line {  // for the log
        std::string text;
        bool warning = false;
    };
    // link_is_up: false while a fault cuts the network; called on the thread.
    PtpSlave(const NetInterface& net, const Config& config, DeviceClock& clock,
             std::function<bool()> link_is_up);
    ~PtpSlave() { stop(); }

    void start();  // the thread; owner thread
    void stop() noexcept;

    // Any thread but the loop. It is off a second after the order; off and on within that changes nothing.
    // The ROS 2 driver camera_aravis2 does so at each frame while PtpStatus is Initializing or Uncalibrated,
    // and a slave that began anew each time would never be in time.
    void enable(bool enabled);
    void move(const NetInterface& net);  // the camera has another address
    PtpDataSet data_set() const { return data_set_.read(); }
    // Returns what is new for the log.
    std::vector<Line> take_lines();

  private:
    static constexpr std::int64_t kRetry_ns = 5'000'000'000, kLongestSleep_ns = 500'000'000;
    // A card's driver gives a transmit stamp within microseconds, or never.
    static constexpr std::int64_t kStampWait_ns = 20'000'000;
    static constexpr int kStampTries = 3;
    static constexpr std::int64_t kOffPatience_ns = 1'000'000'000;

    void serve();
    void follow_orders(std::int64_t now_ns);
    void open(std::int64_t now_ns);
    void take_messages();
    void send_request(std::span<const std::uint8_t> message);
    void give_up_stamp();
    void say(const std::string& text, bool warning);

    const Config config_;
    std::function<bool()> link_is_up_;
    PtpPort port_;
    std::unique_ptr<PtpSockets> sockets_;
    Fd wakeup_ = open_wakeup();
    std::thread thread_;
    std::atomic<bool> stopping_{false};
    SharedLatest<PtpDataSet> data_set_;

    std::mutex orders_;  // protects the next lines up to the blank one
    NetInterface net_;
    bool wanted_ = false, moved_ = false;
    std::int64_t off_ns_ = 0;  // when it is off, if it is not wanted
    std::vector<Line> lines_;

    bool enabled_ = false;
    std::int64_t retry_ns_ = 0;
    std::string said_;  // the last refusal, which is said once
    std::int64_t send_ns_ = 0;
    bool waits_for_stamp_ = false;
    int stamps_missing_ = 0;
};

}  // namespace hilcam
