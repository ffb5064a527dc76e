// CK type 5: quaternions at instants, interpolated in a window around the time.

#include <array>

#include "io/spice/ck_types.h"
#include "io/spice/quat_rate.h"
#include "io/spice/sample_window.h"
#include "render/vocabulary/node_polynomial.h"

namespace hilcam {
namespace {

// Packets of subtype 0 have a quaternion and its derivative, 1 a quaternion, 2 a quaternion, its derivative,
// the rate and its derivative, 3 a quaternion and the rate. Derivatives are per second. Then come the times
// with every hundredth, the intervals' first times with every hundredth, the seconds per tick, subtype,
// window, number of intervals, number of packets. Rates are computed from the quaternions, so that they agree
// with the attitudes shown.
class Interpolated final : public CkSegment {
  public:
    Interpolated(const CkSummary& about, std::vector<double> words)
        : CkSegment(about),
          words_(std::move(words), about.where),
          subtype_(words_.count_from_end(4, "subtype", 0, 3)),
          packet_(std::array<std::size_t, 4>{8, 4, 14, 7}[subtype_]),
          hermite_(subtype_ == 0 || subtype_ == 2),
          window_(words_.count_from_end(3, "window", 2, hermite_ ? kMaxNodes / 2 : kMaxNodes)),
          count_(words_.count_from_end(1, "packets", 1, kMaxRecords)),
          seconds_per_tick_(words_.from_end(5)),
          intervals_(read_intervals()) {
        if (!(seconds_per_tick_ > 0))
            words_.fail("seconds of a tick: found " + plain(seconds_per_tick_) + "; accepted: above 0");
        for (std::size_t i = 0; i < count_; ++i)
            if (!(norm(quaternion(i)) > 0))
                words_.fail("packet " + std::to_string(i + 1) + ": its quaternion is 0");
    }

    std::vector<TickSpan> spans() const override { return intervals_.spans(times()); }

    std::optional<CkPointing> at(double ticks, double seconds_per_tick) const override {
        const auto samples = intervals_.at(times(), ticks);
        if (!samples) return {};
        const std::size_t count = samples->end - samples->first;
        const std::size_t after = times_up_to(times(), ticks) - samples->first;
        const double to_before = ticks - times()[samples->first + after - 1];
        const bool next_is_nearer = after < count && times()[samples->first + after] - ticks < to_before;
        SampleWindow w = sample_window(after, next_is_nearer, window_, count, true);
        w.first += samples->first;
        if (w.count == 1) return CkPointing{normalized(conjugate(quaternion(w.first))), {}};
        const double first = times()[w.first], last = times()[w.first + w.count - 1];
        const double middle = 0.5 * (first + last), half = 0.5 * (last - first);
        std::array<Node<4>, kMaxNodes> nodes;
        Quat before = quaternion(w.first);
        for (std::size_t i = 0; i < w.count; ++i) {
            Node<4>& node = nodes[i];
            Quat q = quaternion(w.first + i);
            // Neighbours get the same sign, so that the interpolation goes the short way.
            const double sign =
                q.w * before.w + q.x * before.x + q.y * before.y + q.z * before.z < 0 ? -1 : 1;
            q = {sign * q.w, sign * q.x, sign * q.y, sign * q.z};
            before = q;
            node.t = (times()[w.first + i] - middle) / half;
            node.value = {q.w, q.x, q.y, q.z};
            if (!hermite_) continue;
            const auto d = words_.piece((w.first + i) * packet_ + 4, 4);
            for (std::size_t k = 0; k < 4; ++k) node.rate[k] = sign * d[k] * half * seconds_per_tick_;
        }
        const auto out = polynomial_at<4>({nodes.data(), w.count}, hermite_, (ticks - middle) / half);
        const Quat q = conjugate(Quat{out.value[0], out.value[1], out.value[2], out.value[3]});
        if (!(norm(q) > 0)) return {};
        const Quat rate = conjugate(Quat{out.rate[0], out.rate[1], out.rate[2], out.rate[3]});
        return CkPointing{normalized(q), turn_rate(q, rate) / (half * seconds_per_tick)};
    }

  private:
    SegmentWords words_;
    std::size_t subtype_, packet_;
    bool hermite_;
    std::size_t window_, count_;
    double seconds_per_tick_;
    CkIntervals intervals_;

    std::span<const double> times() const { return words_.piece(packet_ * count_, count_); }
    Quat quaternion(std::size_t i) const {
        const auto q = words_.piece(i * packet_, 4);
        return {q[0], q[1], q[2], q[3]};
    }
    CkIntervals read_intervals() const {
        const std::size_t count = words_.count_from_end(2, "intervals", 1, static_cast<double>(count_));
        const std::size_t to_starts = (packet_ + 1) * count_ + (count_ - 1) / kDirectoryStep;
        words_.require_size(to_starts + count + (count - 1) / kDirectoryStep + 5);
        words_.require_rising(packet_ * count_, count_, "time");
        return {words_, times(), words_.piece(to_starts, count)};
    }
};

}  // namespace

std::unique_ptr<CkSegment> make_ck_interpolated(const CkSummary& about, std::vector<double> words) {
    return std::make_unique<Interpolated>(about, std::move(words));
}

}  // namespace hilcam
