// CK type 4: Chebyshev polynomials of quaternions and, optionally, rates, over spans of varying length.

#include <array>

#include "io/spice/chebyshev.h"
#include "io/spice/ck_types.h"
#include "io/spice/quat_rate.h"

namespace hilcam {
namespace {

// Words at the end of a generic segment (SPICELIB, include file sgparam.inc), which give the places of its
// parts; these may be in any order. The last word is the number of such words.
enum FromEnd : std::size_t {
    kPacketBase = 7,
    kPackets = 6,
    kDirectoryBase = 10,
    kDirectoryWords = 9,
    kReferenceBase = 12,
    kReferences = 11
};

// The seven polynomials' counts of coefficients are the digits, to the base 128, of one number; the first is
// the lowest.
constexpr double kCountBase = 128;
constexpr std::size_t kMaxTerms = 64;

// A packet has the middle and half the length of its span in ticks, the counts, the coefficients of the
// quaternion, and those of the rate. References are the starts of the spans.
class Chebyshev final : public CkSegment {
  public:
    Chebyshev(const CkSummary& about, std::vector<double> words)
        : CkSegment(about), words_(std::move(words), about.where) {
        words_.count_from_end(1, "words about the segment", 15, 17);
        if (words_.from_end(1) != 17)
            words_.fail("found " + plain(words_.from_end(1)) + " words about the segment; accepted: 17");
        const auto place = [&](std::size_t back, const char* what) {
            return words_.count_from_end(back, what, 0, static_cast<double>(words_.size()));
        };
        const std::size_t count = place(kPackets, "packets"),
                          base = place(kPacketBase, "place of the packets");
        const std::size_t directory = place(kDirectoryBase, "place of the packets' directory");
        const std::size_t references = place(kReferenceBase, "place of the starts");
        if (count == 0) words_.fail("has no packets");
        if (place(kDirectoryWords, "words of the packets' directory") != count + 1 ||
            place(kReferences, "starts") != count)
            words_.fail("has " + std::to_string(count) +
                        " packets; accepted: as many starts, and one more word in their directory");
        words_.require_size(directory + count + 1);
        words_.require_size(references + count);
        for (std::size_t i = 0; i < count; ++i) add_packet(i, base, directory, references);
    }

    std::vector<TickSpan> spans() const override {
        std::vector<TickSpan> out;
        for (std::size_t i = 0; i < packets_.size(); ++i) out.push_back({starts_[i], stop(i)});
        return out;
    }

    std::optional<CkPointing> at(double ticks, double seconds_per_tick) const override {
        const std::size_t after = times_up_to(starts_, ticks);
        if (after == 0 || ticks > stop(after - 1)) return {};
        const Packet& p = packets_[after - 1];
        const double radius = words_[p.from + 1];
        const double s = std::clamp((ticks - words_[p.from]) / radius, -1.0, 1.0);
        std::array<ChebyshevValue, 7> v{};
        std::size_t at = p.from + 3;
        for (std::size_t k = 0; k < v.size(); ++k) {
            v[k] = chebyshev_at(words_.piece(at, p.terms[k]), s);
            at += p.terms[k];
        }
        const Quat q = conjugate(Quat{v[0].value, v[1].value, v[2].value, v[3].value});
        if (!(norm(q) > 0)) return {};
        const Quat rate = conjugate(Quat{v[0].slope, v[1].slope, v[2].slope, v[3].slope});
        return CkPointing{normalized(q), turn_rate(q, rate) / (radius * seconds_per_tick)};
    }

  private:
    struct Packet {
        std::size_t from = 0;
        std::array<std::size_t, 7> terms{};
    };
    SegmentWords words_;
    std::vector<Packet> packets_;
    std::vector<double> starts_;

    double stop(std::size_t i) const { return words_[packets_[i].from] + words_[packets_[i].from + 1]; }
    void add_packet(std::size_t i, std::size_t base, std::size_t directory, std::size_t references) {
        const std::string name = "packet " + std::to_string(i + 1) + ": ";
        // Places are relative to the first packet's.
        const double offset = words_[directory + i] - words_[directory];
        if (!(offset >= 0 && offset < static_cast<double>(words_.size()))) words_.fail(name + "lies outside");
        Packet p;
        p.from = base + static_cast<std::size_t>(offset);
        words_.require_size(p.from + 3);
        double code = words_[p.from + 2];
        std::size_t all = 0;
        if (!(code >= 0 && code < 6e14)) words_.fail(name + "its counts of coefficients are damaged");
        for (std::size_t& terms : p.terms) {
            terms = static_cast<std::size_t>(std::fmod(code, kCountBase));
            code = std::floor(code / kCountBase);
            if (terms > kMaxTerms)
                words_.fail(name + "has " + std::to_string(terms) + " coefficients; accepted: at most 64");
            all += terms;
        }
        words_.require_size(p.from + 3 + all);
        const double start = words_[references + i];
        if (!(words_[p.from + 1] > 0) || !(start <= words_[p.from] + words_[p.from + 1]) ||
            (i > 0 && !(start > starts_.back())))
            words_.fail(name + "its span of ticks is damaged; accepted: spans that rise");
        packets_.push_back(p), starts_.push_back(start);
    }
};

}  // namespace

std::unique_ptr<CkSegment> make_ck_chebyshev(const CkSummary& about, std::vector<double> words) {
    return std::make_unique<Chebyshev>(about, std::move(words));
}

}  // namespace hilcam
