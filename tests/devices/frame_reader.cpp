// Reads frames of a V4L2 device and tells their times.    frame_reader DEVICE FRAMES [FILE]
//
// One line for each frame: microseconds from the buffer's time stamp to the return of VIDIOC_DQBUF, the time
// stamp itself in seconds, the sequence number. The pictures go to FILE.
#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <time.h>

#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
    if (argc != 3 && argc != 4) return 2;
    const int fd = open(argv[1], O_RDWR);
    if (fd < 0) return std::perror(argv[1]), 1;
    v4l2_requestbuffers request{};
    request.count = 4;
    request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    request.memory = V4L2_MEMORY_MMAP;
    if (ioctl(fd, VIDIOC_REQBUFS, &request)) return std::perror("VIDIOC_REQBUFS"), 1;
    std::FILE* file = argc == 4 ? std::fopen(argv[3], "wb") : nullptr;
    void* memory[32] = {};
    for (unsigned i = 0; i < request.count && i < 32; ++i) {
        v4l2_buffer buffer{};
        buffer.index = i;
        buffer.type = request.type;
        buffer.memory = request.memory;
        if (ioctl(fd, VIDIOC_QUERYBUF, &buffer)) return std::perror("VIDIOC_QUERYBUF"), 1;
        memory[i] = mmap(nullptr, buffer.length, PROT_READ, MAP_SHARED, fd, buffer.m.offset);
        if (memory[i] == MAP_FAILED) return std::perror("mmap"), 1;
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
        std::printf("%.1f %lld.%06ld %u\n", us, static_cast<long long>(buffer.timestamp.tv_sec),
                    static_cast<long>(buffer.timestamp.tv_usec), buffer.sequence);
        if (file) std::fwrite(memory[buffer.index], 1, buffer.bytesused, file);
        if (ioctl(fd, VIDIOC_QBUF, &buffer)) return std::perror("VIDIOC_QBUF"), 1;
    }
    return !file || std::fclose(file) == 0 ? 0 : 1;
}
