#pragma once
// The behaviour of a GigE Vision camera as seen through its control port: registers with their effects, one
// controller, a heartbeat, events, actions. Bytes in, bytes out; no sockets, no threads, the time is given:
// all of it can be tested at a desk. One thread: the one that serves the control port.
//
// A repeated request (the same bytes from the same application) gets the same answer and is not run twice.
// What is unknown or malformed gets a status that says so; what is no GVCP gets none.
//
// The parts: gige_bootstrap (identity, capabilities), gige_access (who has control), gige_clock,
// gige_transport (the stream channel), gige_image, gige_acquisition, gige_trigger, gige_messages (events),
// gige_actions, gige_user_sets, gige_fault_registers; gige_core is what they share.

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

    GigeDevice(const GigeIdentity& identity, CameraControl& camera, FaultBoard& faults, Effects effects);
    ~GigeDevice();

    // Ports the kernel gave the stream's and the message channel's sockets; before the first handle().
    void set_ports(std::uint16_t stream, std::uint16_t message);

    // Answers one datagram of the control socket, and takes the acknowledgements that come to the message
    // channel's socket. Gives the number of bytes written to `out` (at least kMaxDatagramBytes), 0: no
    // answer now. `now_ns`: CLOCK_MONOTONIC. `broadcast`: it came to a broadcast address; then only
    // DISCOVERY, FORCEIP and ACTION count, and a discovery is answered only when `from` is in the camera's
    // own subnet (the client would talk to an address that the stream does not come from) or allows a
    // broadcast answer, which goes out by send_answer.
    std::size_t handle(std::span<const std::uint8_t> datagram, Endpoint from, std::int64_t now_ns,
                       std::span<std::uint8_t> out, bool broadcast = false);
    // Is called at wake_ns() or earlier, and after each handle(): ends the control of an application that
    // fell silent, sends answers that were held back, runs scheduled actions, repeats unanswered events,
    // carries out faults that reset or move the device.
    void tick(std::int64_t now_ns);
    // Returns when tick() is wanted next (CLOCK_MONOTONIC); never more than kLongestSleep_ns after the last
    // tick.
    std::int64_t wake_ns() const;
    static constexpr std::int64_t kLongestSleep_ns = 50'000'000;

    // The stream side has delivered the last frame of a counted acquisition.
    void acquisition_finished(std::uint32_t epoch);
    // Takes an event from the loop, by way of the control thread; it becomes an EVENT if a client wants it.
    // An event's frame is FrameRecord::id; `block` is the stream's block id of that frame, 0 when it has
    // none.
    void on_event(const CameraEvent& event, std::uint64_t block, std::int64_t now_ns);
    void set_statistics(const GigeStreamStatistics& statistics);

    bool controlled() const;
    // Requests for packets that neither the controller nor the stream's receiver sent; nothing came of them.
    std::uint64_t foreign_resend_requests() const;
    const GigeStreamState& stream_state() const;
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
