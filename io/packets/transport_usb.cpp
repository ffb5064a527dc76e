// Packets on the bulk IN endpoint of a FunctionFS function, with this machine as the USB device. The user makes
// the gadget through configfs and binds it once hilcam has written the descriptors (docs/packets.md).
//
// A transfer is some whole packets, so that what a host finds when it reads again after a pause is still a
// stream of packets. A transfer of full USB packets ends with one of no bytes (USB 2.0, 5.8.3).

#include <fcntl.h>
#include <linux/usb/functionfs.h>
#include <poll.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "io/commands/functionfs_control.h"
#include "io/commands/functionfs_descriptors.h"
#include "io/commands/linux_aio.h"
#include "io/packets/packet_stream_peer.h"
#include "io/packets/packet_transport.h"
#include "io/packets/packets_config.h"
#include "io/system/fd.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr std::size_t kMostTransferBytes = 16384;
constexpr std::size_t kWrites = 6;              // in flight, those of no bytes included
constexpr std::size_t kSmallestUsbPacket = 64;  // at full speed; larger ones are multiples

Fd open_endpoint(const std::filesystem::path& path) {
    Fd fd(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
    if (!fd)
        throw DeviceError(path.string() + " cannot be opened (mount -t functionfs NAME " +
                          path.parent_path().string() + " makes it): " + std::strerror(errno));
    return fd;
}

class UsbTransport : public PacketTransport {
  public:
    explicit UsbTransport(const PacketsConfig& c)
        : PacketTransport("usb " + c.path.string()),
          mount_(c.path),
          patience_ms_(static_cast<int>(1e3 * c.patience_s)) {}

    void open() override {
        control_ = open_endpoint(mount_ / "ep0");
        give(functionfs_descriptors(), "descriptors");
        give(functionfs_strings("hilcam packets"), "strings");
        in_ = open_endpoint(mount_ / "ep2");
        if (!aio_.open(kWrites))
            throw DeviceError(std::string("no asynchronous output: ") + std::strerror(errno));
    }
    bool begin_frame(std::uint64_t) override {
        waiting_.clear();
        take_events();
        take_ended();
        lost_ = false;  // the transfers that have ended belong to earlier frames
        if (enabled_ && given_up_ && in_flight() == 0) given_up_ = false;
        return enabled_ && !given_up_;
    }
    bool send(std::span<const std::uint8_t> bytes) override {
        if (waiting_.size() + bytes.size() > kMostTransferBytes && !submit()) return false;
        waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
        return true;
    }
    Outcome end_frame() override { return submit() && !lost_ ? Outcome::kDelivered : Outcome::kDropped; }
    // Lets a host read what is on its way.
    void close() noexcept override {
        while (enabled_ && !given_up_ && in_flight() > 0 && wait_for_end()) {
        }
        aio_.close();
        for (Write& write : writes_) write.in_flight = false;
        in_.reset();
        control_.reset();
        enabled_ = false;
    }

  private:
    struct Write {
        iocb request{};
        std::vector<std::uint8_t> bytes;
        bool in_flight = false;
    };

    void give(const std::vector<std::uint8_t>& bytes, const std::string& what) {
        if (::write(control_.get(), bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
            throw DeviceError("FunctionFS does not take the " + what + ": " + std::strerror(errno));
    }
    std::size_t in_flight() const {
        std::size_t count = 0;
        for (const Write& write : writes_) count += write.in_flight;
        return count;
    }
    bool submit() {
        if (waiting_.empty()) return true;
        const bool full = waiting_.size() % kSmallestUsbPacket == 0;
        bool sent = write_out(waiting_);
        waiting_.clear();
        if (!sent || !full) return sent;
        sent = write_out(waiting_);
        waiting_.clear();
        return sent;
    }
    // Takes the bytes, and leaves others in their place.
    bool write_out(std::vector<std::uint8_t>& bytes) {
        Write* const write = free_write();
        if (!write) return false;
        std::swap(write->bytes, bytes);
        const auto tag = static_cast<std::uint64_t>(write - writes_.data());
        write->in_flight = aio_.submit(write->request, in_.get(), true, write->bytes, ended_.get(), tag);
        if (!write->in_flight) lose("has gone");
        return write->in_flight;
    }
    Write* free_write() {
        while (true) {
            take_ended();
            if (lost_) return nullptr;
            for (Write& write : writes_)
                if (!write.in_flight) return &write;
            if (wait_for_end()) continue;
            given_up_ = true;
            lose(has_read_nothing_for(patience_ms_));
            return nullptr;
        }
    }
    bool wait_for_end() {
        pollfd watched{ended_.get(), POLLIN, 0};
        if (poll(&watched, 1, patience_ms_) <= 0) return false;
        take_ended();
        return true;
    }
    void take_ended() {
        drain(ended_);
        for (const io_event& event : aio_.ended()) {
            writes_[event.data].in_flight = false;
            if (event.res < 0) lose("has gone");  // disabled or unplugged: the kernel cancels transfers
        }
    }
    void lose(const std::string& what) {
        if (!lost_) note("the host " + what, true);
        lost_ = true;
    }
    void take_events() {
        std::array<usb_functionfs_event, 4> events;
        const ssize_t size = ::read(control_.get(), events.data(), sizeof events);
        for (std::size_t i = 0; size > 0 && i < static_cast<std::size_t>(size) / sizeof events[0]; ++i) {
            switch (events[i].type) {
                case FUNCTIONFS_ENABLE:
                    if (!enabled_) note("a host has configured it", false);
                    enabled_ = true;
                    break;
                case FUNCTIONFS_DISABLE:
                case FUNCTIONFS_UNBIND:
                    enabled_ = false;
                    break;
                case FUNCTIONFS_SETUP:
                    refuse_request(control_, events[i]);
                    break;
                default:
                    break;
            }
        }
    }

    std::filesystem::path mount_;
    int patience_ms_;
    Fd control_, in_, ended_ = open_wakeup();
    LinuxAio aio_;
    std::array<Write, kWrites> writes_;
    std::vector<std::uint8_t> waiting_;
    bool enabled_ = false;   // a host has configured us
    bool given_up_ = false;  // it reads nothing: until all that is on its way has been read
    bool lost_ = false;      // a part of this frame
};

}  // namespace

std::unique_ptr<PacketTransport> make_usb_transport(const PacketsConfig& config) {
    return std::make_unique<UsbTransport>(config);
}

}  // namespace hilcam
