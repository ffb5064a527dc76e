#pragma once
// A slave-only PTP port: IEEE 1588-2008, clause 9.2, with the delay request-response mechanism (11.3), Sync
// of one and of two steps. Bytes and times in, bytes out: no socket, no thread. Times are CLOCK_MONOTONIC ns.
//
//     Disabled -> Initializing -> Listening -> Uncalibrated -> Slave
//
// Listening: no master counts (foreign_masters.h); the clock goes on at its last rate. Uncalibrated: a master
// was chosen, and the clock is not near its time yet, or no longer. Faulty: the sockets cannot be opened.
//
// Not here: master, passive and pre-master states, peer delay, unicast, management and signalling. Messages
// of other domains, versions and types are ignored. Owner thread.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "io/ptp/device_clock.h"
#include "io/ptp/foreign_masters.h"
#include "io/ptp/path_delay.h"
#include "io/ptp/ptp_data_set.h"
#include "io/ptp/ptp_message.h"
#include "io/ptp/ptp_note.h"
#include "io/ptp/ptp_servo.h"

namespace hilcam {

class PtpPort {
  public:
    struct Config {
        ptp::PortIdentity identity;
        std::uint8_t domain = 0;
    };
    // note: gets what happens, inside the other functions; may be empty.
    PtpPort(const Config& config, DeviceClock& clock, std::function<void(const PtpNote&)> note);

    void initialize();                  // Initializing
    void listen(std::int64_t now_ns);   // the sockets are open
    void fail();                        // they are not
    void disable(std::int64_t now_ns);  // the clock keeps its time and loses its correction of the rate

    // Takes a message. arrival: its time stamp; nothing: it has none.
    void receive(std::span<const std::uint8_t> bytes, std::optional<std::int64_t> arrival_ns,
                 std::int64_t now_ns);
    // Does what is due. Returns the length of a Delay_Req that was written to `out` (kMaxMessageBytes) and is
    // to be sent now; 0: none. sent() must follow.
    std::size_t tick(std::int64_t now_ns, std::span<std::uint8_t> out);
    // The latest Delay_Req left at that time.
    void sent(std::int64_t departure_ns);
    // Returns when tick() is due; INT64_MAX: never.
    std::int64_t wake_ns() const;

    PtpDataSet data_set() const;

  private:
    struct Step {  // the half of a two-step Sync that came first
        std::uint16_t sequence = 0;
        std::int64_t correction_ns = 0, time_ns = 0, arrival_ns = 0;
        double interval_s = 1;
    };

    bool is_running() const { return state_ >= PtpState::kListening; }
    bool has_master() const { return state_ >= PtpState::kUncalibrated; }
    void set_state(PtpState state);
    void choose_master(std::int64_t now_ns);
    void take_over(const ForeignMaster& master);
    void say_scale();
    void sync(const ptp::Message& m, std::optional<std::int64_t> arrival_ns, std::int64_t now_ns);
    void follow_up(const ptp::Message& m, std::int64_t now_ns);
    void complete(const Step& sync, std::int64_t origin_ns, std::int64_t now_ns);
    void delay_response(const ptp::Message& m);
    void complete_delay();
    std::size_t request(std::int64_t now_ns, std::span<std::uint8_t> out);
    std::int64_t random_wait_ns();
    void tell(PtpNote note) {
        if (note_) note_(note);
    }

    Config config_;
    DeviceClock& clock_;
    std::function<void(const PtpNote&)> note_;
    PtpState state_ = PtpState::kDisabled;
    ForeignMasters masters_;
    ForeignMaster master_{};    // the one that is followed, when has_master()
    bool scale_known_ = false;  // a master's time has been taken over
    TimeScale scale_ = TimeScale::kDevice;
    PathDelay delay_;
    PtpServo servo_;
    std::uint32_t steps_told_ = 0;

    std::optional<Step> sync_, follow_up_;
    std::optional<std::uint16_t> done_;   // sequence of the last whole Sync
    std::optional<PtpServo::Sync> last_;  // the last whole Sync

    std::uint16_t request_sequence_ = 0;
    std::uint32_t waits_ = 0;  // random waits so far
    std::int8_t log_request_interval_ = 0;
    std::int64_t request_at_ns_ = 0;
    bool request_open_ = false;  // sent, and not both of the next two known
    std::optional<std::int64_t> departure_ns_, response_ns_;
    PtpServo::Sync request_sync_{};  // the Sync before the request
};

}  // namespace hilcam
