#include "io/commands/commands_usb.h"

#include <libusb.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <optional>
#include <thread>
#include <utility>

#include "io/commands/command_station.h"
#include "io/commands/usb_answers.h"
#include "io/commands/usb_device.h"
#include "io/system/monotonic.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// A multiple of every speed's bulk packet size (64, 512, 1024): a device cannot overrun a transfer.
constexpr std::size_t kTransferBytes = 16384;
// In flight, so that the bus never waits while a command is carried out.
constexpr std::size_t kTransfersIn = 4;
constexpr std::int64_t kTryAgain_ns = 500'000'000;
constexpr int kMaxErrors = 16;  // in a row; then the device is opened anew

// One thread opens the device, runs libusb's events and so all callbacks, takes commands and sends answers.
class UsbCommandReceiver : public CommandReceiver {
  public:
    UsbCommandReceiver(const UsbCommandConfig& config, CommandHandler& handler, FaultBoard& faults)
        : id_(parse_usb_id(config.device)),
          faults_(faults),
          station_(handler, config.dialect),
          stream_(station_.make_stream(kTransferBytes)),
          answers_(faults) {}
    ~UsbCommandReceiver() override { UsbCommandReceiver::stop(); }

    void start() override;
    void stop() noexcept override;
    std::string name() const override { return "usb " + to_string(id_); }
    CommandReport report() const override { return station_.report(); }
    std::vector<SenderReport> senders() const override { return station_.senders(); }
    std::string trouble() const override {
        const std::lock_guard lock(trouble_mutex_);
        return trouble_;
    }
    void notify(const Telemetry& telemetry) noexcept override {
        if (!telemetry_.put(telemetry)) return;
        const std::lock_guard lock(context_mutex_);
        if (context_) libusb_interrupt_event_handler(context_.get());
    }

  private:
    struct Transfer {
        UsbCommandReceiver* owner = nullptr;
        libusb_transfer* usb = nullptr;
        std::array<std::uint8_t, kTransferBytes> bytes;
        bool in_flight = false;
    };
    static void LIBUSB_CALL on_input(libusb_transfer* usb);
    static void LIBUSB_CALL on_output(libusb_transfer* usb);
    static int LIBUSB_CALL on_hotplug(libusb_context*, libusb_device* device, libusb_hotplug_event event,
                                      void* owner);
    void renew_context();
    void run();
    void handle_events(int milliseconds);
    void look_for_device();
    void open_device(UsbDevice device);
    void close_device();
    void submit(Transfer& transfer);
    void received(Transfer& transfer);
    void send_answers();
    void send_telemetry();
    bool detached_by_fault();

    UsbId id_;
    FaultBoard& faults_;
    CommandStation station_;
    PacketStream stream_;
    UsbAnswers answers_;
    TelemetryQueue telemetry_;
    std::mutex context_mutex_;  // guards creation and destruction of the context
    UsbContext context_;
    std::atomic<bool> stopping_{false};
    std::thread thread_;
    mutable std::mutex trouble_mutex_;
    std::string trouble_;

    // Owned by the thread.
    UsbDevice device_;
    CommandStation::Sender* sender_ = nullptr;  // while the device is open
    std::array<Transfer, kTransfersIn> inputs_;
    Transfer output_;
    bool arrived_ = false, lost_ = false, closing_ = false, halted_in_ = false, halted_out_ = false,
         detached_ = false;
    int errors_ = 0;
    std::uint64_t detachments_ = 0;
    std::int64_t next_try_ns_ = 0;
};

void UsbCommandReceiver::start() {
    renew_context();
    for (Transfer& t : inputs_) t.owner = this;
    output_.owner = this;
    stopping_ = false;
    thread_ = std::thread([this] { run(); });
}

// libusb learns of new devices through udev. Without a udev daemon (a small bench machine, a container), only
// a new context sees them.
void UsbCommandReceiver::renew_context() {
    UsbContext context = make_usb_context();
    if (libusb_has_capability(LIBUSB_CAP_HAS_HOTPLUG))
        libusb_hotplug_register_callback(
            context.get(), LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED | LIBUSB_HOTPLUG_EVENT_DEVICE_LEFT,
            LIBUSB_HOTPLUG_NO_FLAGS, id_.vendor, id_.product, LIBUSB_HOTPLUG_MATCH_ANY, on_hotplug, this,
            nullptr);
    const std::lock_guard lock(context_mutex_);
    context_ = std::move(context);
}

