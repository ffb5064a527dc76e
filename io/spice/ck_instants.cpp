// CK types 1 and 3: attitudes at instants. In type 3 a structure rotates at a constant rate from one to the
// next.

#include <cmath>

#include "io/spice/ck_types.h"

namespace hilcam {
namespace {

// Records of a quaternion and, optionally, a rate in the reference frame [rad/s]; their times; every
// hundredth of these (in type 1 the middle between two). Type 3 then has the intervals' first times, every
// hundredth of these, and the number of intervals. The last word is the number of records.
class Instants final : public CkSegment {
  public:
    Instants(const CkSummary& about, std::vector<double> words)
        : CkSegment(about),
          words_(std::move(words), about.where),
          turns_(about.type == 3),
          record_(about.has_rates ? 7 : 4),
          count_(words_.count_from_end(1, "records", 1, kMaxRecords)),
          intervals_(read_intervals()) {
        for (std::size_t i = 0; i < count_; ++i) {
            const auto q = words_.piece(i * record_, 4);
            if (!(norm(Quat{q[0], q[1], q[2], q[3]}) > 0))
                words_.fail("record " + std::to_string(i + 1) + ": its quaternion is 0");
        }
    }

    std::vector<TickSpan> spans() const override {
        if (turns_) return intervals_.spans(times());
        std::vector<TickSpan> out;
        for (const double t : times()) out.push_back({t, t});
        return out;
    }

    std::optional<CkPointing> at(double ticks, double seconds_per_tick) const override {
        const std::size_t after = times_up_to(times(), ticks);
        if (after == 0) return {};
        const std::size_t i = after - 1;
        const Quat a = from_naif(words_.piece(i * record_, 4));
        if (!turns_) return times()[i] == ticks ? std::optional(CkPointing{a, kept_rate(i)}) : std::nullopt;
        const auto samples = intervals_.at(times(), ticks);
        if (!samples) return {};
        if (samples->end - samples->first == 1) return CkPointing{a, kept_rate(i)};
        // The rotation from one attitude to the next, about an axis in the reference frame.
        const std::size_t from = i + 1 < samples->end ? i : i - 1;
        const Quat start = from_naif(words_.piece(from * record_, 4));
        Quat step = from_naif(words_.piece((from + 1) * record_, 4)) * conjugate(start);
        if (step.w < 0) step = {-step.w, -step.x, -step.y, -step.z};
        const Vec3d sine{step.x, step.y, step.z};
        const double size = length(sine);
        const Vec3d turn = (size > 1e-12 ? 2 * std::atan2(size, step.w) / size : 2.0) * sine;
        const double span = times()[from + 1] - times()[from], u = (ticks - times()[from]) / span;
        return CkPointing{normalized(from_rotation_vector(u * turn) * start),
                          turn / (span * seconds_per_tick)};
    }

  private:
    SegmentWords words_;
    bool turns_;
    std::size_t record_, count_;
    CkIntervals intervals_;

    std::span<const double> times() const { return words_.piece(record_ * count_, count_); }
    Vec3d kept_rate(std::size_t i) const {
        if (record_ == 4) return {};
        const auto w = words_.piece(i * record_ + 4, 3);
        return {w[0], w[1], w[2]};
    }
    CkIntervals read_intervals() const {
        const std::size_t to_starts = (record_ + 1) * count_ + (count_ - 1) / kDirectoryStep;
        if (!turns_) {
            words_.require_size(to_starts + 1);
            words_.require_rising(record_ * count_, count_, "time");
            return {words_, times(), times().first(1)};
        }
        const std::size_t count = words_.count_from_end(2, "intervals", 1, static_cast<double>(count_));
        words_.require_size(to_starts + count + (count - 1) / kDirectoryStep + 2);
        words_.require_rising(record_ * count_, count_, "time");
        return {words_, times(), words_.piece(to_starts, count)};
    }
};

}  // namespace

std::unique_ptr<CkSegment> make_ck_instants(const CkSummary& about, std::vector<double> words) {
    return std::make_unique<Instants>(about, std::move(words));
}

}  // namespace hilcam
