#pragma once
// The state that all parts of a GigE Vision camera's control side share: the camera behind it, its registers,
// and the state of the stream side. One thread: the one that serves the control port.

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/contract/camera_control.h"
#include "io/contract/fault.h"
#include "io/gige/device/gige_register_file.h"
#include "io/gige/device/gvcp.h"
#include "io/gige/face/face_files.h"
#include "io/gige/stream/gige_stream.h"
#include "io/lines/camera_lines.h"
#include "io/lines/sequencer.h"
#include "io/ptp/device_clock.h"
#include "io/ptp/device_clock_config.h"
#include "io/ptp/ptp_data_set.h"

namespace hilcam {

struct GigeIdentity {
    std::string model, serial, user_name;
    std::uint32_t ip = 0, mask = 0, gateway = 0;
    std::uint64_t mac = 0;
    std::uint32_t packet_bytes = 1500;
    std::uint32_t link_speed_mbit_s = 0;  // 0: unknown
    bool multipart = false;  // announce multipart payloads, for clients that test the announcement
    std::vector<std::string> more_lines{};  // names of the trigger input besides Line0
    ClockSource clock_source = ClockSource::kTai;
    bool ptp_at_power_up = false;  // PtpEnable is on after power-up
    std::string vendor = "hilcam", version = "1.0";
    std::shared_ptr<const CameraFaceFiles>
        face{};  // another camera's description and registers; null: hilcam's own
};

// Counters of the stream side, shown as features.
struct GigeStreamStatistics {
    std::uint64_t frames = 0;           // delivered
    std::uint64_t frames_dropped = 0;   // not sent: too slow, or a fault
    std::uint64_t packets = 0;          // sent for the first time
    std::uint64_t packets_dropped = 0;  // by faults
    std::uint64_t resend_requests = 0;
    std::uint64_t packets_resent = 0;
    std::uint64_t packets_refused = 0;  // asked for again and not available
    std::uint64_t events_dropped = 0;   // camera events that found their ring full
};

// The kernel's clocks.
struct GigeSystemClock {
    std::int64_t tai_minus_monotonic_ns = 0;
    bool synchronised = false;      // by a PTP or NTP daemon (adjtimex: no STA_UNSYNC)
    bool tai_offset_known = false;  // CLOCK_TAI differs from UTC
    std::int64_t offset_ns = 0;     // from the daemon's master, as far as the kernel has not taken it out
};

// The effects of control messages. GigeDevice calls them on its thread, inside handle(), tick() and
// on_event(). Any may be empty.
struct GigeEffects {
    std::function<void(const GigeStreamState&)> stream_changed{};
    // Resends packets through the stream's socket: to the requester if GigeStreamState::resend_to_requester
    // is set, else to the stream's destination.
    std::function<void(const gvcp::ResendRequest&, Endpoint requester)> resend{};
    // Sends one datagram with this many payload bytes to the stream's destination.
    std::function<void(const GigeStreamState&, std::size_t)> test_packet{};
    // Sends a datagram from the message channel's socket (set_ports() gives its port).
    std::function<void(std::span<const std::uint8_t>, Endpoint)> send_message{};
    // Sends an answer that handle() did not return, from the control socket: a PENDING_ACK, a delayed answer,
    // or one to 255.255.255.255 (the socket needs SO_BROADCAST).
    std::function<void(std::span<const std::uint8_t>, Endpoint)> send_answer{};
    // The device has restarted: drop the frames kept for resends and restart the block ids. stream_changed()
    // has been called already, with the stream closed.
    std::function<void()> reset{};
    // Moves the camera to another address. False, with nothing changed: this machine has no such address, or
    // its port is taken. True: sockets listen there from now on.
    std::function<bool(std::uint32_t ip, std::uint32_t mask, std::uint32_t gateway)> change_address{};
    // Empty: the machine's own clocks (gige_clock.h).
    std::function<GigeSystemClock()> system_clock{};
    // The device's clock, which others may read and steer; null: one of its own. It outlives the device.
    DeviceClock* clock = nullptr;
    // Returns what the clock shows after a reset of the device; empty: CLOCK_MONOTONIC.
    std::function<std::int64_t()> power_up_ns{};
    // Switches the PTP slave on and off, and reads its data set; only with source ptp.
    std::function<void(bool)> enable_ptp{};
    std::function<PtpDataSet()> ptp_data_set{};
};

enum class AcquisitionMode : std::uint32_t { kContinuous, kSingleFrame, kMultiFrame };

// The settings that user sets keep besides CameraSettings.
struct GigeSettings {
    std::uint32_t width = 0, height = 0, offset_x = 0, offset_y = 0;
    WireFormat format = WireFormat::kMono8;
    AcquisitionMode mode = AcquisitionMode::kContinuous;
    std::uint32_t frame_count = 1;  // for MultiFrame
    std::uint32_t burst_count = 1;  // for FrameBurstStart
    bool burst_trigger = false;     // true: when a trigger is on, it is FrameBurstStart; false: FrameStart
    // The trigger AcquisitionStart is on: the camera waits for it, or has got it.
    bool acquisition_trigger = false;
    std::uint32_t line = 0;  // name under which the trigger input was selected; 0: Line0
    bool rate_enabled = true;
    double rate_hz = 0;  // while not enabled: the rate to return to
    bool chunk_mode = false;
    std::uint32_t chunks = 0;                                      // bits by Chunk
    std::uint32_t components = bit_of(GigeComponent::kIntensity);  // parts of multipart frames
    std::uint32_t events = 0;                                      // bits by index in kGigeEvents
    SequencerProgram sequencer;                                    // for GigeSequencer
    bool throughput_limited = false;
    std::uint64_t throughput_limit_bytes_s = 0;
};

struct GigeCore {
    GigeCore(const GigeIdentity& id, CameraControl& the_camera, CameraLines& the_lines,
             FaultBoard& the_faults, GigeEffects e)
        : identity(id),
          camera(the_camera),
          lines(the_lines),
          faults(the_faults),
          effects(std::move(e)),
          limits(the_camera.limits()),
          clock(effects.clock ? *effects.clock : own_clock) {}
    GigeCore(const GigeCore&) = delete;
    GigeCore& operator=(const GigeCore&) = delete;

