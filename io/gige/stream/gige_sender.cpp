#include "io/gige/stream/gige_sender.h"

#include <netinet/ip.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/time.h>

#include <algorithm>
#include <limits>

#include "io/system/monotonic.h"
#include "io/system/urgent_thread.h"

namespace hilcam {
namespace {

// A batch fills at most a third of a client's default receive buffer.
constexpr std::size_t kBatchRoom = 70'000;
// A frame with time to spare is spread, but not more slowly than gigabit Ethernet would carry it.
constexpr double kGigabit_bytes_s = 125e6;
constexpr std::int64_t kCatchUpSeen_ns = 50'000'000;
// Share of the stream's rate for resent packets while a frame is being sent. A stream that loses p needs p /
// (1 - p) of its packets again: a quarter of them at 20 %. It is twice that, because a client that waits too
// long asks again.
constexpr double kResendShare = 0.5;
// Refusals: a thousand a second, a hundred at once. A client that asks for more has had its answer.
constexpr Pace kRefusalPace{.delay_ns = 1'000'000, .catch_up_ns = 100'000'000};
constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

sockaddr_in address_of(const Endpoint& e) { return socket_address(e.ip, e.port); }

}  // namespace

GigeSender::GigeSender(GigeRing& ring, FaultBoard& faults, DeliveryListener* listener,
                       const GigePaceConfig& pace, std::function<void(std::uint64_t)> finished)
    : ring_(ring),
      faults_(faults),
      listener_(listener),
      pace_config_(pace),
      finished_(std::move(finished)),
      wakeup_(open_wakeup()) {
    delayed_.reserve(kMaxDelayed);
    refusal_pacer_.begin(kRefusalPace, 0);
}

void GigeSender::open(std::uint32_t address) {
    Fd fresh = open_udp(address, 0);
    // A full network card must not block the thread for good.
    const timeval patience{0, 100'000};
    setsockopt(fresh.get(), SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    // Multicast streams stay on the local link, and receivers on this machine get them, too.
    const int one = 1;
    const in_addr own{htonl(address)};
    setsockopt(fresh.get(), IPPROTO_IP, IP_MULTICAST_TTL, &one, sizeof one);
    setsockopt(fresh.get(), IPPROTO_IP, IP_MULTICAST_LOOP, &one, sizeof one);
    setsockopt(fresh.get(), IPPROTO_IP, IP_MULTICAST_IF, &own, sizeof own);
    next_socket_ = std::move(fresh);
    socklen_t size = sizeof next_address_;
    getsockname(next_socket_.get(), reinterpret_cast<sockaddr*>(&next_address_), &size);
}

void GigeSender::start() {
    if (next_socket_) {
        socket_ = std::move(next_socket_), address_ = next_address_;
        do_not_fragment_ = true;
        set_do_not_fragment(false);
    }
    stopping_.store(false);
    thread_ = std::thread([this] { run(); });
}

void GigeSender::close() noexcept {
    if (thread_.joinable()) {
        stopping_.store(true);
        wake(wakeup_);
        thread_.join();
    }
    socket_.reset();
}

bool GigeSender::order(const GigeOrder& order) noexcept {
    const bool taken = orders_.push(order);
    if (!taken) counts_.requests_unanswered.fetch_add(1, std::memory_order_relaxed);
    wake(wakeup_);
    return taken;
}

void GigeSender::run() {
    // By default the kernel lets sleeps overrun by 50 us; pacing is finer.
    prctl(PR_SET_TIMERSLACK, 1000);
    make_thread_urgent();
    while (!stopping_.load(std::memory_order_relaxed)) {
        const bool busy = serve_orders();
        take_frame();
        if (next_ && (next_begin_ns_ <= monotonic_ns() || !wanted(*next_))) {
            send_frame(*next_);
            ring_.done(*next_);
            next_ = nullptr;
        } else if (!busy) {
            sleep_until(next_ ? std::min(next_begin_ns_, next_due_ns()) : next_due_ns());
        }
    }
}

// --- frames

bool GigeSender::wanted(const GigeSlot& slot) {
    const GigeStreamNow& now = stream_.read();
    return now.state.open && now.acquisition == slot.acquisition;
}

bool GigeSender::receiver_seen(const GigeSlot& slot) const {
    return room_.free_bytes(address_, address_of(slot.frame.stream.destination)).has_value();
}

void GigeSender::take_frame() {
    const std::int64_t now_ns = monotonic_ns();
    if (!next_) {
        next_ = ring_.next();
        if (!next_) return;
        next_->resent = 0;
        next_begin_ns_ = now_ns;
        if (pace_config_.space_late_frames && !receiver_seen(*next_)) {
            const double hz = frame_rate_hz_.load(std::memory_order_relaxed);
            next_begin_ns_ = spacing_.earliest_ns(next_->record.exposure_mid_monotonic_ns,
                                                  hz > 0 ? static_cast<std::int64_t>(1e9 / hz) : 0, now_ns);
        }
        if (next_begin_ns_ > now_ns) counts_.frames_spaced.fetch_add(1, std::memory_order_relaxed);
    }
    if (next_begin_ns_ > now_ns) give_up_late_frames();
}

// Gives up a waiting frame when there are newer ones, and the next one takes its turn. An acquisition's last
// frame has none behind it.
void GigeSender::give_up_late_frames() {
    while (ring_.queued() > FrameSpacing::kMaxQueued && wanted(*next_)) {
        counts_.frames_given_up.add(next_->record.id);
        ring_.done(*next_);
        next_ = ring_.next();
        next_->resent = 0;
    }
}

void GigeSender::send_frame(GigeSlot& slot) {
    const GigeStreamState& s = slot.frame.stream;
    const std::uint64_t packets = std::uint64_t{trailer_id(s)} + 1;
    if (history_of_ != slot.acquisition) {
        history_.restart(s.long_ids()), history_of_ = slot.acquisition;
        budget_.restart(packets);
    }
    history_.sent(slot.frame.block);
    budget_.earn(packets);
    spacing_.begun(slot.record.exposure_mid_monotonic_ns, monotonic_ns());
    set_do_not_fragment(s.do_not_fragment);
    current_ = &slot;
    std::int64_t first_ns = 0, last_ns = 0;
    pacer_.begin(pace_of(slot), monotonic_ns());
    PacketOrder order(trailer_id(s));
    bool whole = true;
    while (!order.done()) {
        whole = wanted(slot) && !stopping_.load(std::memory_order_relaxed);
        if (!whole) break;
        batch_.begin(address_of(s.destination));
        fill_batch(slot, order);
        if (first_ns == 0) first_ns = monotonic_ns();
        counts_.packets.fetch_add(batch_.count(), std::memory_order_relaxed);
        transmit(slot.record.id, s.packet_bytes, pacer_);
        last_ns = monotonic_ns();
        if (!order.done()) pause_until(pacer_.ready_ns());
    }
    current_ = nullptr;
    if (whole) {
        counts_.frames.fetch_add(1, std::memory_order_relaxed);
        if (listener_) listener_->delivered(slot.record, first_ns, last_ns);
    }
    if (slot.last) finished_(slot.acquisition);
}

void GigeSender::fill_batch(const GigeSlot& slot, PacketOrder& order) {
    const GigeStreamState& s = slot.frame.stream;
    const std::uint32_t trailer = trailer_id(s);
    const std::size_t max_bytes =
        std::min(pacer_.batch_bytes(), kBatchRoom / ReceiverRoom::bytes_of(s.packet_bytes) * s.packet_bytes);
    // One place stays free for a duplicate.
    for (std::size_t taken = 0; !order.done() && batch_.count() + 1 < PacketBatch::kMaxPackets;) {
        const std::uint32_t id = order.next(faults_, slot.record.id);
        const PacketFate fate = fate_of_packet(faults_, slot.record.id, id, trailer);
        const GigePacket packet = packet_of(slot.frame, id, gvsp::kFresh);
        if (fate.lost)
            counts_.packets_dropped.fetch_add(1, std::memory_order_relaxed);
        else if (fate.delay_ns)
            delay(slot, id, gvsp::kFresh, fate, batch_.to());
        else
            batch_.add(packet, fate, s.long_ids());
        if (fate.twice) batch_.add(packet, fate, s.long_ids());
        taken += packet.bytes() + 28;
        if (taken + s.packet_bytes > max_bytes) break;
    }
}

void GigeSender::transmit(std::uint64_t frame, std::uint32_t packet_bytes, Pacer& pacer, bool wait) {
    if (batch_.count() > 0) {
        if (wait)
            room_.wait(address_, batch_.to(), batch_.count() * ReceiverRoom::bytes_of(packet_bytes),
                       stopping_);
        const std::size_t failed = batch_.send(socket_.get());
        if (frame != 0) counts_.packets_failed.add(frame, failed);
        counts_.bytes.fetch_add(batch_.bytes(), std::memory_order_relaxed);
    }
    pacer.sent(batch_.count(), batch_.bytes(), monotonic_ns());
}

void GigeSender::set_do_not_fragment(bool on) {
    if (on == do_not_fragment_) return;
    do_not_fragment_ = on;
    // PROBE: ignores what was learned of the path's MTU; packets longer than the interface's own are refused.
    const int discover = on ? IP_PMTUDISC_PROBE : IP_PMTUDISC_DONT;
    setsockopt(socket_.get(), IPPROTO_IP, IP_MTU_DISCOVER, &discover, sizeof discover);
}

Pace GigeSender::pace_of(const GigeSlot& slot) {
    const GigeStreamState& s = slot.frame.stream;
    const double asked = s.throughput_limit_bytes_s;
    double rate = asked > 0 ? asked : pace_config_.rate_bytes_s;
    const double hz = frame_rate_hz_.load(std::memory_order_relaxed);
    // When the client sets a delay or a limit, that is the pace; else a frame takes the time it has.
    if (asked <= 0 && s.packet_delay_ns == 0 && pace_config_.spread_fraction > 0) {
        const double bytes = static_cast<double>(trailer_id(s)) * s.packet_bytes;
        rate = std::min(rate, std::max(kGigabit_bytes_s, bytes * hz / pace_config_.spread_fraction));
    }
    if (const auto cap_mb_s = faults_.strikes(FaultKind::kBandwidthCap, slot.record.id))
        rate = std::min(rate, *cap_mb_s * 1e6);
    // A receiver with an observable buffer is not overrun by a sender that catches up.
    return {rate, s.packet_delay_ns, receiver_seen(slot) ? kCatchUpSeen_ns : Pace{}.catch_up_ns};
}

// --- requests

bool GigeSender::serve_orders() {
    const std::int64_t now_ns = monotonic_ns();
    serve_delayed(now_ns);
    if (!resend_) {
        GigeOrder order;
        if (!orders_.pop(order)) return false;
        if (order.kind == GigeOrder::Kind::kTestPacket) {
            send_test_packet(order);
            return true;
        }
        counts_.resend_requests.fetch_add(1, std::memory_order_relaxed);
        resend_ = order;
    }
    if (resend_pacer_.ready_ns() - now_ns >= Pacer::kShortestSleep_ns) return false;
    serve_resend();
    return true;
}

// Sends one batch of the packets that resend_ asks for.
void GigeSender::serve_resend() {
    GigeOrder& r = *resend_;
    std::uint64_t oldest = 0;
    GigeSlot* const slot = borrow(r.acquisition, r.block, oldest);
    batch_.begin(address_of(r.to));
    if (!slot)
        return refuse(
            history_of_ == r.acquisition ? history_.why_missing(r.block, oldest) : gvsp::kUnavailable,
            r.last);
    const std::uint32_t trailer = trailer_id(slot->frame.stream);
    const std::uint32_t end = std::min(r.last, trailer);
    const std::uint64_t max_resent =
        std::min(kMaxResent * (std::uint64_t{trailer} + 1), slot->resent + budget_.left());
    const bool past_the_end = r.next > end, too_often = slot->resent >= max_resent;
    if (!past_the_end && !too_often) resend_batch(*slot, end, max_resent);
    give_back(slot);
    if (past_the_end) return refuse(gvsp::kUnavailable, r.last);
    if (too_often) {
        counts_.packets_over_limit.fetch_add(end - r.next + 1, std::memory_order_relaxed);
        return refuse(gvsp::kUnavailable, end);
    }
    if (r.next > end) resend_.reset();
}

void GigeSender::resend_batch(GigeSlot& slot, std::uint32_t end, std::uint64_t max_resent) {
    GigeOrder& r = *resend_;
    Pace pace = pacer_.pace();
    if (current_) {
        pace.bytes_s *= kResendShare;
        pace.delay_ns = static_cast<std::int64_t>(static_cast<double>(pace.delay_ns) / kResendShare);
    }
    resend_pacer_.begin(pace, monotonic_ns());
    const std::size_t max_bytes = std::min(
        resend_pacer_.batch_bytes(), kBatchRoom / ReceiverRoom::bytes_of(r.packet_bytes) * r.packet_bytes);
    std::uint64_t resent = 0, refused = 0;
    do {
        const std::uint32_t id = r.next++;
        const PacketFate fate = fate_of_resend(faults_, slot.record.id, id);
        if (fate.lost)
            batch_.add(refusal_of(r.extended_ids, r.block, id, gvsp::kUnavailable), {}, r.extended_ids);
        else if (fate.delay_ns)
            delay(slot, id, gvsp::kResent, fate, batch_.to());
        else
            batch_.add(packet_of(slot.frame, id, gvsp::kResent), fate, r.extended_ids);
        ++(fate.lost ? refused : resent);
        ++slot.resent;
    } while (r.next <= end && slot.resent < max_resent && !batch_.full() &&
             batch_.bytes() + r.packet_bytes <= max_bytes);
    budget_.spend(resent + refused);
    counts_.packets_resent.fetch_add(resent, std::memory_order_relaxed);
    counts_.packets_refused.fetch_add(refused, std::memory_order_relaxed);
    // The stream waits only for its own receiver; another requester has to read its buffer in time.
    transmit(slot.record.id, r.packet_bytes, resend_pacer_, r.to == slot.frame.stream.destination);
}

// Refuses what resend_ asks for, up to `last`. Only its first packets get the answer, because clients then
// give up the block.
void GigeSender::refuse(gvsp::Status reason, std::uint32_t last) {
    const GigeOrder& r = *resend_;
    counts_.packets_refused.fetch_add(std::uint64_t{last} - r.next + 1, std::memory_order_relaxed);
    if (refusal_pacer_.ready_ns() <= monotonic_ns()) {
        for (std::uint32_t id = r.next; id <= last && id - r.next < 8; ++id)
            batch_.add(refusal_of(r.extended_ids, r.block, id, reason), {}, r.extended_ids);
        transmit(0, r.packet_bytes, refusal_pacer_, false);
    } else {
        counts_.requests_unanswered.fetch_add(1, std::memory_order_relaxed);
    }
    resend_.reset();
}

void GigeSender::send_test_packet(const GigeOrder& order) {
    if (faults_.strikes(FaultKind::kLinkDown, 0)) return;
    static constexpr std::array<std::uint8_t, 65535> kZeros{};
    set_do_not_fragment(order.do_not_fragment);
    const sockaddr_in to = address_of(order.to);
    const std::size_t bytes = order.packet_bytes - std::min<std::size_t>(order.packet_bytes, 28);
    if (sendto(socket_.get(), kZeros.data(), std::min(bytes, kZeros.size()), 0,
               reinterpret_cast<const sockaddr*>(&to), sizeof to) >= 0)
        counts_.test_packets.fetch_add(1, std::memory_order_relaxed);
    else
        counts_.test_packets_failed.fetch_add(1, std::memory_order_relaxed);
}

GigeSlot* GigeSender::borrow(std::uint64_t acquisition, std::uint64_t block, std::uint64_t& oldest) {
    if (current_ && current_->acquisition == acquisition && current_->frame.block == block) return current_;
    return ring_.find(acquisition, block, oldest);
}
void GigeSender::give_back(GigeSlot* slot) {
    if (slot != current_) ring_.keep(*slot);
}

// --- delayed packets

void GigeSender::delay(const GigeSlot& slot, std::uint32_t id, gvsp::Status status, const PacketFate& fate,
                       const sockaddr_in& to) {
    if (delayed_.size() == kMaxDelayed) {
        counts_.packets_dropped.fetch_add(1, std::memory_order_relaxed);
        return;
    }
    delayed_.push_back(
        {monotonic_ns() + *fate.delay_ns, slot.acquisition, slot.frame.block, id, status, fate.id_error, to});
}

std::int64_t GigeSender::next_due_ns() const {
    std::int64_t due_ns = resend_ ? resend_pacer_.ready_ns() : kNever;
    for (const Delayed& d : delayed_) due_ns = std::min(due_ns, d.due_ns);
    return due_ns;
}

void GigeSender::serve_delayed(std::int64_t now_ns) {
    for (std::size_t i = 0; i < delayed_.size();) {
        const Delayed d = delayed_[i];
        if (d.due_ns > now_ns) {
            ++i;
            continue;
        }
        delayed_.erase(delayed_.begin() + static_cast<std::ptrdiff_t>(i));
        std::uint64_t oldest = 0;
        GigeSlot* const slot = borrow(d.acquisition, d.block, oldest);
        if (!slot) {  // older than the ring's frames: lost
            counts_.packets_dropped.fetch_add(1, std::memory_order_relaxed);
            continue;
        }
        PacketFate fate;
        fate.id_error = d.id_error;
        const GigeStreamState& s = slot->frame.stream;
        batch_.begin(d.to);
        batch_.add(packet_of(slot->frame, d.id, d.status), fate, s.long_ids());
        const bool fresh = d.status == gvsp::kFresh;
        if (fresh) counts_.packets.fetch_add(1, std::memory_order_relaxed);
        transmit(slot->record.id, s.packet_bytes, fresh ? pacer_ : resend_pacer_);
        give_back(slot);
    }
}

// --- waiting

void GigeSender::pause_until(std::int64_t due_ns) {
    while (!stopping_.load(std::memory_order_relaxed)) {
        if (due_ns - monotonic_ns() < Pacer::kShortestSleep_ns) return;
        if (serve_orders()) continue;
        sleep_until(std::min(due_ns, next_due_ns()));
    }
}

// Sleeps until then, or until there is an order.
void GigeSender::sleep_until(std::int64_t due_ns) {
    pollfd watched{wakeup_.get(), POLLIN, 0};
    const std::int64_t left_ns = std::max<std::int64_t>(0, due_ns - monotonic_ns());
    const timespec left{static_cast<time_t>(left_ns / 1'000'000'000),
                        static_cast<long>(left_ns % 1'000'000'000)};
    if (ppoll(&watched, 1, due_ns == kNever ? nullptr : &left, nullptr) <= 0) return;
    std::uint64_t count = 0;
    [[maybe_unused]] const auto got = ::read(wakeup_.get(), &count, sizeof count);
}

}  // namespace hilcam
