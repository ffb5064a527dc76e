#pragma once
// A PTP port with masters on a simulated network: times pass as fast as they are computed.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "io/ptp/ptp_port.h"
#include "render/vocabulary/random.h"

namespace hilcam {

inline constexpr std::int64_t kSimMs = 1'000'000, kSimSecond = 1'000'000'000;

struct SimMaster {
    ptp::PortIdentity identity{0x001122FFFE334455, 1};
    ptp::Announce announce{.utc_offset_s = 37, .grandmaster = 0x001122FFFE334455};
    std::uint16_t flags = ptp::flag::kPtpTimescale | ptp::flag::kUtcOffsetValid;
    std::uint8_t domain = 0;
    std::int64_t ahead_ns = 1'700'000'000 * kSimSecond;  // of CLOCK_MONOTONIC
    bool alive = true, two_step = true, follow_up_first = false;
    std::int8_t log_sync = 0, log_announce = 1;
    std::int64_t correction_ns = 0;  // of a transparent clock on the way: added to the path and said
    std::uint16_t sequence = 0, announce_sequence = 0;

    std::int64_t time_ns(std::int64_t monotonic_ns) const { return monotonic_ns + ahead_ns; }
};

class PtpBench {
  public:
    static constexpr std::int64_t kDelay_ns = 20'000;
    static constexpr std::uint64_t kOwn = 0x020000FFFE000001;

    explicit PtpBench(const OscillatorConfig& oscillator = {}, std::int64_t begin_ns = 0)
        : clock(oscillator, {kBegin_ns, begin_ns, 0}),
          port({{kOwn, 1}, 0}, clock, [this](const PtpNote& note) { notes.push_back(note); }) {
        port.initialize();
        port.listen(now_ns);
    }

    // Masters begin to send when they are added; their addresses stay.
    SimMaster& add(const SimMaster& master) {
        SimMaster* const m = masters_.emplace_back(std::make_unique<SimMaster>(master)).get();
        at(now_ns + 100 * kSimMs, [this, m] { send_announce(*m); });
        at(now_ns + 130 * kSimMs, [this, m] { send_sync(*m); });
        return *m;
    }
    void run(double seconds) {
        const std::int64_t end_ns = now_ns + std::llround(seconds * 1e9);
        while (true) {
            const std::int64_t event_ns = events_.empty() ? end_ns : events_.begin()->first;
            const std::int64_t next_ns = std::max(now_ns, std::min({event_ns, port.wake_ns(), end_ns}));
            now_ns = next_ns;
            if (!events_.empty() && event_ns <= now_ns) {
                const auto act = std::move(events_.begin()->second);
                events_.erase(events_.begin());
                act();
            }
            tick();
            if (now_ns >= end_ns && (events_.empty() || events_.begin()->first > end_ns)) return;
        }
    }
    // The errors of the device's clock, every 50 ms, sorted by size.
    std::vector<std::int64_t> errors(const SimMaster& master, double seconds) {
        std::vector<std::int64_t> out;
        for (int i = 0; i < std::lround(seconds * 20); ++i) {
            run(0.05);
            out.push_back(std::abs(error_ns(master)));
        }
        std::sort(out.begin(), out.end());
        return out;
    }
    std::int64_t error_ns(const SimMaster& master) const {
        return clock.device_ns(now_ns) - master.time_ns(now_ns);
    }
    PtpState state() const { return port.data_set().state; }
    int count(PtpNote::Kind kind) const {
        return static_cast<int>(
            std::count_if(notes.begin(), notes.end(), [&](const PtpNote& n) { return n.kind == kind; }));
    }
    void give(const ptp::Message& m, std::optional<std::int64_t> arrival_ns = {}) {
        std::array<std::uint8_t, ptp::kMaxMessageBytes> bytes{};
        const std::size_t size = ptp::write_message(m, bytes);
        port.receive(std::span(bytes).first(size), arrival_ns, now_ns);
    }
    static ptp::Message message(const SimMaster& m, ptp::MessageType type) {
        ptp::Message out;
        out.type = type;
        out.domain = m.domain;
        out.source = m.identity;
        return out;
    }

