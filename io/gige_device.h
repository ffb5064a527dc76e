#pragma once
// The behaviour of a GigE Vision camera as seen through its control port: registers with their effects, one
// controller, a heartbeat. Bytes in, bytes out; no sockets, no threads, the time is given: all of it can be
// tested at a desk.
//
// Access: the first application to write a non-zero control channel privilege (CCP) becomes the controller
// until it writes 0 or stays silent longer than the heartbeat time-out. Others may read (unless the privilege
// is exclusive) and get ACCESS_DENIED for writes. A repeated request (same application, same id) gets the
// same answer and is not run twice. Owner thread, except stream_state() readers as said there.

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "io/camera_control.h"
#include "io/gige_features.h"
#include "io/gvcp.h"
#include "io/gvsp.h"

namespace hilcam {

struct GigeIdentity {
    std::string model, serial, user_name;
    std::uint32_t ip = 0, mask = 0, gateway = 0;
    std::uint64_t mac = 0;
    std::uint32_t packet_bytes = 1500;
};

// An application: IPv4 address and UDP port, host order.
struct Endpoint {
    std::uint32_t ip = 0;
    std::uint16_t port = 0;
    friend bool operator==(const Endpoint&, const Endpoint&) = default;
};

// What the stream side needs to know; changes only by a control message.
struct GigeStreamState {
    bool open = false;         // a destination is set
    bool acquiring = false;    // between AcquisitionStart and Stop
    std::uint32_t epoch = 0;   // counts AcquisitionStarts
    std::uint32_t frames = 0;  // of this acquisition; 0: endless
    Endpoint destination;
    std::uint32_t packet_bytes = 0;  // IP, UDP and GVSP headers included
    bool do_not_fragment = false;
    std::uint32_t packet_delay_ns = 0;
    std::uint32_t pixel_format = 0;
    std::uint32_t width = 0, height = 0, offset_x = 0, offset_y = 0;

    std::size_t payload_bytes() const {
        return std::size_t{width} * height * gvsp::bytes_per_pixel(pixel_format);
    }
};

class GigeDevice {
  public:
    // What control messages set in motion; called from inside handle().
    struct Effects {
        std::function<void(const GigeStreamState&)> stream_changed;
        std::function<void(const gvcp::ResendRequest&)> resend;
        // Send one datagram of this many payload bytes to the stream's destination.
        std::function<void(const GigeStreamState&, std::size_t)> test_packet;
    };

    GigeDevice(const GigeIdentity& identity, CameraControl& camera, Effects effects);

    // Answers one datagram; gives the number of bytes written to `out` (at least kMostDatagramBytes), 0: no
    // answer.
    std::size_t handle(std::span<const std::uint8_t> datagram, Endpoint from, std::int64_t now_ns,
                       std::span<std::uint8_t> out);
    // To be called a few times a second: ends the control of an application that fell silent.
    void tick(std::int64_t now_ns);
    // The stream side has delivered the last frame of a counted acquisition.
    void acquisition_finished(std::uint32_t epoch);

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
