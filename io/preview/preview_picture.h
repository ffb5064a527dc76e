#pragma once
// A part of a frame as the preview's page reads it: a header of kPictureHeaderBytes, then rows of 16-bit
// samples; everything little-endian. docs/preview.md has the header's layout.

#include <cstdint>
#include <span>
#include <string>

#include "io/contract/frame_sink.h"
#include "io/preview/preview_request.h"

namespace hilcam {

inline constexpr std::size_t kPictureHeaderBytes = 208;
// The most samples of one answer: larger parts are reduced further.
inline constexpr std::int64_t kMaxPictureSamples = 1 << 21;

struct PictureSource {
    std::span<const std::uint16_t> samples;  // width x height
    int width = 0, height = 0;
    const FrameRecord& record;
};

// The request cut to the frame, its step raised until the answer is small enough; never empty. Corners are
// multiples of the step.
PictureRequest fit_to_frame(PictureRequest request, int width, int height);
// A sample is the mean of its block, rounded to nearest; of what is there of it at the frame's edge.
std::string encode_picture(const PictureSource& source, const PictureRequest& fitted,
                           const std::string& color_pattern);

}  // namespace hilcam
