#include "io/v4l2/v4l2_buffers.h"

#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <sys/mman.h>

#include <cerrno>

namespace hilcam {

int v4l2_ioctl(int fd, unsigned long request, void* argument) {
    int result;
    do result = ioctl(fd, request, argument);
    while (result < 0 && errno == EINTR);
    return result;
}

v4l2_buffer output_buffer(std::uint32_t index) {
    v4l2_buffer buffer{};
    buffer.index = index;
    buffer.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    buffer.memory = V4L2_MEMORY_MMAP;
    buffer.field = V4L2_FIELD_NONE;
    return buffer;
}

bool V4l2Buffers::request(int fd, unsigned count) {
    v4l2_requestbuffers asked{};
    asked.count = count;
    asked.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    asked.memory = V4L2_MEMORY_MMAP;
    if (v4l2_ioctl(fd, VIDIOC_REQBUFS, &asked) < 0) return false;
    for (std::uint32_t i = 0; i < asked.count; ++i) {
        v4l2_buffer buffer = output_buffer(i);
        if (v4l2_ioctl(fd, VIDIOC_QUERYBUF, &buffer) < 0 || !map(fd, buffer)) return false;
    }
    return !buffers_.empty();
}

bool V4l2Buffers::map_existing(int fd, unsigned most) {
    for (std::uint32_t i = 0; i < most; ++i) {
        v4l2_buffer buffer = output_buffer(i);
        // Beyond the last buffer, the module starts again with the first.
        if (v4l2_ioctl(fd, VIDIOC_QUERYBUF, &buffer) < 0 || at_offset(buffer.m.offset) < size()) break;
        if (!map(fd, buffer)) return false;
    }
    return !buffers_.empty();
}

bool V4l2Buffers::map(int fd, const v4l2_buffer& buffer) {
    void* memory = mmap(nullptr, buffer.length, PROT_READ | PROT_WRITE, MAP_SHARED, fd,
                        static_cast<off_t>(buffer.m.offset));
    if (memory == MAP_FAILED) return false;
    buffers_.push_back({{static_cast<std::uint8_t*>(memory), buffer.length}, buffer.m.offset});
    return true;
}

std::size_t V4l2Buffers::at_offset(std::uint32_t offset) const {
    std::size_t i = 0;
    while (i < buffers_.size() && buffers_[i].offset != offset) ++i;
    return i;
}

void V4l2Buffers::release() noexcept {
    for (const Buffer& buffer : buffers_) munmap(buffer.memory.data(), buffer.memory.size());
    buffers_.clear();
}

}  // namespace hilcam
