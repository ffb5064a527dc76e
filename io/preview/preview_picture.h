#pragma once
// A part of a frame in the form that the preview's page reads: a header of kPictureHeaderBytes, then rows of
// 16-bit samples, all little-endian. docs/preview.md has the header's layout.

#include <cstdint>
#include <span>
#include <string>

#include "io/contract/frame_sink.h"
#include "io/preview/preview_request.h"

namespace hilcam {

inline constexpr std::size_t kPictureHeaderBytes = 208;
// The most samples in one answer; larger parts are reduced further.
inline constexpr std::int64_t kMaxPictureSamples = 1 << 21;

struct PictureSource {
    std::span<const std::uint16_t> samples;  // width x height
    int width = 0, height = 0;
    const FrameRecord& record;
};

// Returns the request clipped to the frame, with its step raised until the answer is small enough; never
// empty. Corners are multiples of the step.
PictureRequest fit_to_frame(PictureRequest request, int width, int height);
// Encodes a part. A sample is the mean of its block, rounded to nearest; at the frame's edge, of the pixels
// that exist.
std::string encode_picture(const PictureSource& source, const PictureRequest& fitted,
                           const std::string& color_pattern);

}  // namespace hilcam
