// SPK types 8, 9, 12, 13 and 18: states at instants, interpolated in a window around the time.

#include "io/spice/sample_window.h"
#include "io/spice/segment_words.h"
#include "io/spice/spk_types.h"
#include "render/vocabulary/node_polynomial.h"

namespace hilcam {
namespace {

// Packets of six words, x, y, z, x', y', z' [km, km/s], of subtype 0 of type 18 twelve, in which position with velocity
// and velocity with acceleration are apart. Then, with even steps (8, 12), the first time and the step, else all times
// with every hundredth; then the degree (8, 9), the window less 1 (12, 13) or subtype and window (18); how many.
class Discrete final : public SpkSegment {
  public:
    Discrete(const SpkSummary& about, std::vector<double> words)
        : SpkSegment(about),
          words_(std::move(words), about.where),
          even_(about.type == 8 || about.type == 12),
          hermite_(about.type == 12 || about.type == 13) {
        count_ = words_.count_from_end(1, "states", 1, kMostRecords);
        if (about.type == 18) {
            truncated_ = true;
            const std::size_t subtype = words_.count_from_end(3, "subtype", 0, 1);
            hermite_ = subtype == 0, apart_ = subtype == 0;
            window_ = words_.count_from_end(2, "window", 2, static_cast<double>(most_nodes()));
        } else {
            window_ = 1 + words_.count_from_end(2, hermite_ ? "window less 1" : "degree", 1,
                                                static_cast<double>(most_nodes() - 1));
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
        // Hermite's velocity is the derivative of the position, unless it has nodes of its own.
        const Vec3d velocity_km_s =
            hermite_ && !apart_ ? slope / half_s : Vec3d{out.value[3], out.value[4], out.value[5]};
        return {kKilometre_m * Vec3d{out.value[0], out.value[1], out.value[2]}, kKilometre_m * velocity_km_s};
    }

  private:
    SegmentWords words_;
    bool even_, hermite_, apart_ = false, truncated_ = false;
    std::size_t count_ = 0, window_ = 0, packet_ = 6;
    double first_et_s_ = 0, step_s_ = 0;

    std::size_t most_nodes() const { return hermite_ ? kMaxNodes / 2 : kMaxNodes; }
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

}  // namespace

std::unique_ptr<SpkSegment> make_spk_discrete(const SpkSummary& about, std::vector<double> words) {
    return std::make_unique<Discrete>(about, std::move(words));
}

}  // namespace hilcam
