// SPK types 8, 9, 12, 13 and 18: states at instants, interpolated in a window around the time. Type 19:
// several such series, each for its own span.

#include "io/spice/sample_window.h"
#include "io/spice/segment_words.h"
#include "io/spice/spk_types.h"
#include "render/vocabulary/node_polynomial.h"

namespace hilcam {
namespace {

// Packets of six words, x, y, z, x', y', z' [km, km/s]; in subtype 0 of type 18 twelve, which separate
// position with velocity from velocity with acceleration. A series of type 19 is like a segment of type 18,
// with a subtype 2 like type 13. Then come, for even steps (8, 12), the first time and the step, else all
// times with every hundredth; then the degree (8, 9), the window minus 1 (12, 13), or subtype and window
// (18); and the number of packets.
class Discrete final : public SpkSegment {
  public:
    Discrete(const SpkSummary& about, std::vector<double> words)
        : SpkSegment(about),
          words_(std::move(words), about.where),
          even_(about.type == 8 || about.type == 12),
          hermite_(about.type == 12 || about.type == 13) {
        count_ = words_.count_from_end(1, "states", 1, kMaxRecords);
        if (about.type == 18 || about.type == 19) {
            truncated_ = true;
            const std::size_t subtype = words_.count_from_end(3, "subtype", 0, about.type == 18 ? 1 : 2);
            hermite_ = subtype != 1, apart_ = subtype == 0;
            window_ = words_.count_from_end(2, "window", 2, static_cast<double>(max_nodes()));
        } else {
            window_ = 1 + words_.count_from_end(2, hermite_ ? "window less 1" : "degree", 1,
                                                static_cast<double>(max_nodes() - 1));
            if (count_ < window_)
                words_.fail("has " + std::to_string(count_) + " states; accepted: as many as its window, " +
                            std::to_string(window_));
        }
        packet_ = apart_ ? 12 : 6;
        if (even_) {
            words_.require_size(6 * count_ + 4);
            first_et_s_ = words_.from_end(4), step_s_ = words_.from_end(3);
            if (!(step_s_ > 0)) words_.fail("step: found " + plain(step_s_) + "; accepted: above 0");
        } else {
            words_.require_size((packet_ + 1) * count_ + (count_ - 1) / kDirectoryStep +
                                (truncated_ ? 3 : 2));
            words_.require_rising(packet_ * count_, count_, "time");
        }
    }

    StateVector at(double et_s) const override {
        const SampleWindow w = window(et_s);
        if (w.count == 1)
            return {kKilometre_m * three(w.first, 0), kKilometre_m * three(w.first, apart_ ? 6 : 3)};
        const double middle_s = 0.5 * (time(w.first) + time(w.first + w.count - 1));
        const double half_s = 0.5 * (time(w.first + w.count - 1) - time(w.first));
        std::array<Node<6>, kMaxNodes> nodes;
        for (std::size_t i = 0; i < w.count; ++i) {
            Node<6>& node = nodes[i];
            node.t = (time(w.first + i) - middle_s) / half_s;
            const auto p = words_.piece(packet_ * (w.first + i), packet_);
            for (std::size_t k = 0; k < 3; ++k) {
                node.value[k] = p[k], node.value[3 + k] = p[(apart_ ? 6 : 3) + k];
                node.rate[k] = half_s * p[3 + k];
                if (apart_) node.rate[3 + k] = half_s * p[9 + k];
            }
        }
        const auto out = polynomial_at<6>({nodes.data(), w.count}, hermite_, (et_s - middle_s) / half_s);
        const Vec3d slope{out.rate[0], out.rate[1], out.rate[2]};
        // The velocity of Hermite is the derivative of the position, unless it has nodes of its own.
        const Vec3d velocity_km_s =
            hermite_ && !apart_ ? slope / half_s : Vec3d{out.value[3], out.value[4], out.value[5]};
        return {kKilometre_m * Vec3d{out.value[0], out.value[1], out.value[2]}, kKilometre_m * velocity_km_s};
    }

