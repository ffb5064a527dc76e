#pragma once
// A frame as the packets of a GigE Vision stream. Pure: a packet is a function of the frame and the packet's
// id, so a packet that is sent again equals the first.
//
// The payload is the image. In chunk mode, each chunk's data are followed by its id and length, first for the
// image itself: clients walk from the end backwards. A multipart block has the image as one part; a
// confidence map as another (Confidence8: 0 where the DN is 0 or full scale, and so only a bound of the
// signal, else 255); and the chunks as the last.

#include <array>
#include <cstdint>
#include <span>

#include "io/contract/frame_sink.h"
#include "io/gige/stream/gige_stream.h"
#include "io/gige/stream/gvsp.h"

namespace hilcam {

// Everything from which a frame's packets are made. It refers to the payload and does not own it.
struct GigeFrame {
    GigeStreamState stream;  // state when the frame was taken
    BayerPattern pattern;    // the camera's colour filter array; empty: monochrome
    std::uint64_t block = 0;
    std::uint64_t timestamp_ns = 0;
    std::int32_t size_y_error = 0;  // added to the height in the trailer
    std::span<const std::uint8_t> payload;
};

// Returns the largest payload of such a camera, for any format, any chunks and, if it has them, any parts.
std::size_t max_payload_bytes(int width, int height, BayerPattern pattern, bool multipart);

// Writes the frame's window and its chunks to `out`, exactly stream.payload_bytes() bytes. scratch: at least
// 3 * stream.width + 8 numbers. The frame must contain the window. Loop.
void write_gige_payload(const DnImage& frame, const FrameRecord& record, const GigeStreamState& stream,
                        BayerPattern pattern, std::uint64_t timestamp_ns, std::span<std::uint16_t> scratch,
                        std::span<std::uint8_t> out);

// Returns the id of the last packet, the trailer.
std::uint32_t trailer_id(const GigeStreamState& stream);

struct GigePacket {
    std::array<std::uint8_t, gvsp::kMaxHeadBytes> head;
    std::size_t head_bytes = 0;
    std::span<const std::uint8_t> data;  // bytes of the frame's payload

    std::size_t bytes() const { return head_bytes + data.size(); }
};
// Returns a packet. id: 0 to trailer_id(). Any thread, no allocation.
GigePacket packet_of(const GigeFrame& frame, std::uint32_t id, gvsp::Status status);
// Returns the answer to a request that cannot be fulfilled: a header with the reason.
GigePacket refusal_of(bool extended, std::uint64_t block, std::uint32_t id, gvsp::Status reason);

}  // namespace hilcam
