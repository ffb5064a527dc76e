#include "io/lines/pps_source.h"

#include <fcntl.h>
#include <linux/pps.h>
#include <pthread.h>
#include <sys/ioctl.h>

#include <cerrno>
#include <cstring>

#include "io/system/datagram_arrival.h"
#include "io/system/urgent_thread.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

std::int64_t ns_of(const pps_ktime& time) { return std::int64_t{time.sec} * 1'000'000'000 + time.nsec; }

std::string text_of(int error, const std::string& device) {
    return device + ": " + std::strerror(error) +
           (error == ENOTTY ? "; it is no PPS device" : "; ls /dev/pps* shows what there is");
}

[[noreturn]] void fail(const std::string& device) { throw DeviceError(text_of(errno, device)); }

// Opens it and asks what it can capture; without either, errno says why.
Fd open_pps(const std::string& device, int& can) {
    Fd fd(::open(device.c_str(), O_RDWR | O_CLOEXEC));
    if (fd && ioctl(fd.get(), PPS_GETCAP, &can) < 0) {
        const int error = errno;
        fd.reset();
        errno = error;
    }
    return fd;
}

}  // namespace

std::string fault_of_pps(const std::string& device) {
    int can = 0;
    const Fd fd = open_pps(device, can);
    return fd ? std::string() : text_of(errno, device);
}

PpsSource::PpsSource(std::string device) : device_(std::move(device)) {
    int can = 0;
    fd_ = open_pps(device_, can);
    if (!fd_) fail(device_);
    pps_kparams params{};
    if (ioctl(fd_.get(), PPS_GETPARAMS, &params) < 0) fail(device_);
    params.api_version = PPS_API_VERS;
    params.mode |= PPS_CAPTUREASSERT | (can & PPS_CAPTURECLEAR);
    // Without the right to change what is captured (CAP_SYS_TIME), it is what it was.
    if (ioctl(fd_.get(), PPS_SETPARAMS, &params) < 0 && ioctl(fd_.get(), PPS_GETPARAMS, &params) < 0)
        fail(device_);
    has_clear_ = (params.mode & PPS_CAPTURECLEAR) != 0;
}

void PpsSource::start(std::function<void(const Edge&)> tell) {
    tell_ = std::move(tell);
    stopping_ = false;
    thread_ = std::thread([this] { run(); });
}

void PpsSource::stop() noexcept {
    if (!thread_.joinable()) return;
    stopping_ = true;
    thread_.join();
}

void PpsSource::run() {
    pthread_setname_np(pthread_self(), "pps");
    make_thread_urgent();
    pps_fdata data{};
    data.timeout = {.sec = 0, .nsec = 1, .flags = 0};
    ioctl(fd_.get(), PPS_FETCH, &data);  // pulses of the past
    pps_kinfo seen = data.info;
    while (!stopping_) {
        data.timeout = {.sec = 0, .nsec = 200'000'000, .flags = 0};
        if (ioctl(fd_.get(), PPS_FETCH, &data) < 0) {
            // A device that is gone may come back; then its descriptor does not help.
            if (errno != ETIMEDOUT && errno != EINTR) sleep_until_monotonic_ns(monotonic_ns() + 200'000'000);
            continue;
        }
        const pps_kinfo& now = data.info;
        if (now.assert_sequence != seen.assert_sequence) {
            const std::int64_t at_ns = monotonic_of_realtime(ns_of(now.assert_tu));
            tell_({true, at_ns, now.assert_sequence});
            if (!has_clear_) tell_({false, at_ns + kPulse_ns, now.assert_sequence});
        }
        if (has_clear_ && now.clear_sequence != seen.clear_sequence)
            tell_({false, monotonic_of_realtime(ns_of(now.clear_tu)), now.clear_sequence});
        seen = now;
    }
}

}  // namespace hilcam