void UsbCommandReceiver::stop() noexcept {
    if (!thread_.joinable()) return;
    stopping_ = true;
    {
        const std::lock_guard lock(context_mutex_);
        libusb_interrupt_event_handler(context_.get());
    }
    thread_.join();
    const std::lock_guard lock(context_mutex_);
    context_.reset();
}

// libusb may announce a device twice, and report the removal of devices never announced. So the callback only
// sets flags, and the work is done outside it.
int UsbCommandReceiver::on_hotplug(libusb_context*, libusb_device* device, libusb_hotplug_event event,
                                   void* owner) {
    auto& self = *static_cast<UsbCommandReceiver*>(owner);
    if (event == LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED)
        self.arrived_ = true;
    else if (self.device_ && libusb_get_device(self.device_.handle.get()) == device)
        self.lost_ = true;
    return 0;
}

void UsbCommandReceiver::run() {
    while (!stopping_) {
        const bool detached = detached_by_fault();
        if (device_ && (lost_ || detached || errors_ > kMaxErrors)) close_device();
        if (!device_ && !detached) look_for_device();
        if (device_ && halted_in_) {
            halted_in_ = false;
            libusb_clear_halt(device_.handle.get(), device_.in);
        }
        if (device_ && halted_out_) {
            halted_out_ = false;
            libusb_clear_halt(device_.handle.get(), device_.out);
        }
        if (device_) {
            for (Transfer& t : inputs_)
                if (!t.in_flight) submit(t);
        }
        send_telemetry();
        send_answers();
        // The wait ends early on any transfer, hot-plug event or telemetry.
        handle_events(50);
    }
    if (device_) close_device();
}

void UsbCommandReceiver::handle_events(int milliseconds) {
    timeval wait{0, milliseconds * 1000};
    libusb_handle_events_timeout_completed(context_.get(), &wait, nullptr);
}

bool UsbCommandReceiver::detached_by_fault() {
    const bool now = faults_.would_strike(FaultKind::kUsbDetach, 0, detachments_).has_value();
    if (now && !detached_) faults_.strikes(FaultKind::kUsbDetach, 0, detachments_);
    if (!now && detached_) ++detachments_;
    detached_ = now;
    return now;
}

void UsbCommandReceiver::look_for_device() {
    const std::int64_t now_ns = monotonic_ns();
    if (!arrived_ && now_ns < next_try_ns_) return;
    next_try_ns_ = now_ns + kTryAgain_ns;
    std::string why;
    UsbDevice found;
    try {
        if (!arrived_) renew_context();
        arrived_ = false;
        found = open_usb(context_.get(), id_, why);
    } catch (const DeviceError& error) {
        why = error.what();
    }
    {
        const std::lock_guard lock(trouble_mutex_);
        trouble_ = why.empty() ? "" : "USB device " + to_string(id_) + " " + why;
    }
    if (found) open_device(std::move(found));
}

// A transfer keeps a reference to the device it was last submitted to, and the device one to its context. So
// every device gets new transfers.
void UsbCommandReceiver::open_device(UsbDevice device) {
    device_ = std::move(device);
    for (Transfer& t : inputs_) t.usb = libusb_alloc_transfer(0);
    output_.usb = libusb_alloc_transfer(0);
    lost_ = halted_in_ = halted_out_ = false;
    errors_ = 0;
    sender_ = &station_.open("USB device " + to_string(id_));
}

