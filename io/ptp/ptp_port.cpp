#include "io/ptp/ptp_port.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "render/vocabulary/random.h"

namespace hilcam {
namespace {

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
// TAI - UTC is 37 s since 2017-01-01 (IERS Bulletin C 52, 2016); no negative leap second was ever ordered.
constexpr std::int16_t kUtcOffset_s = 37;
// An older Sync says little about when a request leaves.
constexpr std::int64_t kOldSync_ns = 5'000'000'000;
constexpr std::int64_t kLongestDelay_ns = 500'000'000;

std::int64_t correction_ns_of(const ptp::Message& m) { return m.correction_scaled_ns / 65536; }

// 0x7F stands for "not said" (table 24).
double interval_s_of(std::int8_t log_interval) {
    return log_interval == 0x7F ? 1 : std::exp2(std::clamp<int>(log_interval, -7, 4));
}

}  // namespace

PtpPort::PtpPort(const Config& config, DeviceClock& clock, std::function<void(const PtpNote&)> note)
    : config_(config),
      clock_(clock),
      note_(std::move(note)),
      masters_(config.identity.clock),
      servo_(clock) {}

void PtpPort::set_state(PtpState state) {
    if (state == state_) return;
    const PtpState before = state_;
    state_ = state;
    tell({.kind = PtpNote::Kind::kState, .state = state, .before = before, .master = master_.sender.clock});
}

void PtpPort::initialize() { set_state(PtpState::kInitializing); }

void PtpPort::listen(std::int64_t now_ns) {
    masters_.clear();
    servo_.tick(now_ns);
    set_state(PtpState::kListening);
}

void PtpPort::fail() { set_state(PtpState::kFaulty); }

void PtpPort::disable(std::int64_t now_ns) {
    masters_.clear();
    servo_.reset(now_ns);
    scale_known_ = false;
    set_state(PtpState::kDisabled);
}

void PtpPort::receive(std::span<const std::uint8_t> bytes, std::optional<std::int64_t> arrival_ns,
                      std::int64_t now_ns) {
    if (!is_running()) return;
    const auto m = ptp::read_message(bytes);
    if (!m || m->domain != config_.domain || m->source.clock == config_.identity.clock) return;
    if (m->type == ptp::MessageType::kAnnounce) {
        masters_.take(*m, now_ns);
        choose_master(now_ns);
    } else if (has_master() && m->source == master_.sender) {
        if (m->type == ptp::MessageType::kSync) sync(*m, arrival_ns, now_ns);
        if (m->type == ptp::MessageType::kFollowUp) follow_up(*m, now_ns);
        if (m->type == ptp::MessageType::kDelayResp) delay_response(*m);
    }
}

// --- the master

void PtpPort::choose_master(std::int64_t now_ns) {
    masters_.expire(now_ns);
    const ForeignMaster* const best = masters_.best();
    if (!best) {
        if (has_master()) set_state(PtpState::kListening);
        return;
    }
    const bool other = !has_master() || best->sender != master_.sender;
    const bool other_words = other || best->flags != master_.flags ||
                             best->announce.grandmaster != master_.announce.grandmaster ||
                             best->announce.utc_offset_s != master_.announce.utc_offset_s;
    master_ = *best;
    if (other) take_over(*best);
    if (other_words) say_scale();
}

void PtpPort::take_over(const ForeignMaster& master) {
    delay_.clear();
    servo_.change_master();
    sync_.reset();
    follow_up_.reset();
    done_.reset();
    last_.reset();
    request_open_ = false;
    log_request_interval_ = 0;
    tell({.kind = PtpNote::Kind::kMaster, .master = master.sender.clock});
    set_state(PtpState::kUncalibrated);
}

void PtpPort::say_scale() {
    const ptp::Announce& a = master_.announce;
    const bool tai = (master_.flags & ptp::flag::kPtpTimescale) != 0;
    const bool valid = (master_.flags & ptp::flag::kUtcOffsetValid) != 0;
    if (!tai)
        tell({.kind = PtpNote::Kind::kArbitraryScale, .master = master_.sender.clock});
    else if (!valid || a.utc_offset_s < kUtcOffset_s)
        tell({.kind = PtpNote::Kind::kUtcOffset,
              .master = master_.sender.clock,
              .value = a.utc_offset_s,
              .valid = valid});
}

// --- Sync

void PtpPort::sync(const ptp::Message& m, std::optional<std::int64_t> arrival_ns, std::int64_t now_ns) {
    if (!arrival_ns || done_ == m.sequence) return;
    const Step step{m.sequence, correction_ns_of(m), m.time_ns, *arrival_ns, interval_s_of(m.log_interval)};
    if (!m.has(ptp::flag::kTwoStep)) {
        complete(step, m.time_ns + step.correction_ns, now_ns);
    } else if (follow_up_ && follow_up_->sequence == m.sequence) {
        complete(step, follow_up_->time_ns + follow_up_->correction_ns + step.correction_ns, now_ns);
    } else {
        sync_ = step;
    }
}

void PtpPort::follow_up(const ptp::Message& m, std::int64_t now_ns) {
    if (done_ == m.sequence) return;
    // It comes on another socket than its Sync, and may be read first.
    follow_up_ = {m.sequence, correction_ns_of(m), m.time_ns, 0, 1};
    if (sync_ && sync_->sequence == m.sequence)
        complete(*sync_, m.time_ns + follow_up_->correction_ns + sync_->correction_ns, now_ns);
}

void PtpPort::complete(const Step& step, std::int64_t origin_ns, std::int64_t now_ns) {
    done_ = step.sequence;
    sync_.reset();
    follow_up_.reset();
    last_ = {origin_ns, step.arrival_ns, step.interval_s};
    if (!delay_.known()) {
        // The first request need not wait: nothing else can begin before it is answered.
        if (!request_open_) request_at_ns_ = now_ns;
        return;
    }
    servo_.take(now_ns, *last_, delay_);
    if (servo_.steps() != steps_told_) {
        steps_told_ = servo_.steps();
        scale_known_ = true;
        tell({.kind = PtpNote::Kind::kStep, .value = servo_.last_step_ns()});
    }
    set_state(servo_.locked() ? PtpState::kSlave : PtpState::kUncalibrated);
    scale_known_ = scale_known_ || servo_.locked();
    if (scale_known_)
        scale_ = (master_.flags & ptp::flag::kPtpTimescale) != 0 ? TimeScale::kTai : TimeScale::kArbitrary;
}

// --- path delay

std::size_t PtpPort::request(std::int64_t now_ns, std::span<std::uint8_t> out) {
    ptp::Message m;
    m.type = ptp::MessageType::kDelayReq;
    m.domain = config_.domain;
    m.source = config_.identity;
    m.sequence = ++request_sequence_;
    m.log_interval = 0x7F;
    request_open_ = true;
    request_sync_ = *last_;
    departure_ns_.reset();
    response_ns_.reset();
    request_at_ns_ = now_ns + random_wait_ns();
    return ptp::write_message(m, out);
}

// From 0 to twice the interval, so that many slaves do not ask at once (9.5.11.2).
std::int64_t PtpPort::random_wait_ns() {
    const auto words = random_words({config_.identity.clock, 0}, RandomPurpose::kDelayRequest, ++waits_);
    const double interval_s = std::exp2(std::clamp<int>(log_request_interval_, -4, 5));
    return std::llround(2e9 * interval_s * static_cast<double>(uniform01(words[0])));
}

void PtpPort::sent(std::int64_t departure_ns) {
    if (!request_open_ || departure_ns_) return;
    departure_ns_ = departure_ns;
    complete_delay();
}

void PtpPort::delay_response(const ptp::Message& m) {
    if (!request_open_ || m.requester != config_.identity || m.sequence != request_sequence_ || response_ns_)
        return;
    response_ns_ = m.time_ns - correction_ns_of(m);
    log_request_interval_ = m.log_interval == 0x7F ? std::int8_t{0} : m.log_interval;
    complete_delay();
}

void PtpPort::complete_delay() {
    if (!departure_ns_ || !response_ns_) return;
    request_open_ = false;
    // A master that steps between its Sync and its response would make half the step a delay.
    const std::int64_t around_ns =
        (*response_ns_ - request_sync_.master_ns) - (*departure_ns_ - request_sync_.monotonic_ns);
    if (std::abs(around_ns) > 2 * kLongestDelay_ns) return;
    delay_.add({request_sync_.master_ns, request_sync_.monotonic_ns, *departure_ns_, *response_ns_});
}

// --- time

std::size_t PtpPort::tick(std::int64_t now_ns, std::span<std::uint8_t> out) {
    clock_.advance(now_ns);
    if (!is_running()) return 0;
    servo_.tick(now_ns);
    choose_master(now_ns);
    if (state_ == PtpState::kSlave && !servo_.locked()) set_state(PtpState::kUncalibrated);
    if (!has_master() || !last_ || now_ns < request_at_ns_) return 0;
    if (now_ns - last_->monotonic_ns > kOldSync_ns) {
        request_at_ns_ = now_ns + random_wait_ns();
        return 0;
    }
    return request(now_ns, out);
}

std::int64_t PtpPort::wake_ns() const {
    if (!is_running()) return kNever;
    const std::int64_t request_ns = has_master() && last_ ? request_at_ns_ : kNever;
    return std::min({masters_.wake_ns(), servo_.wake_ns(), request_ns});
}

PtpDataSet PtpPort::data_set() const {
    PtpDataSet d;
    d.state = state_;
    d.servo_locked = servo_.locked() && has_master() ? 1 : 0;
    d.clock_id = config_.identity.clock;
    if (has_master()) {
        d.parent_id = master_.sender.clock;
        d.grandmaster_id = master_.announce.grandmaster;
        d.utc_offset_s = master_.announce.utc_offset_s;
        d.utc_offset_valid = (master_.flags & ptp::flag::kUtcOffsetValid) != 0 ? 1 : 0;
    }
    d.offset_from_master_ns = servo_.offset_ns();
    d.mean_path_delay_ns = delay_.median_ns(servo_.master_rate());
    d.scale = scale_known_ ? scale_ : TimeScale::kDevice;
    d.steps = servo_.steps();
    d.rate_correction = servo_.rate_correction();
    return d;
}

}  // namespace hilcam
