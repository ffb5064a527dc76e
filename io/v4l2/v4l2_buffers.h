#pragma once
// Frame memory that a V4L2 output device shares with this process.

#include <cstdint>
#include <span>
#include <vector>

struct v4l2_buffer;

namespace hilcam {

// ioctl, again when a signal came between.
int v4l2_ioctl(int fd, unsigned long request, void* argument);

class V4l2Buffers {
  public:
    V4l2Buffers() = default;
    ~V4l2Buffers() { release(); }
    V4l2Buffers(const V4l2Buffers&) = delete;
    V4l2Buffers& operator=(const V4l2Buffers&) = delete;

    // REQBUFS; maps what it gives. False: errno.
    bool request(int fd, unsigned count);
    // Maps the buffers that the device has without asking for any. False: errno.
    bool map_existing(int fd, unsigned most);
    void release() noexcept;

    std::size_t size() const { return buffers_.size(); }
    std::span<std::uint8_t> memory(std::size_t index) const { return buffers_[index].memory; }
    // The mapped buffer at an offset of the device's memory; size() when there is none.
    std::size_t at_offset(std::uint32_t offset) const;

  private:
    bool map(int fd, const v4l2_buffer& buffer);

    struct Buffer {
        std::span<std::uint8_t> memory;
        std::uint32_t offset = 0;
    };
    std::vector<Buffer> buffers_;
};

// An output buffer as ioctls take it.
v4l2_buffer output_buffer(std::uint32_t index);

}  // namespace hilcam
