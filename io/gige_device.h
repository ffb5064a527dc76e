#pragma once
// The behaviour of a GigE Vision camera as seen through its control port: registers with their effects, one
// controller, a heartbeat. Bytes in, bytes out; no sockets, no threads, the time is given: all of it can be
// tested at a desk.
//
// Access: the first application to write a non-zero control channel privilege (CCP) becomes the controller
// until it writes 0 or stays silent longer than the heartbeat time-out. Others may read (unless the privilege
// is exclusive) and get ACCESS_DENIED for writes. A repeated request (same application, same id) gets the
// same answer and is not run twice. One thread: the one that serves the control port.

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "io/camera_control.h"
#include "io/fault.h"
#include "io/frame_sink.h"
#include "io/gige_features.h"
#include "io/gige_stream.h"
#include "io/gvcp.h"

namespace hilcam {

struct GigeIdentity {
    std::string model, serial, user_name;
    std::uint32_t ip = 0, mask = 0, gateway = 0;
    std::uint64_t mac = 0;
    std::uint32_t packet_bytes = 1500;
};

// What the stream side counts; shown as features.
struct GigeStreamStatistics {
    std::uint64_t frames = 0;           // delivered
    std::uint64_t frames_dropped = 0;   // not sent: too slow, or a fault
    std::uint64_t packets = 0;          // sent for the first time
    std::uint64_t packets_dropped = 0;  // by faults
    std::uint64_t resend_requests = 0;
    std::uint64_t packets_resent = 0;
    std::uint64_t packets_refused = 0;  // asked for again and not to be had
    std::uint64_t events_dropped = 0;   // camera events that found their ring full
};

class GigeDevice {
  public:
    // What control messages set in motion. Called from inside handle(), tick() and happened(), by their
    // thread. Any of them may be empty.
    struct Effects {
        std::function<void(const GigeStreamState&)> stream_changed{};
        // Packets asked for again, by the stream's destination or (with SCCFG's resend destination) whoever
        // is to get them. To be answered on the stream's socket; to the requester only when
        // GigeStreamState::resend_to_requester, else to the stream's destination.
        std::function<void(const gvcp::ResendRequest&, Endpoint requester)> resend{};
        // Send one datagram of this many payload bytes to the stream's destination.
        std::function<void(const GigeStreamState&, std::size_t)> test_packet{};
        // Send a datagram from the message channel's socket (its port is given with set_ports()).
        std::function<void(std::span<const std::uint8_t>, Endpoint)> send_message{};
        // Send an answer that handle() did not give at once, from the control socket: a PENDING_ACK, an
        // answer that was held back, or one for 255.255.255.255 (the socket needs SO_BROADCAST).
        std::function<void(std::span<const std::uint8_t>, Endpoint)> send_answer{};
        // The device has restarted: streams are closed, frames kept for resends are forgotten, block ids
        // begin anew. stream_changed has been called.
        std::function<void()> reset{};
        // The camera is to live on another address. False: this machine has no such address, or its port is
        // taken; nothing has changed then. True: sockets listen there from now on.
        std::function<bool(std::uint32_t ip, std::uint32_t mask, std::uint32_t gateway)> change_address{};
    };

    GigeDevice(const GigeIdentity& identity, CameraControl& camera, FaultBoard& faults, Effects effects);

    // Ports the kernel gave the stream's and the message channel's sockets; before the first handle().
    void set_ports(std::uint16_t stream, std::uint16_t message);

