#pragma once
// The message channel: events to the application that opened it. Each is repeated until it is acknowledged,
// MCRC times at intervals of MCTT; with MCTT 0 no acknowledgement is requested. A short queue waits for
// acknowledgements one by one, in order; an event that finds it full is dropped and counted.
//
// Camera events are EVENTDATA: the item is followed by the frame's id and the device's time, 64 bits each.

#include <array>

#include "io/contract/frame_sink.h"
#include "io/gige/device/gige_core.h"

namespace hilcam {

struct GigeEvent {
    const char* name;  // SFNC
    std::uint16_t id;
    bool on_at_power_up;
    bool of_frame = true;  // false: no frame belongs to it
};
inline constexpr std::array<GigeEvent, 7> kGigeEvents = {{
    {"ExposureStart", gvcp::Event::kFirstOfDevice + 1, false},
    {"ExposureEnd", gvcp::Event::kFirstOfDevice + 2, false},
    {"FrameTriggerMissed", gvcp::Event::kFirstOfDevice + 3, false},
    {"PrimaryApplicationSwitch", gvcp::Event::kPrimarySwitch, true},
    {"ActionLate", gvcp::Event::kActionLate, true},
    {"Line0RisingEdge", gvcp::Event::kFirstOfDevice + 4, false, false},
    {"Line0FallingEdge", gvcp::Event::kFirstOfDevice + 5, false, false},
}};
// Returns the place of a camera's event in kGigeEvents.
constexpr std::size_t place_of(CameraEvent::Kind kind) {
    const auto i = static_cast<std::size_t>(kind);
    return kind < CameraEvent::Kind::kLine0Rises ? i : i + 2;
}
inline constexpr std::size_t kEventDataBytes = 16;

class GigeMessages {
  public:
    explicit GigeMessages(GigeCore& core);

    void set_source_port(std::uint16_t port) { source_port_ = port; }
    void on_event(const CameraEvent& event, std::uint64_t block);
    void on_event(gvcp::Event::Id id);
    void acknowledged(std::uint16_t request_id, const Endpoint& from);
    void tick();
    std::int64_t deadline_ns() const;  // time of the next repetition; INT64_MAX: none
    void close();                      // closes the channel and forgets what waits
    void reset();

  private:
    static constexpr std::size_t kMaxWaiting = 64;
    struct Message {
        std::uint16_t request_id = 0;
        std::array<std::uint8_t, 64> bytes{};
        std::size_t size = 0;
    };
    bool wanted(std::uint16_t id) const;
    bool open() const { return destination_.ip != 0 && destination_.port != 0; }
    void send(const gvcp::Event& event, std::span<const std::uint8_t> data);
    void transmit(const Message& message);
    void next();

    GigeCore& core_;
    Endpoint destination_;
    std::uint16_t source_port_ = 0;
    std::uint32_t timeout_ms_ = 0, retries_ = 0;
    std::uint32_t selector_ = 0;
    std::uint16_t next_id_ = 1;
    // Unacknowledged messages, the oldest first.
    std::array<Message, kMaxWaiting> waiting_;
    std::size_t first_ = 0, count_ = 0;
    std::uint32_t tries_left_ = 0;  // for the oldest
    std::int64_t due_ns_ = 0;
};

}  // namespace hilcam
