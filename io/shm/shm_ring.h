#pragma once
// The layout of the shared memory that outputs.shm fills: a header, then a ring of slots.
//
// Numbers are in the machine's own format. Frames are counted from 1 without gaps, whatever their ids; frame
// n is in slot (n - 1) % slots. A slot's sequence is 2n - 1 while frame n is written, and 2n when it is
// complete. A reader that finds 2n both before and after it reads has read frame n and nothing else (a
// seqlock; H.-J. Boehm, "Can seqlocks get along with programming language memory models?", MSPC 2012, gives
// the fences). Readers map the memory read-only and cannot delay the writer.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace hilcam {

inline constexpr std::uint64_t kShmMagic = 0x31204D4853434C48;  // "HLCSHM 1" in memory, lowest byte first
inline constexpr std::uint32_t kShmVersion = 1;
inline constexpr std::size_t kShmHeaderBytes = 4096, kShmSlotHeaderBytes = 256;

struct ShmHeader {
    std::atomic<std::uint64_t> magic;  // set last
    std::uint32_t version;
    std::uint32_t header_bytes;
    std::uint32_t slots;
    std::uint32_t slot_header_bytes;  // offset of the pixels in a slot
    std::uint64_t slot_bytes;         // from one slot to the next
    std::uint64_t segment_bytes;
    std::uint32_t max_width_px, max_height_px;
    std::uint32_t pixel_bytes;  // 2: a DN in the lower bits of 16
    std::uint32_t writer_pid;
    std::uint64_t reserved_before_names;
    std::array<char, 64> camera;  // its name, terminated by a 0
    std::array<char, 16> colors;  // colour filter array: "RGGB", ...; empty: monochrome
    std::array<std::uint64_t, 6> reserved;
    // The following change; they have a cache line of their own.
    std::atomic<std::uint64_t> published;  // number of the newest complete frame; 0: none yet
    std::atomic<std::uint32_t> news;       // its lower 32 bits, the word for a futex
    std::atomic<std::uint32_t> ended;      // 1: no more frames come
};
static_assert(offsetof(ShmHeader, camera) == 64 && offsetof(ShmHeader, published) == 192 &&
              sizeof(ShmHeader) == 208 && std::atomic<std::uint64_t>::is_always_lock_free &&
              sizeof(std::atomic<std::uint64_t>) == 8);

struct ShmSlot {
    std::atomic<std::uint64_t> sequence;
    std::uint64_t id;
    std::int64_t exposure_mid_tai_ns;
    std::int64_t exposure_mid_monotonic_ns;  // CLOCK_MONOTONIC of this machine; 0: none
    std::int64_t published_monotonic_ns;     // end of the copy
    double exposure_s;
    double gain_db;
    double black_level_dn;
    std::uint32_t bits;
    std::uint32_t width_px, height_px;
    std::uint32_t row_bytes;
    std::uint32_t binning_x, binning_y;
    std::uint32_t pose_sequence, trigger_sequence;
    std::int64_t pose_tai_ns;
    std::uint64_t faults;
    std::uint32_t quality_level;
    std::uint32_t flags;
    std::int64_t command_arrival_monotonic_ns;
    std::array<double, 3> camera_position_m;     // world axes
    std::array<double, 4> camera_attitude_wxyz;  // rotates camera axes into the world's
};
inline constexpr std::uint32_t kShmReverseX = 1, kShmReverseY = 2, kShmHasPose = 4, kShmHasTruth = 8;
static_assert(offsetof(ShmSlot, bits) == 64 && offsetof(ShmSlot, pose_tai_ns) == 96 &&
              offsetof(ShmSlot, camera_position_m) == 128 && sizeof(ShmSlot) == 184);

}  // namespace hilcam
