#pragma once
// The behaviour of a GigE Vision camera on its control port: registers with their effects, one controller, a
// heartbeat, events, actions. Bytes in, bytes out: it has no sockets and no threads and is given the time, so
// tests need no network. One thread: the one that serves the control port.
//
// A repeated request (the same bytes from the same application) gets the same answer and is not carried out
// again. An unknown or malformed request gets a status that says so; bytes that are not GVCP get no answer.
//
// Its parts are gige_bootstrap (identity, capabilities), gige_access (control), gige_clock, gige_transport
// (the stream channel), gige_image, gige_acquisition, gige_trigger, gige_lines, gige_messages (events),
// gige_actions, gige_user_sets and gige_fault_registers. They share gige_core.

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "io/contract/frame_sink.h"
#include "io/gige/device/gige_core.h"
#include "io/gige/device/gige_features.h"
#include "io/gige/device/gvcp.h"

namespace hilcam {

class GigeDevice {
  public:
    using Effects = GigeEffects;

    // lines: the camera's lines; null: it has Line0, on which nothing happens.
    GigeDevice(const GigeIdentity& identity, CameraControl& camera, FaultBoard& faults, Effects effects,
               CameraLines* lines = nullptr);
    ~GigeDevice();

    // Sets the ports that the kernel gave to the sockets of stream and message channel; before the first
    // handle().
    void set_ports(std::uint16_t stream, std::uint16_t message);

    // Handles a datagram of the control socket, or an acknowledgement that came to the message channel's
    // socket. Returns the number of bytes written to `out` (at least kMaxDatagramBytes); 0: no answer yet.
    // now_ns: CLOCK_MONOTONIC.
    //
    // broadcast: the datagram came to a broadcast address. Then only DISCOVERY, FORCEIP and ACTION are
    // handled. A discovery is answered only when `from` is in the camera's subnet (another client would talk
    // to an address that the stream does not come from) or when it allows a broadcast answer, which goes out
    // through send_answer.
    std::size_t handle(std::span<const std::uint8_t> datagram, Endpoint from, std::int64_t now_ns,
                       std::span<std::uint8_t> out, bool broadcast = false);
    // Ends the control of a silent application, sends delayed answers, runs scheduled actions, repeats
    // unacknowledged events, and carries out faults that reset or move the device. To be called at wake_ns()
    // or earlier, and after each handle().
    void tick(std::int64_t now_ns);
    // Returns when tick() is due (CLOCK_MONOTONIC), at most kLongestSleep_ns after the last tick.
    std::int64_t wake_ns() const;
    static constexpr std::int64_t kLongestSleep_ns = 50'000'000;

    // Says that the stream side has delivered the last frame of a counted acquisition.
    void acquisition_finished(std::uint32_t epoch);
    // Takes an event of the loop, on the control thread; it becomes an EVENT when a client wants it. The
    // event's frame is FrameRecord::id. block: the frame's block id in the stream; 0: it has none.
    void on_event(const CameraEvent& event, std::uint64_t block, std::int64_t now_ns);
    void set_statistics(const GigeStreamStatistics& statistics);

    bool controlled() const;
    // Returns how many resend requests came neither from the controller nor from the stream's receiver; they
    // are ignored.
    std::uint64_t foreign_resend_requests() const;
    const GigeStreamState& stream_state() const;
    // Returns what clients could latch now.
    PtpDataSet ptp_data_set() const;
    std::string xml() const;

  private:
    struct Parts;
    struct Answer;
    std::size_t answered(const gvcp::Header& header, std::span<const std::uint8_t> datagram,
                         std::span<std::uint8_t> out, bool broadcast);
    Answer answer(const gvcp::Header& header, std::span<const std::uint8_t> payload,
                  std::span<std::uint8_t> out);
    Answer read_registers(std::span<const std::uint8_t> payload, std::span<std::uint8_t> out);
    Answer write_registers(std::span<const std::uint8_t> payload, std::span<std::uint8_t> out);
    Answer read_memory(std::span<const std::uint8_t> payload, std::span<std::uint8_t> out);
    Answer write_memory(std::span<const std::uint8_t> payload, std::span<std::uint8_t> out);
    Answer act(const gvcp::Header& header, std::span<const std::uint8_t> payload);
    Answer force_ip(std::span<const std::uint8_t> payload);
    bool may_ask_again() const;
    void resend(const gvcp::Header& header, std::span<const std::uint8_t> payload);
    void strike_device();
    void reset();

    std::unique_ptr<Parts> parts_;
};

}  // namespace hilcam
