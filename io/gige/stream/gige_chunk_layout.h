#pragma once
// The chunks of another camera: which of hilcam's values go where in the chunk of which id (io/gige/face).

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "io/contract/frame_sink.h"
#include "io/gige/face/face_table.h"
#include "io/gige/stream/gige_stream.h"

namespace hilcam {

struct GigeChunkLayout {
    struct Field {
        Chunk chunk = Chunk::kFrameId;
        RegisterField place;
        RegisterFormula formula{};
        // PFNC codes and the numbers that stand for them; empty: the formula.
        std::vector<std::pair<std::uint32_t, std::uint64_t>> codes{};
    };
    struct Part {
        std::uint32_t id = 0, bytes = 0;
        std::uint32_t chunks = 0;  // it is there when one of these chunks is enabled; bits by Chunk
        std::vector<Field> fields{};
    };
    std::uint32_t image_id = 0;
    std::vector<Part> parts{};

    // Returns the bytes of enabled parts and of the image's id and length, each with 8 bytes of id and
    // length.
    std::size_t bytes(std::uint32_t enabled) const;
};

// Returns the chunks of a face. pattern: the camera's, for its pixel formats.
GigeChunkLayout chunk_layout_of(const FaceTable& table, BayerPattern pattern);

// Writes the parts behind an image of image_bytes; out: bytes(stream.chunks). Loop.
void write_chunk_layout(const GigeChunkLayout& layout, const FrameRecord& record,
                        const GigeStreamState& stream, BayerPattern seen, std::uint64_t timestamp_ns,
                        std::size_t image_bytes, std::span<std::uint8_t> out);

}  // namespace hilcam
