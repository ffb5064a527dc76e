#pragma once
// A V4L2 output device that takes frames: v4l2loopback's writing side, with workarounds for its versions
// (v4l2_module.h). It knows ioctls; the caller decides when a frame is due.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/system/fd.h"
#include "io/v4l2/v4l2_buffers.h"
#include "io/v4l2/v4l2_module.h"

namespace hilcam {

class V4l2Output {
  public:
    struct Request {
        std::string device;
        std::uint32_t fourcc = 0;
        int width = 0, height = 0;
        std::size_t bytes_per_line = 0;
        double frame_rate_hz = 30;
        bool mapped = true;  // false: write()
        unsigned buffers = 4;
    };

    ~V4l2Output() { close(); }

    // Throws DeviceError that says what is wrong and what to do: no such device, no permission, not an
    // output, busy, or a format that it does not support or that a reader blocks.
    void open(const Request& request);
    void close() noexcept;
    bool is_open() const { return static_cast<bool>(fd_); }

    // Returns the memory for the next frame; empty when the device fails (errno). No allocation.
    std::span<std::uint8_t> next() noexcept;
    // Gives that frame to the readers. timestamp_ns: CLOCK_MONOTONIC, only if mapped; 0: the module's own.
    // False: see errno.
    bool submit(std::int64_t timestamp_ns) noexcept;

    const LoopbackModule& module() const { return module_; }
    std::size_t buffers_in_use() const { return in_use_; }

  private:
    void check_output();
    void check_offered() const;
    void set_format();
    void prepare_buffers();
    std::string hint_of_fallback(std::uint32_t fourcc) const;
    void recount();

    Request request_;
    LoopbackModule module_;
    bool shared_queue_ = false;
    Fd fd_;
    V4l2Buffers buffers_;
    std::vector<std::uint8_t> staging_;
    std::size_t frame_bytes_ = 0, in_use_ = 0;
    std::uint32_t next_index_ = 0;
    std::size_t queued_ = 0;
};

}  // namespace hilcam
