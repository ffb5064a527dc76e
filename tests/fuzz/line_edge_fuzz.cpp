// Any bytes are an edge of a line, which is written as the same bytes, or none.

#include <algorithm>

#include "io/lines/edge_codec.h"
#include "io/lines/line_edge.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    const std::span<const std::uint8_t> bytes(data, size);
    const auto edge = decode_edge(bytes);
    if (!edge) return 0;
    HILCAM_CHECK(edge->line < kLines && size == kEdgeBytes);
    const auto again = encode_edge(*edge);
    HILCAM_CHECK(std::equal(bytes.begin(), bytes.end(), again.begin(), again.end()));
    return 0;
}
