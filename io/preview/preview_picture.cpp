#include "io/preview/preview_picture.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

static_assert(std::endian::native == std::endian::little, "samples are copied as they lie in memory");

template <class T>
void put(std::string& out, const T& value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// The server applies leap seconds, so the page need not know them. No text for no instant.
void put_utc(std::string& out, TimeTai time) {
    constexpr std::size_t kBytes = 32;
    std::string text = time.ns == 0 ? std::string() : format_utc(time);
    text.resize(kBytes);
    out += text;
}

int blocks(int length, int step) { return (length + step - 1) / step; }

void put_reduced(std::string& out, const PictureSource& s, const PictureRequest& r) {
    const int across = blocks(r.width, r.step);
    std::vector<std::uint64_t> sums(static_cast<std::size_t>(across));
    for (int top = r.y; top < r.y + r.height; top += r.step) {
        const int rows = std::min(r.step, r.y + r.height - top);
        std::fill(sums.begin(), sums.end(), 0);
        for (int y = top; y < top + rows; ++y) {
            const std::uint16_t* row =
                s.samples.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(s.width) + r.x;
            for (int x = 0; x < r.width; ++x) sums[static_cast<std::size_t>(x / r.step)] += row[x];
        }
        for (int i = 0; i < across; ++i) {
            const auto count = static_cast<std::uint64_t>(rows * std::min(r.step, r.width - i * r.step));
            put(out, static_cast<std::uint16_t>((sums[static_cast<std::size_t>(i)] + count / 2) / count));
        }
    }
}

}  // namespace

PictureRequest fit_to_frame(PictureRequest r, int width, int height) {
    HILCAM_CHECK(width > 0 && height > 0);
    r.x = std::min(r.x, width - 1), r.y = std::min(r.y, height - 1);
    if (r.width <= 0) r.width = width;
    if (r.height <= 0) r.height = height;
    const int right = static_cast<int>(std::min<std::int64_t>(width, std::int64_t{r.x} + r.width));
    const int bottom = static_cast<int>(std::min<std::int64_t>(height, std::int64_t{r.y} + r.height));
    const auto too_many = [&](int step) {
        return std::int64_t{blocks(right - r.x / step * step, step)} *
                   blocks(bottom - r.y / step * step, step) >
               kMaxPictureSamples;
    };
    while (too_many(r.step)) ++r.step;
    r.x = r.x / r.step * r.step, r.y = r.y / r.step * r.step;
    r.width = right - r.x, r.height = bottom - r.y;
    return r;
}

std::string encode_picture(const PictureSource& s, const PictureRequest& r,
                           const std::string& color_pattern) {
    const int across = blocks(r.width, r.step), down = blocks(r.height, r.step);
    std::string out;
    out.reserve(kPictureHeaderBytes +
                std::size_t{2} * static_cast<std::size_t>(across) * static_cast<std::size_t>(down));
    const FrameRecord& f = s.record;
    out += "HCP1";
    put(out, static_cast<std::uint32_t>(kPictureHeaderBytes));
    put(out, f.id);  // 8
    for (const int value : {s.width, s.height, r.x, r.y, across, down, r.step, f.bits})
        put(out, static_cast<std::uint32_t>(value));  // 16 ..
    put(out, f.exposure_mid.ns);                      // 48
    put(out, f.pose_time.ns);
    put(out, f.exposure_mid_monotonic_ns);
    put(out, f.command_arrival_monotonic_ns);
    put(out, f.exposure_s);  // 80
    put(out, f.gain_db);
    put(out, f.black_level_dn);
    put(out, f.faults);         // 104
    put(out, f.pose_sequence);  // 112
    put(out, f.trigger_sequence);
    put(out, f.quality_level);
    put(out, static_cast<std::uint32_t>(f.binning_x));
    put(out, static_cast<std::uint32_t>(f.binning_y));  // 128
    char pattern[4] = {};
    std::copy_n(color_pattern.begin(), std::min<std::size_t>(color_pattern.size(), 4), pattern);
    out.append(pattern, 4);
    put(out, static_cast<std::uint32_t>(f.has_truth ? 1 : 0));  // 136
    put(out, std::uint32_t{0});
    put_utc(out, f.exposure_mid);  // 144
    put_utc(out, f.pose_time);     // 176
    out.resize(kPictureHeaderBytes);
    if (r.step > 1) {
        put_reduced(out, s, r);
        return out;
    }
    for (int y = r.y; y < r.y + r.height; ++y) {
        const std::uint16_t* row =
            s.samples.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(s.width) + r.x;
        out.append(reinterpret_cast<const char*>(row), std::size_t{2} * static_cast<std::size_t>(r.width));
    }
    return out;
}

}  // namespace hilcam