    // Answers one datagram; gives the number of bytes written to `out` (at least kMostDatagramBytes), 0: no
    // answer now. `now_ns`: CLOCK_MONOTONIC. `broadcast`: it came to a broadcast address; then only
    // DISCOVERY, FORCEIP and ACTION count, and a discovery is answered only when `from` is in the camera's
    // own subnet (the client would talk to an address that the stream does not come from) or allows a
    // broadcast answer.
    std::size_t handle(std::span<const std::uint8_t> datagram, Endpoint from, std::int64_t now_ns,
                       std::span<std::uint8_t> out, bool broadcast = false);
    // To be called at wake_ns() or earlier, and after each handle(): ends the control of an application that
    // fell silent, sends answers that were held back, runs scheduled actions, repeats unanswered events.
    void tick(std::int64_t now_ns);
    // When tick() is wanted next (CLOCK_MONOTONIC); never more than kLongestSleep_ns after the last tick.
    std::int64_t wake_ns() const;
    static constexpr std::int64_t kLongestSleep_ns = 50'000'000;

    // The stream side has delivered the last frame of a counted acquisition.
    void acquisition_finished(std::uint32_t epoch);
    // From the loop, by way of the control thread: becomes an EVENT if a client wants it. An event's frame
    // is FrameRecord::id; `block` is the stream's block id of that frame, 0 when it has none.
    void happened(const CameraEvent& event, std::uint64_t block, std::int64_t now_ns);
    void set_statistics(const GigeStreamStatistics& statistics) { statistics_ = statistics; }

    bool controlled() const { return controller_.port != 0; }
    const GigeStreamState& stream_state() const { return stream_; }
    std::string xml() const { return {xml_.begin(), xml_.end()}; }

  private:
    struct Answer {
        gvcp::Status status = gvcp::kSuccess;
        std::size_t bytes = 0;
    };
    Answer answer(const gvcp::Header& header, std::span<const std::uint8_t> payload, Endpoint from,
                  std::int64_t now_ns, std::span<std::uint8_t> out);
    Answer read_registers(std::span<const std::uint8_t> payload, std::span<std::uint8_t> out);
    Answer write_registers(std::span<const std::uint8_t> payload, Endpoint from, std::int64_t now_ns,
                           std::span<std::uint8_t> out);
    Answer read_memory(std::span<const std::uint8_t> payload, std::span<std::uint8_t> out);
    Answer write_memory(std::span<const std::uint8_t> payload, Endpoint from, std::int64_t now_ns,
                        std::span<std::uint8_t> out);

    bool may_write(Endpoint from, std::uint32_t address) const;
    gvcp::Status write(std::uint32_t address, std::span<const std::uint8_t> data, Endpoint from,
                       std::int64_t now_ns);
    gvcp::Status write_number(std::uint32_t address, std::uint32_t value, Endpoint from, std::int64_t now_ns);
    gvcp::Status write_float(std::uint32_t address, double value);
    gvcp::Status write_feature(const Feature& feature, std::uint32_t value);
    gvcp::Status write_privilege(std::uint32_t value, Endpoint from);
    gvcp::Status write_packet_size(std::uint32_t value);
    gvcp::Status write_geometry(std::uint32_t address, std::uint32_t value);
    void start_acquisition();
    void stop_acquisition();
    void release_control();
    void refresh_live_registers();
    void publish_stream();

    std::uint32_t get(std::uint32_t address) const;
    void put(std::uint32_t address, std::uint32_t value);
    void put_u64(std::uint32_t address, std::uint64_t value);
    void put_text(std::uint32_t address, std::size_t size, const std::string& text);

    CameraControl& camera_;
    FaultBoard& faults_;
    GigeStreamStatistics statistics_;
    std::int64_t ticked_ns_ = 0;
    Effects effects_;
    std::vector<Feature> features_;
    std::vector<std::uint8_t> memory_;
    std::vector<std::uint8_t> xml_;  // padded to 4 bytes
    Endpoint controller_;
    std::int64_t last_heard_ns_ = 0;
    GigeStreamState stream_;

    struct LastWrite {
        Endpoint from;
        std::uint16_t request_id = 0;
        std::uint16_t command = 0;
        std::size_t bytes = 0;
        std::array<std::uint8_t, gvcp::kMostDatagramBytes> answer{};
    } last_write_;
};

}  // namespace hilcam