    GigeIdentity identity;
    CameraControl& camera;
    CameraLines& lines;
    FaultBoard& faults;
    GigeEffects effects;
    const CameraLimits limits;
    DeviceClock own_clock;  // used where the effects give none
    DeviceClock& clock;
    GigeRegisterFile registers;
    GigeSettings settings;
    GigeStreamState stream;
    GigeStreamStatistics statistics;
    std::uint64_t events_lost = 0;  // no room, or not acknowledged
    std::uint32_t gvcp_config = 0;  // bootstrap::gvcp_config
    // Time and sender of the message being handled.
    std::int64_t now_ns = 0;
    Endpoint from;
    // A host has locked the geometry with TLParamsLocked.
    bool host_locked = false;

    // False while a fault cuts the network: nothing is received and nothing is sent.
    bool link_is_up() const { return !faults.would_strike(FaultKind::kLinkDown, 0); }
    bool locked() const { return stream.acquiring || host_locked; }
    // Returns the device's time at an instant of CLOCK_MONOTONIC.
    std::uint64_t device_ns(std::int64_t monotonic_ns) const {
        return static_cast<std::uint64_t>(clock.device_ns(monotonic_ns));
    }
    gvcp::Status change(const SettingsChange& wanted) {
        if (!camera.change(wanted)) return gvcp::kInvalidParameter;
        lines.camera_changed();
        return gvcp::kSuccess;
    }
    // Updates the stream side's state from the settings, and reports it.
    void publish_stream();
};

}  // namespace hilcam