    static constexpr std::int64_t kBegin_ns = 1000 * kSimSecond;
    std::int64_t now_ns = kBegin_ns;
    DeviceClock clock;
    std::vector<PtpNote> notes;
    PtpPort port;
    double jitter_ns = 0;   // sigma of what a packet waits on its way; never negative
    double lost_syncs = 0;  // share
    int requests = 0;
    std::function<std::int64_t()> late;  // added to a Sync's way, if set

  private:
    void at(std::int64_t when_ns, std::function<void()> act) { events_.emplace(when_ns, std::move(act)); }
    double uniform() {
        return static_cast<double>(uniform01(random_words({7, 0}, RandomPurpose::kFault, ++draws_)[0]));
    }
    std::int64_t way_ns() {
        const double normal = std::sqrt(-2 * std::log(uniform())) * std::cos(6.283185307 * uniform());
        return kDelay_ns + std::llround(jitter_ns * std::abs(normal));
    }
    void tick() {
        std::array<std::uint8_t, ptp::kMaxMessageBytes> out{};
        const std::size_t size = port.tick(now_ns, out);
        if (size == 0) return;
        ++requests;
        const auto request = ptp::read_message(std::span(out).first(size));
        const std::int64_t left_ns = now_ns + 5'000;
        at(left_ns + 1, [this, left_ns] { port.sent(left_ns); });
        for (const auto& m : masters_) {
            if (!m->alive || m->domain != request->domain) continue;
            const std::int64_t came_ns = left_ns + way_ns() + m->correction_ns;
            ptp::Message response = message(*m, ptp::MessageType::kDelayResp);
            response.time_ns = m->time_ns(came_ns);
            response.correction_scaled_ns = m->correction_ns * 65536;
            response.requester = request->source;
            response.sequence = request->sequence;
            at(came_ns + 200'000, [this, response] { give(response); });
        }
    }
    void send_announce(SimMaster& m) {
        if (m.alive) {
            ptp::Message out = message(m, ptp::MessageType::kAnnounce);
            out.flags = m.flags;
            out.announce = m.announce;
            out.log_interval = m.log_announce;
            out.sequence = m.announce_sequence++;
            give(out);
        }
        at(now_ns + std::llround(std::exp2(m.log_announce) * 1e9), [this, &m] { send_announce(m); });
    }
    void send_sync(SimMaster& m) {
        const bool lost = uniform() < lost_syncs;
        if (m.alive && !lost) {
            ptp::Message sync = message(m, ptp::MessageType::kSync), follow = sync;
            sync.flags = m.two_step ? ptp::flag::kTwoStep : std::uint16_t{0};
            sync.sequence = m.sequence;
            sync.log_interval = m.log_sync;
            sync.correction_scaled_ns = m.correction_ns * 65536;
            sync.time_ns = m.two_step ? 0 : m.time_ns(now_ns);
            follow.type = ptp::MessageType::kFollowUp;
            follow.sequence = m.sequence;
            follow.time_ns = m.time_ns(now_ns);
            const std::int64_t came_ns = now_ns + way_ns() + m.correction_ns + (late ? late() : 0);
            at(came_ns + (m.follow_up_first ? 900'000 : 10'000),
               [this, sync, came_ns] { give(sync, came_ns); });
            if (m.two_step) at(came_ns + 500'000, [this, follow] { give(follow); });
        }
        ++m.sequence;
        at(now_ns + std::llround(std::exp2(m.log_sync) * 1e9), [this, &m] { send_sync(m); });
    }

    std::vector<std::unique_ptr<SimMaster>> masters_;
    std::multimap<std::int64_t, std::function<void()>> events_;
    std::uint32_t draws_ = 0;
};

}  // namespace hilcam
