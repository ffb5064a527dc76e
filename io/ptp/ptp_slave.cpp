#include "io/ptp/ptp_slave.h"

#include <algorithm>
#include <array>
#include <utility>

#include "io/system/monotonic.h"
#include "io/system/urgent_thread.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr std::size_t kMostLines = 256;

}  // namespace

PtpSlave::PtpSlave(const NetInterface& net, const Config& config, DeviceClock& clock,
                   std::function<bool()> link_is_up)
    : config_(config),
      link_is_up_(std::move(link_is_up)),
      port_({{ptp::identity_of_mac(net.mac), 1}, config.domain}, clock,
            [this](const PtpNote& note) { say(text_of(note), is_warning(note)); }),
      data_set_(port_.data_set()),
      net_(net) {}

void PtpSlave::start() {
    stopping_.store(false);
    thread_ = std::thread([this] { serve(); });
}

void PtpSlave::stop() noexcept {
    if (!thread_.joinable()) return;
    stopping_.store(true);
    wake(wakeup_);
    thread_.join();
    sockets_.reset();
}

void PtpSlave::enable(bool enabled) {
    {
        const std::lock_guard lock(orders_);
        wanted_ = enabled;
        if (!enabled) off_ns_ = monotonic_ns() + kOffPatience_ns;
    }
    wake(wakeup_);
}

void PtpSlave::move(const NetInterface& net) {
    {
        const std::lock_guard lock(orders_);
        net_ = net;
        moved_ = true;
    }
    wake(wakeup_);
}

void PtpSlave::say(const std::string& text, bool warning) {
    const std::lock_guard lock(orders_);
    if (lines_.size() < kMostLines) lines_.push_back({text, warning});
}

std::vector<PtpSlave::Line> PtpSlave::take_lines() {
    const std::lock_guard lock(orders_);
    return std::exchange(lines_, {});
}

void PtpSlave::serve() {
    make_thread_urgent();
    std::array<std::uint8_t, ptp::kMaxMessageBytes> out{};
    while (!stopping_.load()) {
        const std::int64_t now_ns = monotonic_ns();
        follow_orders(now_ns);
        if (waits_for_stamp_ && now_ns - send_ns_ > kStampWait_ns) give_up_stamp();
        const std::size_t size = port_.tick(now_ns, out);
        if (size > 0) send_request(std::span(out).first(size));
        data_set_.write(port_.data_set());
        std::int64_t wake_ns = std::min(port_.wake_ns(), now_ns + kLongestSleep_ns);
        if (waits_for_stamp_) wake_ns = std::min(wake_ns, send_ns_ + kStampWait_ns + 1'000'000);
        const std::int64_t timeout_ns = wake_ns - monotonic_ns();
        if (sockets_) {
            sockets_->wait(wakeup_, timeout_ns);
            take_messages();
        } else {
            pollfd watched{wakeup_.get(), POLLIN, 0};
            poll(&watched, 1, static_cast<int>(std::clamp<std::int64_t>(timeout_ns / 1'000'000, 1, 500)));
            if (watched.revents) drain(wakeup_);
        }
    }
}

void PtpSlave::follow_orders(std::int64_t now_ns) {
    bool wanted = false, moved = false;
    {
        const std::lock_guard lock(orders_);
        wanted = wanted_ || (enabled_ && now_ns < off_ns_);
        moved = std::exchange(moved_, false);
    }
    if (moved && sockets_) {
        sockets_.reset();
        retry_ns_ = 0;
    }
    if (!wanted && enabled_) {
        sockets_.reset();
        port_.disable(now_ns);
    }
    if (wanted && !enabled_) {
        port_.initialize();
        retry_ns_ = 0;
        said_.clear();
    }
    enabled_ = wanted;
    if (enabled_ && !sockets_ && now_ns >= retry_ns_) open(now_ns);
}

void PtpSlave::open(std::int64_t now_ns) {
    NetInterface net;
    {
        const std::lock_guard lock(orders_);
        net = net_;
    }
    waits_for_stamp_ = false;
    try {
        sockets_ = std::make_unique<PtpSockets>(net, config_.transport);
        port_.listen(now_ns);
    } catch (const DeviceError& error) {
        retry_ns_ = now_ns + kRetry_ns;
        port_.fail();
        if (said_ != error.what()) say(error.what(), true);
        said_ = error.what();
    }
}

void PtpSlave::take_messages() {
    const bool up = !link_is_up_ || link_is_up_();
    const std::int64_t now_ns = monotonic_ns();
    sockets_->take({.received =
                        [&](std::span<const std::uint8_t> bytes, std::optional<std::int64_t> arrival_ns) {
                            if (up) port_.receive(bytes, arrival_ns, std::max(now_ns, monotonic_ns()));
                        },
                    .sent =
                        [&](std::int64_t departure_ns) {
                            waits_for_stamp_ = false;
                            stamps_missing_ = 0;
                            port_.sent(departure_ns);
                        }});
}

void PtpSlave::send_request(std::span<const std::uint8_t> message) {
    if (link_is_up_ && !link_is_up_()) return;
    send_ns_ = monotonic_ns();
    if (!sockets_ || !sockets_->send(message)) return;
    // An interface that has given no stamps for a while will give none.
    if (stamps_missing_ >= kStampTries)
        port_.sent(send_ns_);
    else
        waits_for_stamp_ = true;
}

void PtpSlave::give_up_stamp() {
    waits_for_stamp_ = false;
    if (++stamps_missing_ == kStampTries) say(text_of({.kind = PtpNote::Kind::kNoTransmitStamps}), true);
}

}  // namespace hilcam
