#pragma once
// The kinds of faults that a bench can order. Each has a number and a row in one table with all that is known
// of it.

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace hilcam {

// The numbers are part of the command protocol: never reuse one.
enum class FaultKind : std::uint8_t {
    // Packets of a stream; index: packet id.
    kPacketDrop = 1,
    kPacketDuplicate = 2,
    kPacketReorder = 3,   // swapped with the next packet
    kPacketDelay = 4,     // value: ms
    kPacketCorrupt = 5,   // one byte of the payload is inverted
    kPacketWrongId = 6,   // value: added to the packet id
    kPacketTruncate = 7,  // value: bytes cut off the end
    kLeaderLost = 8,
    kTrailerLost = 9,
    kResendRefused = 10,  // answered with "packet unavailable"
    kResendDelayed = 11,  // value: ms
    kResendWrongId = 12,  // value: added to the packet id
    kBandwidthCap = 13,   // value: MB/s
    // Whole frames.
    kFrameDrop = 20,    // not sent; its block id is skipped
    kFrameRepeat = 21,  // the previous frame is sent in its place
    kWrongSizeY = 22,   // value: added to the trailer's size_y
    // Time stamps.
    kTimestampStep = 30,   // value: ms, added while it lasts
    kTimestampDrift = 31,  // value: ppm, from when it began
    kTimestampFreeze = 32,
    kBlockIdWrap = 33,  // once: the next block id is 65530
    // The control channel; index: request id.
    kControlSilence = 40,
    kControlSlow = 41,  // value: ms; preceded by PENDING_ACK if the client accepts it
    kControlBusy = 42,
    kControlDenied = 43,
    kHeartbeatIgnored = 44,  // the controller is dropped although it sends heartbeats
    // The device.
    kDeviceReset = 50,      // once: control, stream and settings return to power-up
    kLinkDown = 51,         // no control and no stream
    kIpChange = 52,         // once: value is added to the last byte of the address
    kTestPacketLimit = 53,  // value: bytes; longer test packets are not sent
    // V4L2.
    kV4l2Stall = 60,       // frames are withheld
    kV4l2Restart = 61,     // once: the device is closed and opened again
    kV4l2FormatFlip = 62,  // once: closed, and opened with the other bit depth
    // USB.
    kUsbDetach = 70,
    kUsbShortTransfer = 71,
    kUsbStall = 72,
    kUsbBadCrc = 73,  // CRC of acknowledgements and telemetry
    // The picture.
    kImageStuck = 80,  // the image of the previous frame
    kImageBlack = 81,
    kImageSaturated = 82,
    kImageBitFlips = 83,  // rate is per pixel: one bit of each pixel struck flips
    kImageTear = 84,      // rows from `value` (share of the height, 0..1) on are of the frame before
};

// All that is known of a kind. A kind without a value has an empty range.
struct FaultTraits {
    FaultKind kind;
    std::string_view name;     // in scenario files and `hilcam send fault`; GenICam has it as PacketDrop
    std::string_view meaning;  // one line, with the meaning of the value
    bool once = false;
    double least = 0, most = 0;  // range of the value

    constexpr bool has_value() const { return least < most; }
};

// A row's index is the kind's bit in FrameRecord::faults and ChunkFaults: append a new kind at the end.
inline constexpr auto kFaultTable = std::to_array<FaultTraits>({
    {FaultKind::kPacketDrop, "packet_drop", "stream packets are not sent"},
    {FaultKind::kPacketDuplicate, "packet_duplicate", "stream packets are sent twice"},
    {FaultKind::kPacketReorder, "packet_reorder", "a stream packet changes places with the next"},
    {FaultKind::kPacketDelay, "packet_delay", "stream packets come late; value: ms", false, 0, 10000},
    {FaultKind::kPacketCorrupt, "packet_corrupt", "a byte of the payload is inverted"},
    {FaultKind::kPacketWrongId, "packet_wrong_id", "value is added to the packet id", false, -1e6, 1e6},
    {FaultKind::kPacketTruncate, "packet_truncate", "value: bytes cut off the end", false, 1, 16384},
    {FaultKind::kLeaderLost, "leader_lost", "leaders are not sent"},
    {FaultKind::kTrailerLost, "trailer_lost", "trailers are not sent"},
    {FaultKind::kResendRefused, "resend_refused", "resend requests get 'packet unavailable'"},
    {FaultKind::kResendDelayed, "resend_delayed", "resent packets come late; value: ms", false, 0, 10000},
    {FaultKind::kResendWrongId, "resend_wrong_id", "value is added to a resent packet's id", false, -1e6,
     1e6},
    {FaultKind::kBandwidthCap, "bandwidth_cap", "the stream's rate; value: MB/s", false, 0.001, 1e5},
    {FaultKind::kFrameDrop, "frame_drop", "frames are not sent, their block ids are skipped"},
    {FaultKind::kFrameRepeat, "frame_repeat", "the frame before is sent again in a frame's place"},
    {FaultKind::kWrongSizeY, "wrong_size_y", "value is added to the trailer's height", false, -65535, 65535},
    {FaultKind::kTimestampStep, "timestamp_step", "value: ms added to time stamps", false, -1e9, 1e9},
    {FaultKind::kTimestampDrift, "timestamp_drift", "value: ppm that time stamps run fast", false, -1e6, 1e6},
    {FaultKind::kTimestampFreeze, "timestamp_freeze", "time stamps stand still"},
    {FaultKind::kBlockIdWrap, "block_id_wrap", "once: the next block id is 65530", true},
    {FaultKind::kControlSilence, "control_silence", "control messages get no answer"},
    {FaultKind::kControlSlow, "control_slow", "answers come late, with PENDING_ACK; value: ms", false, 0,
     60000},
    {FaultKind::kControlBusy, "control_busy", "control messages are answered BUSY"},
    {FaultKind::kControlDenied, "control_denied", "control messages are answered ACCESS_DENIED"},
    {FaultKind::kHeartbeatIgnored, "heartbeat_ignored", "the controller is lost although it speaks"},
    {FaultKind::kDeviceReset, "device_reset", "once: control, stream and settings as after power-up", true},
    {FaultKind::kLinkDown, "link_down", "neither control nor stream"},
    {FaultKind::kIpChange, "ip_change", "once: value is added to the address's last byte", true, 1, 254},
    {FaultKind::kTestPacketLimit, "test_packet_limit", "value: bytes; longer test packets are lost", false,
     64, 65535},
    {FaultKind::kV4l2Stall, "v4l2_stall", "the V4L2 device gets no frames"},
    {FaultKind::kV4l2Restart, "v4l2_restart", "once: the V4L2 device is closed and opened again", true},
    {FaultKind::kV4l2FormatFlip, "v4l2_format_flip", "once: opened again with the other bit depth", true},
    {FaultKind::kUsbDetach, "usb_detach", "the USB device leaves the bus"},
    {FaultKind::kUsbShortTransfer, "usb_short_transfer", "answers come in two transfers"},
    {FaultKind::kUsbStall, "usb_stall", "answers are withheld"},
    {FaultKind::kUsbBadCrc, "usb_bad_crc", "answers have a wrong CRC"},
    {FaultKind::kImageStuck, "image_stuck", "the picture of the frame before"},
    {FaultKind::kImageBlack, "image_black", "all pixels 0"},
    {FaultKind::kImageSaturated, "image_saturated", "all pixels full scale"},
    {FaultKind::kImageBitFlips, "image_bit_flips", "one bit of struck pixels; rate is per pixel"},
    {FaultKind::kImageTear, "image_tear", "rows below `value` of the height are of the frame before", false,
     0, 1},
});

inline constexpr auto kAllFaults = [] {
    std::array<FaultKind, kFaultTable.size()> kinds{};
    for (std::size_t i = 0; i < kinds.size(); ++i) kinds[i] = kFaultTable[i].kind;
    return kinds;
}();

// Returns the kind's row of the table; null for an unknown kind.
constexpr const FaultTraits* traits_of(FaultKind kind) {
    for (const FaultTraits& traits : kFaultTable)
        if (traits.kind == kind) return &traits;
    return nullptr;
}
// Returns the kind's name; empty for an unknown kind.
constexpr std::string_view name_of(FaultKind kind) {
    const FaultTraits* traits = traits_of(kind);
    return traits ? traits->name : std::string_view{};
}
constexpr std::string_view meaning_of(FaultKind kind) {
    const FaultTraits* traits = traits_of(kind);
    return traits ? traits->meaning : std::string_view{};
}
constexpr std::optional<FaultKind> fault_named(std::string_view name) {
    for (const FaultTraits& traits : kFaultTable)
        if (traits.name == name) return traits.kind;
    return {};
}
// Returns the kind's bit in FrameRecord::faults and ChunkFaults; 0 for an unknown kind.
constexpr std::uint64_t bit_of(FaultKind kind) {
    const FaultTraits* traits = traits_of(kind);
    return traits ? std::uint64_t{1} << (traits - kFaultTable.data()) : 0;
}

}  // namespace hilcam
