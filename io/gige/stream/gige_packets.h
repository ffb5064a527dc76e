#pragma once
// A frame as the packets of a GigE Vision stream. Pure: every packet is a function of the frame and the
// packet's id, so that what is sent again is what was sent.
//
// The payload is the image and, in chunk mode, each chunk's data followed by its id and length, first such a
// tail of all that is before: clients walk from the end backwards. A multipart block has the image as one
// part, which of its pixels can be believed as another (Confidence8: 0 where the DN is 0 or full scale, and
// so only a bound of the signal; else 255), and the chunks as the last.

#include <array>
#include <cstdint>
#include <span>

#include "io/contract/frame_sink.h"
#include "io/gige/stream/gige_stream.h"
#include "io/gige/stream/gvsp.h"

namespace hilcam {

// What the packets of a frame are made of. Refers to the payload, does not own it.
struct GigeFrame {
    GigeStreamState stream;  // as it was when the frame was taken
    BayerPattern pattern;    // of the camera's colour filter array; empty: none
    std::uint64_t block = 0;
    std::uint64_t timestamp_ns = 0;
    std::int32_t size_y_error = 0;  // added to the height in the trailer
    std::span<const std::uint8_t> payload;
};

// The largest payload of such a camera, whatever the format, the chunks and, if it has them, the parts.
std::size_t max_payload_bytes(int width, int height, BayerPattern pattern, bool multipart);

// The frame's window and its chunks: exactly stream.payload_bytes() bytes of `out`. `scratch`: at least
// 3 * stream.width + 8 numbers. The frame must contain the window. Loop.
void write_gige_payload(const DnImage& frame, const FrameRecord& record, const GigeStreamState& stream,
                        BayerPattern pattern, std::uint64_t timestamp_ns, std::span<std::uint16_t> scratch,
                        std::span<std::uint8_t> out);

// The id of the last packet, the trailer.
std::uint32_t trailer_id(const GigeStreamState& stream);

struct GigePacket {
    std::array<std::uint8_t, gvsp::kMaxHeadBytes> head;
    std::size_t head_bytes = 0;
    std::span<const std::uint8_t> data;  // of the frame's payload

    std::size_t bytes() const { return head_bytes + data.size(); }
};
// id: 0 to trailer_id(). Any thread, no allocation.
GigePacket packet_of(const GigeFrame& frame, std::uint32_t id, gvsp::Status status);
// The answer to a request that cannot be met: a header with the reason.
GigePacket refusal_of(bool extended, std::uint64_t block, std::uint32_t id, gvsp::Status reason);

}  // namespace hilcam
