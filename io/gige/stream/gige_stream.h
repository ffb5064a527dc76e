#pragma once
// The state that the control side of a GigE Vision camera sets for its stream side. Only control messages
// change it.

#include <cstddef>
#include <cstdint>

#include "io/system/wire_format.h"

namespace hilcam {

// An application: IPv4 address and UDP port, host order.
struct Endpoint {
    std::uint32_t ip = 0;
    std::uint16_t port = 0;
    friend bool operator==(const Endpoint&, const Endpoint&) = default;
};

// Chunks that may follow a frame's pixels; bits of GigeStreamState::chunks. A chunk's id is kChunkIdBase
// plus its value. Numbers are big-endian, floats IEEE 754.
enum class Chunk : std::uint8_t {
    kFrameId,          // u64
    kTimestamp,        // u64, ns
    kExposureTime,     // f64, us
    kGain,             // f64, dB
    kBlackLevel,       // f64, DN
    kOffsetX,          // u32
    kOffsetY,          // u32
    kWidth,            // u32
    kHeight,           // u32
    kPixelFormat,      // u32
    kPoseSequence,     // u32: of the newest command that the frame shows
    kPoseTime,         // i64: time tag of that command, simulated TAI ns
    kExposureMid,      // i64: middle of the exposure, simulated TAI ns
    kTriggerSequence,  // u32
    kFaults,           // u64: FrameRecord::faults
    kSequencerSet,     // u32: the sequencer's set; 0 while it is off
};
inline constexpr int kChunks = 16;
inline constexpr std::uint32_t kChunkIdBase = 0x48430001;  // "HC", from 1 on
inline constexpr std::uint32_t kImageChunkId = 0x48430000;
constexpr std::uint32_t chunk_bytes(Chunk chunk) {
    switch (chunk) {
        case Chunk::kOffsetX:
        case Chunk::kOffsetY:
        case Chunk::kWidth:
        case Chunk::kHeight:
        case Chunk::kPixelFormat:
        case Chunk::kPoseSequence:
        case Chunk::kTriggerSequence:
        case Chunk::kSequencerSet:
            return 4;
        default:
            return 8;
    }
}

// The parts of a frame in a multipart stream, with the ids of SFNC 2.7 (4.13 ComponentIDValue).
enum class GigeComponent : std::uint8_t { kIntensity, kConfidence };
constexpr std::uint32_t bit_of(GigeComponent component) { return 1u << static_cast<unsigned>(component); }
constexpr std::uint16_t id_of(GigeComponent component) {
    return component == GigeComponent::kIntensity ? 1 : 6;
}

// Another camera's chunks in place of the ones above (gige_chunk_layout.h), and their bytes for enabled
// chunks.
struct GigeChunkLayout;
std::size_t chunk_layout_bytes(const GigeChunkLayout& layout, std::uint32_t enabled);

struct GigeStreamState {
    bool open = false;               // a destination is set
    bool acquiring = false;          // between AcquisitionStart and Stop
    bool unconditional = false;      // continues without a controller (SCCFG b1)
    std::uint32_t epoch = 0;         // counts AcquisitionStarts
    std::uint32_t frames = 0;        // frames of this acquisition; 0: endless
    Endpoint destination;            // may be a multicast group
    std::uint32_t packet_bytes = 0;  // IP, UDP and GVSP headers included
    bool do_not_fragment = false;
    bool extended_ids = false;         // 64-bit block ids, 20-byte headers; on the client's request
    bool multipart = false;            // every block has parts; implies 64-bit ids
    bool resend_to_requester = false;  // SCCFG b3: else to the destination
    std::uint32_t packet_delay_ns = 0;
    double throughput_limit_bytes_s = 0;  // 0: the configuration's
    WireFormat format = WireFormat::kMono8;
    std::uint32_t width = 0, height = 0, offset_x = 0, offset_y = 0;
    std::uint32_t binning_x = 1, binning_y = 1;
    bool chunk_mode = false;
    std::uint32_t chunks = 0;                       // bits by Chunk, when chunk_mode is on
    const GigeChunkLayout* chunk_layout = nullptr;  // null: hilcam's own chunks; the device owns it
    // Components of a multipart stream, at least one.
    std::uint32_t components = bit_of(GigeComponent::kIntensity);

    // True when block ids are long; a short header has no room for the number of parts.
    bool long_ids() const { return extended_ids || multipart; }
    bool shows(GigeComponent component) const {
        return multipart ? components & bit_of(component) : component == GigeComponent::kIntensity;
    }
    std::size_t image_bytes() const {
        return shows(GigeComponent::kIntensity) ? wire_bytes(std::size_t{width} * height, format) : 0;
    }
    std::size_t confidence_bytes() const {
        return shows(GigeComponent::kConfidence) ? std::size_t{width} * height : 0;
    }
    // Includes the 8 bytes of id and length behind each chunk and behind the image.
    std::size_t chunk_data_bytes() const {
        if (!chunk_mode) return 0;
        if (chunk_layout) return chunk_layout_bytes(*chunk_layout, chunks);
        std::size_t bytes = 8;
        for (int i = 0; i < kChunks; ++i)
            if (chunks >> i & 1u) bytes += 8 + chunk_bytes(static_cast<Chunk>(i));
        return bytes;
    }
    std::size_t payload_bytes() const { return image_bytes() + confidence_bytes() + chunk_data_bytes(); }
};

}  // namespace hilcam
