#pragma once
// Frame memory shared between a V4L2 output device and this process.

#include <cstdint>
#include <span>
#include <vector>

struct v4l2_buffer;

namespace hilcam {

// Calls ioctl() again as long as a signal interrupts it.
int v4l2_ioctl(int fd, unsigned long request, void* argument);

class V4l2Buffers {
  public:
    V4l2Buffers() = default;
    ~V4l2Buffers() { release(); }
    V4l2Buffers(const V4l2Buffers&) = delete;
    V4l2Buffers& operator=(const V4l2Buffers&) = delete;

    // Requests buffers (REQBUFS) and maps them. False: see errno.
    bool request(int fd, unsigned count);
    // Maps the buffers that the device already has, at most `most`. False: see errno.
    bool map_existing(int fd, unsigned most);
    void release() noexcept;

    std::size_t size() const { return buffers_.size(); }
    std::span<std::uint8_t> memory(std::size_t index) const { return buffers_[index].memory; }
    // Returns the index of the buffer mapped at an offset of the device's memory; size() when there is none.
    std::size_t at_offset(std::uint32_t offset) const;

  private:
    bool map(int fd, const v4l2_buffer& buffer);

    struct Buffer {
        std::span<std::uint8_t> memory;
        std::uint32_t offset = 0;
    };
    std::vector<Buffer> buffers_;
};

// Returns an output buffer as ioctls take it.
v4l2_buffer output_buffer(std::uint32_t index);

}  // namespace hilcam
