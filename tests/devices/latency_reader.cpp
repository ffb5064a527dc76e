// How long frames of a V4L2 device take from their time stamp to this reader.    latency_reader DEVICE FRAMES
//
// One line for each frame: microseconds from the buffer's time stamp to the return of VIDIOC_DQBUF.
#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <time.h>

#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const int fd = open(argv[1], O_RDWR);
    if (fd < 0) return std::perror(argv[1]), 1;
    v4l2_requestbuffers request{};
    request.count = 4;
    request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    request.memory = V4L2_MEMORY_MMAP;
    if (ioctl(fd, VIDIOC_REQBUFS, &request)) return std::perror("VIDIOC_REQBUFS"), 1;
    for (unsigned i = 0; i < request.count; ++i) {
        v4l2_buffer buffer{};
        buffer.index = i;
        buffer.type = request.type;
        buffer.memory = request.memory;
        if (ioctl(fd, VIDIOC_QUERYBUF, &buffer)) return std::perror("VIDIOC_QUERYBUF"), 1;
        if (mmap(nullptr, buffer.length, PROT_READ, MAP_SHARED, fd, buffer.m.offset) == MAP_FAILED)
            return std::perror("mmap"), 1;
        if (ioctl(fd, VIDIOC_QBUF, &buffer)) return std::perror("VIDIOC_QBUF"), 1;
    }
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (ioctl(fd, VIDIOC_STREAMON, &type)) return std::perror("VIDIOC_STREAMON"), 1;
    for (int n = 0; n < std::atoi(argv[2]); ++n) {
        v4l2_buffer buffer{};
        buffer.type = request.type;
        buffer.memory = request.memory;
        if (ioctl(fd, VIDIOC_DQBUF, &buffer)) return std::perror("VIDIOC_DQBUF"), 1;
        timespec now{};
        clock_gettime(CLOCK_MONOTONIC, &now);
        const double us = 1e6 * static_cast<double>(now.tv_sec - buffer.timestamp.tv_sec) +
                          1e-3 * static_cast<double>(now.tv_nsec) -
                          static_cast<double>(buffer.timestamp.tv_usec);
        std::printf("%.1f\n", us);
        if (ioctl(fd, VIDIOC_QBUF, &buffer)) return std::perror("VIDIOC_QBUF"), 1;
    }
}