// Waits until libusb has returned every transfer; only then may the device be closed.
void UsbCommandReceiver::close_device() {
    const auto busy = [&] {
        bool any = output_.in_flight;
        for (const Transfer& t : inputs_) any = any || t.in_flight;
        return any;
    };
    closing_ = true;
    for (Transfer& t : inputs_)
        if (t.in_flight) libusb_cancel_transfer(t.usb);
    if (output_.in_flight) libusb_cancel_transfer(output_.usb);
    while (busy()) handle_events(10);
    for (Transfer& t : inputs_) libusb_free_transfer(std::exchange(t.usb, nullptr));
    libusb_free_transfer(std::exchange(output_.usb, nullptr));
    closing_ = false;
    const CommandStation::Answer nobody = [](std::span<const std::uint8_t>) {};
    station_.take_all(stream_, monotonic_ns(), *sender_, nobody);
    station_.close(*sender_);
    sender_ = nullptr;
    answers_.clear();
    device_ = {};
    lost_ = false;
    next_try_ns_ = monotonic_ns() + kTryAgain_ns;
}

void UsbCommandReceiver::submit(Transfer& t) {
    if (closing_ || lost_) return;
    libusb_fill_bulk_transfer(t.usb, device_.handle.get(), device_.in, t.bytes.data(),
                              static_cast<int>(t.bytes.size()), on_input, &t, 0);
    t.in_flight = libusb_submit_transfer(t.usb) == 0;
    if (!t.in_flight) ++errors_;
}

void UsbCommandReceiver::on_input(libusb_transfer* usb) {
    auto& t = *static_cast<Transfer*>(usb->user_data);
    t.in_flight = false;
    t.owner->received(t);
}

// Takes the bytes that came, however the transfer ended.
void UsbCommandReceiver::received(Transfer& t) {
    const std::int64_t arrival_ns = monotonic_ns();
    if (t.usb->actual_length > 0 && sender_) {
        const auto size = static_cast<std::size_t>(t.usb->actual_length);
        std::copy_n(t.bytes.begin(), size, stream_.room().begin());
        stream_.filled(size);
        station_.take(stream_, arrival_ns, *sender_,
                      [&](std::span<const std::uint8_t> packet) { answers_.put(packet, false); });
    }
    switch (t.usb->status) {
        case LIBUSB_TRANSFER_COMPLETED:
        case LIBUSB_TRANSFER_TIMED_OUT:
            errors_ = 0;
            submit(t);
            break;
        case LIBUSB_TRANSFER_STALL:
            halted_in_ = true;
            ++errors_;
            break;
        case LIBUSB_TRANSFER_NO_DEVICE:
            lost_ = true;
            break;
        case LIBUSB_TRANSFER_CANCELLED:
            break;
        default:
            ++errors_;
    }
    send_answers();
}

void UsbCommandReceiver::send_answers() {
    if (!device_ || output_.in_flight || lost_ || closing_) return;
    const std::size_t size = answers_.next(output_.bytes);
    if (size == 0) return;
    libusb_fill_bulk_transfer(output_.usb, device_.handle.get(), device_.out, output_.bytes.data(),
                              static_cast<int>(size), on_output, &output_, 0);
    output_.in_flight = libusb_submit_transfer(output_.usb) == 0;
    if (!output_.in_flight) ++errors_;
}

void UsbCommandReceiver::on_output(libusb_transfer* usb) {
    auto& t = *static_cast<Transfer*>(usb->user_data);
    UsbCommandReceiver& self = *t.owner;
    t.in_flight = false;
    if (usb->status == LIBUSB_TRANSFER_COMPLETED) return self.send_answers();
    if (usb->status == LIBUSB_TRANSFER_NO_DEVICE) self.lost_ = true;
    if (usb->status == LIBUSB_TRANSFER_STALL) self.halted_out_ = true;
    ++self.errors_;
}

void UsbCommandReceiver::send_telemetry() {
    Telemetry telemetry;
    while (telemetry_.take(telemetry))
        station_.notify(telemetry, [&](CommandStation::Sender&, std::span<const std::uint8_t> packet) {
            answers_.put(packet, true);
        });
}

}  // namespace

std::unique_ptr<CommandReceiver> make_usb_receiver(const UsbCommandConfig& config, CommandHandler& handler,
                                                   FaultBoard& faults) {
    return std::make_unique<UsbCommandReceiver>(config, handler, faults);
}

}  // namespace hilcam