  private:
    SegmentWords words_;
    bool even_, hermite_, apart_ = false, truncated_ = false;
    std::size_t count_ = 0, window_ = 0, packet_ = 6;
    double first_et_s_ = 0, step_s_ = 0;

    std::size_t max_nodes() const { return hermite_ ? kMaxNodes / 2 : kMaxNodes; }
    double time(std::size_t i) const {
        return even_ ? first_et_s_ + static_cast<double>(i) * step_s_ : words_[packet_ * count_ + i];
    }
    Vec3d three(std::size_t packet, std::size_t from) const {
        const auto p = words_.piece(packet_ * packet + from, 3);
        return {p[0], p[1], p[2]};
    }
    SampleWindow window(double et_s) const {
        std::size_t after;
        if (even_) {
            const double steps = std::floor((et_s - first_et_s_) / step_s_);
            after = static_cast<std::size_t>(std::clamp(steps + 1, 0.0, static_cast<double>(count_)));
        } else {
            after = times_up_to(words_.piece(packet_ * count_, count_), et_s);
        }
        const bool next_is_nearer =
            after > 0 && after < count_ && time(after) - et_s < et_s - time(after - 1);
        return sample_window(after, next_is_nearer, window_, count_, truncated_);
    }
};

// Type 19: the series one after the other; the start of each span and the end of the last [s], with every
// hundredth; the start of each series, counted from the segment's first word, and 1 past the last; 1 if an
// instant between two spans belongs to the later one, else 0; the number of series.
class Piecewise final : public SpkSegment {
  public:
    Piecewise(const SpkSummary& about, std::vector<double> words) : SpkSegment(about) {
        const SegmentWords all(std::move(words), about.where);
        const std::size_t count = all.count_from_end(1, "series", 1, kMaxRecords);
        later_ = all.count_from_end(2, "later one at an instant between", 0, 1) == 1;
        const std::size_t after = 2 + (count + 1) + count / kDirectoryStep + (count + 1);
        all.require_size(after);
        const std::size_t spans = all.size() - after, begins = all.size() - 2 - (count + 1);
        all.require_rising(spans, count + 1, "begin of a span");
        const auto times = all.piece(spans, count + 1);
        spans_et_s_.assign(times.begin(), times.end());
        if (spans_et_s_.front() > about.start_et_s || spans_et_s_.back() < about.stop_et_s)
            all.fail("its series go from " + plain(spans_et_s_.front()) + " to " + plain(spans_et_s_.back()) +
                     " s; accepted: over all of its span");
        for (std::size_t i = 0; i < count; ++i) {
            const auto place = [&](std::size_t k) {
                return all.count_from_end(all.size() - begins - k, "begin of a series", 1,
                                          static_cast<double>(spans + 1));
            };
            const std::size_t first = place(i) - 1, end = place(i + 1) - 1;
            if (end < first)
                all.fail("begin of series " + std::to_string(i + 2) + ": is before the one before");
            const auto piece = all.piece(first, end - first);
            SpkSummary own = about;
            own.where += ": series " + std::to_string(i + 1);
            series_.push_back(
                std::make_unique<Discrete>(own, std::vector<double>(piece.begin(), piece.end())));
        }
    }

    StateVector at(double et_s) const override {
        const auto begin = spans_et_s_.begin(), last = spans_et_s_.end() - 1;
        const auto next =
            later_ ? std::upper_bound(begin + 1, last, et_s) : std::lower_bound(begin + 1, last, et_s);
        return series_[static_cast<std::size_t>(next - begin) - 1]->at(et_s);
    }

  private:
    std::vector<double> spans_et_s_;
    std::vector<std::unique_ptr<Discrete>> series_;
    bool later_ = false;
};

}  // namespace

std::unique_ptr<SpkSegment> make_spk_discrete(const SpkSummary& about, std::vector<double> words) {
    if (about.type == 19) return std::make_unique<Piecewise>(about, std::move(words));
    return std::make_unique<Discrete>(about, std::move(words));
}

}  // namespace hilcam
