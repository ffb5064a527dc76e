// CK type 2: spans over each of which a structure turns at a constant rate.

#include "io/spice/ck_types.h"

namespace hilcam {
namespace {

// Records of the quaternion at the span's start, the rate in the reference frame [rad/s] and the seconds per
// tick; then all starts; all stops; a directory with a word for each hundred starts except the last. The
// number of records follows from the size.
class ConstantRates final : public CkSegment {
  public:
    ConstantRates(const CkSummary& about, std::vector<double> words)
        : CkSegment(about), words_(std::move(words), about.where) {
        // size = 10 n + (n - 1) / 100, in integers.
        count_ = (100 * words_.size() + 100) / 1001;
        while (count_ > 0 && size_for(count_) > words_.size()) --count_;
        if (count_ == 0 || size_for(count_) != words_.size())
            words_.fail("has " + std::to_string(words_.size()) +
                        " words; accepted: 10 for each span, and one for each hundred but the last");
        words_.require_rising(8 * count_, count_, "start");
        for (std::size_t i = 0; i < count_; ++i) {
            const auto q = words_.piece(8 * i, 4);
            if (!(norm(Quat{q[0], q[1], q[2], q[3]}) > 0))
                words_.fail("record " + std::to_string(i + 1) + ": its quaternion is 0");
            if (!(stops()[i] > starts()[i]) || (i + 1 < count_ && stops()[i] > starts()[i + 1]))
                words_.fail("span " + std::to_string(i + 1) + ": from " + plain(starts()[i]) + " to " +
                            plain(stops()[i]) + " ticks; accepted: spans that rise and do not overlap");
        }
    }

    std::vector<TickSpan> spans() const override {
        std::vector<TickSpan> out;
        for (std::size_t i = 0; i < count_; ++i) out.push_back({starts()[i], stops()[i]});
        return out;
    }

    std::optional<CkPointing> at(double ticks, double) const override {
        const std::size_t after = times_up_to(starts(), ticks);
        if (after == 0 || ticks > stops()[after - 1]) return {};
        const auto r = words_.piece(8 * (after - 1), 8);
        const Vec3d rate_rad_s{r[4], r[5], r[6]};
        const double seconds = (ticks - starts()[after - 1]) * r[7];
        return CkPointing{normalized(from_rotation_vector(seconds * rate_rad_s) * from_naif(r)), rate_rad_s};
    }

  private:
    SegmentWords words_;
    std::size_t count_ = 0;

    static std::size_t size_for(std::size_t count) { return 10 * count + (count - 1) / kDirectoryStep; }
    std::span<const double> starts() const { return words_.piece(8 * count_, count_); }
    std::span<const double> stops() const { return words_.piece(9 * count_, count_); }
};

}  // namespace

std::unique_ptr<CkSegment> make_ck_constant_rates(const CkSummary& about, std::vector<double> words) {
    return std::make_unique<ConstantRates>(about, std::move(words));
}

}  // namespace hilcam
