#pragma once
// Asynchronous reads and writes by the kernel (io_submit(2)). FunctionFS endpoints cannot be polled; this is
// the only way to wait for several at once.

#include <linux/aio_abi.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <span>

namespace hilcam {

class LinuxAio {
  public:
    LinuxAio() = default;
    ~LinuxAio() { close(); }
    LinuxAio(const LinuxAio&) = delete;
    LinuxAio& operator=(const LinuxAio&) = delete;

    bool open(unsigned requests) { return syscall(SYS_io_setup, requests, &context_) == 0; }
    // Cancels what is in flight and waits until it has ended.
    void close() {
        if (context_ != 0) syscall(SYS_io_destroy, context_);
        context_ = 0;
    }
    // Submits a read or write. event: an eventfd that is written at its end; the bytes must stay in place
    // until then.
    bool submit(iocb& request, int file, bool write, std::span<std::uint8_t> bytes, int event,
                std::uint64_t tag) {
        request = {};
        request.aio_data = tag;
        request.aio_lio_opcode = static_cast<std::uint16_t>(write ? IOCB_CMD_PWRITE : IOCB_CMD_PREAD);
        request.aio_fildes = static_cast<std::uint32_t>(file);
        request.aio_buf = reinterpret_cast<std::uint64_t>(bytes.data());
        request.aio_nbytes = bytes.size();
        request.aio_flags = IOCB_FLAG_RESFD;
        request.aio_resfd = static_cast<std::uint32_t>(event);
        iocb* list = &request;
        return syscall(SYS_io_submit, context_, 1, &list) == 1;
    }
    // Returns the requests that have ended, without waiting: io_event.data is the tag, io_event.res the bytes
    // or -errno.
    std::span<const io_event> ended() {
        timespec none{};
        const long count = syscall(SYS_io_getevents, context_, 0, events_.size(), events_.data(), &none);
        return std::span(events_).first(count > 0 ? static_cast<std::size_t>(count) : 0);
    }

  private:
    aio_context_t context_ = 0;
    std::array<io_event, 8> events_{};
};

}  // namespace hilcam
