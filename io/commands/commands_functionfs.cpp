#include "io/commands/commands_functionfs.h"

#include <fcntl.h>
#include <linux/usb/functionfs.h>
#include <poll.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <thread>

#include "io/commands/command_station.h"
#include "io/commands/functionfs_control.h"
#include "io/commands/functionfs_descriptors.h"
#include "io/commands/linux_aio.h"
#include "io/commands/usb_answers.h"
#include "io/system/fd.h"
#include "io/system/monotonic.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr std::size_t kTransferBytes = 16384;
constexpr std::size_t kReads = 2;  // in flight
constexpr int kTick_ms = 50;

DeviceError trouble_with(const std::string& what) { return DeviceError(what + ": " + std::strerror(errno)); }

Fd open_file(const std::filesystem::path& path, int flags) {
    Fd fd(open(path.c_str(), flags | O_CLOEXEC));
    if (!fd)
        throw trouble_with(path.string() + " cannot be opened (mount -t functionfs NAME " +
                           path.parent_path().string() + " makes it)");
    return fd;
}

void write_all(const Fd& fd, const std::vector<std::uint8_t>& bytes, const std::string& what) {
    if (::write(fd.get(), bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
        throw trouble_with("FunctionFS does not take the " + what);
}

// One thread waits for ep0's events and the ends of transfers, takes commands and sends answers.
class FunctionFsReceiver : public CommandReceiver {
  public:
    FunctionFsReceiver(const FunctionFsConfig& config, CommandHandler& handler, FaultBoard& faults)
        : config_(config),
          faults_(faults),
          station_(handler, config.dialect),
          stream_(station_.make_stream(kTransferBytes)),
          answers_(faults),
          output_(kTransferBytes) {
        for (Read& read : reads_) read.bytes.resize(kTransferBytes);
    }
    ~FunctionFsReceiver() override { FunctionFsReceiver::stop(); }

    void start() override;
    void stop() noexcept override;
    std::string name() const override { return "functionfs " + config_.mount.string(); }
    CommandReport report() const override { return station_.report(); }
    std::vector<SenderReport> senders() const override { return station_.senders(); }
    void notify(const Telemetry& telemetry) noexcept override {
        if (telemetry_.put(telemetry)) wake(wakeup_);
    }

  private:
    struct Read {
        iocb request{};
        std::vector<std::uint8_t> bytes;
        bool in_flight = false;
    };
    void bind_gadget();
    void unbind_gadget() noexcept;
    void run();
    void take_events();
    void take_ended();
    void enable();
    void disable();
    void submit_reads();
    void send_answers();
    void send_telemetry();
    void follow_detach_fault();

    FunctionFsConfig config_;
    FaultBoard& faults_;
    CommandStation station_;
    PacketStream stream_;
    UsbAnswers answers_;
    TelemetryQueue telemetry_;
    Fd control_, out_, in_, wakeup_ = open_wakeup(), ended_ = open_wakeup();
    LinuxAio aio_;
    std::atomic<bool> stopping_{false};
    std::thread thread_;

    // Owned by the thread.
    std::array<Read, kReads> reads_;
    std::vector<std::uint8_t> output_;
    std::size_t output_bytes_ = 0;  // waiting to be sent, or being sent
    iocb output_request_{};
    bool output_in_flight_ = false, enabled_ = false, detached_ = false;
    CommandStation::Sender* sender_ = nullptr;  // while a host has configured us
    std::uint64_t detachments_ = 0;
};

void FunctionFsReceiver::start() {
    control_ = open_file(config_.mount / "ep0", O_RDWR | O_NONBLOCK);
    write_all(control_, functionfs_descriptors(), "descriptors");
    write_all(control_, functionfs_strings("hilcam commands"), "strings");
    // The endpoints exist once the descriptors are written. O_NONBLOCK: one that no host has enabled must not
    // block us.
    out_ = open_file(config_.mount / "ep1", O_RDWR | O_NONBLOCK);
    in_ = open_file(config_.mount / "ep2", O_RDWR | O_NONBLOCK);
    if (!aio_.open(kReads + 1)) throw trouble_with("no asynchronous input and output");
    if (!config_.gadget.empty()) bind_gadget();
    stopping_ = false;
    thread_ = std::thread([this] { run(); });
}

void FunctionFsReceiver::stop() noexcept {
    if (!thread_.joinable()) return;
    stopping_ = true;
    wake(wakeup_);
    thread_.join();
    if (!config_.gadget.empty()) unbind_gadget();
    aio_.close();
    in_.reset();
    out_.reset();
    control_.reset();
    for (Read& read : reads_) read.in_flight = false;
    output_in_flight_ = false;
    output_bytes_ = 0;
}

void FunctionFsReceiver::bind_gadget() {
    std::string controller = config_.controller;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator("/sys/class/udc", error))
        if (controller.empty()) controller = entry.path().filename().string();
    if (controller.empty())
        throw DeviceError("this machine has no USB device controller (/sys/class/udc is empty)");
    std::ofstream file(config_.gadget / "UDC");
    file << controller << std::flush;
    if (!file)
        throw trouble_with((config_.gadget / "UDC").string() + " does not take controller " + controller);
}

void FunctionFsReceiver::unbind_gadget() noexcept {
    std::ofstream(config_.gadget / "UDC") << "\n" << std::flush;
}

void FunctionFsReceiver::run() {
    pollfd watched[] = {{control_.get(), POLLIN, 0}, {ended_.get(), POLLIN, 0}, {wakeup_.get(), POLLIN, 0}};
    while (!stopping_) {
        poll(watched, 3, kTick_ms);
        if (watched[2].revents) drain(wakeup_);
        if (watched[1].revents) {
            drain(ended_);
            take_ended();
        }
        if (watched[0].revents & POLLIN) take_events();
        if (!config_.gadget.empty()) follow_detach_fault();
        send_telemetry();
        if (!enabled_) continue;
        submit_reads();
        send_answers();
    }
    disable();
}

void FunctionFsReceiver::take_events() {
    std::array<usb_functionfs_event, 4> events;
    const ssize_t size = ::read(control_.get(), events.data(), sizeof events);
    if (size <= 0) return;
    for (std::size_t i = 0; i < static_cast<std::size_t>(size) / sizeof events[0]; ++i) {
        switch (events[i].type) {
            case FUNCTIONFS_ENABLE:
                disable();  // a host may configure us again without disabling first
                enable();
                break;
            case FUNCTIONFS_DISABLE:
            case FUNCTIONFS_UNBIND:
                disable();
                break;
            case FUNCTIONFS_SETUP:
                refuse_request(control_, events[i]);
                break;
            default:
                break;
        }
    }
}

void FunctionFsReceiver::enable() {
    sender_ = &station_.open("USB host");
    enabled_ = true;
}

// Transfers in flight end by themselves, with an error.
void FunctionFsReceiver::disable() {
    if (!enabled_) return;
    enabled_ = false;
    const CommandStation::Answer nobody = [](std::span<const std::uint8_t>) {};
    station_.take_all(stream_, monotonic_ns(), *sender_, nobody);
    station_.close(*sender_);
    sender_ = nullptr;
    answers_.clear();
    if (!output_in_flight_) output_bytes_ = 0;
}

void FunctionFsReceiver::submit_reads() {
    for (std::size_t i = 0; i < kReads; ++i) {
        Read& r = reads_[i];
        // A read that is refused is tried again at the next tick.
        if (!r.in_flight) r.in_flight = aio_.submit(r.request, out_.get(), false, r.bytes, ended_.get(), i);
    }
}

void FunctionFsReceiver::take_ended() {
    const std::int64_t arrival_ns = monotonic_ns();
    for (const io_event& event : aio_.ended()) {
        if (event.data == kReads) {
            output_in_flight_ = false;
            output_bytes_ = 0;
            continue;
        }
        Read& r = reads_[event.data];
        r.in_flight = false;
        if (event.res <= 0 || !enabled_) continue;
        const auto size = static_cast<std::size_t>(event.res);
        std::copy_n(r.bytes.begin(), size, stream_.room().begin());
        stream_.filled(size);
        station_.take(stream_, arrival_ns, *sender_,
                      [&](std::span<const std::uint8_t> packet) { answers_.put(packet, false); });
    }
}

void FunctionFsReceiver::send_answers() {
    if (output_in_flight_) return;
    // A write that is refused is tried again at the next tick.
    if (output_bytes_ == 0) output_bytes_ = answers_.next(output_);
    if (output_bytes_ > 0)
        output_in_flight_ = aio_.submit(output_request_, in_.get(), true,
                                        std::span(output_).first(output_bytes_), ended_.get(), kReads);
}

void FunctionFsReceiver::send_telemetry() {
    Telemetry telemetry;
    while (telemetry_.take(telemetry))
        station_.notify(telemetry, [&](CommandStation::Sender&, std::span<const std::uint8_t> packet) {
            answers_.put(packet, true);
        });
}

void FunctionFsReceiver::follow_detach_fault() {
    const bool now = faults_.would_strike(FaultKind::kUsbDetach, 0, detachments_).has_value();
    if (now == detached_) return;
    detached_ = now;
    if (now) {
        faults_.strikes(FaultKind::kUsbDetach, 0, detachments_);
        return unbind_gadget();
    }
    ++detachments_;
    try {
        bind_gadget();
    } catch (const DeviceError&) {
        detached_ = true;  // the controller is in use: try again at the next tick
    }
}

}  // namespace

Fields fields(FunctionFsConfig& c) {
    Fields list = {
        path("mount", c.mount, "mount point of FunctionFS"),
        path("gadget", c.gadget,
             "folder of the gadget in configfs, which hilcam binds and unbinds; left out: the user does so"),
        text("controller", c.controller, "name of the controller in /sys/class/udc; left out: the first"),
    };
    add_fields(c.dialect, list);
    return list;
}

void validate(const FunctionFsConfig& c) { validate(c.dialect); }

std::unique_ptr<CommandReceiver> make_functionfs_receiver(const FunctionFsConfig& config,
                                                          CommandHandler& handler, FaultBoard& faults) {
    return std::make_unique<FunctionFsReceiver>(config, handler, faults);
}

}  // namespace hilcam
