#include "io/spice/ck_segment.h"

#include "io/spice/ck_types.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {

CkSummary ck_summary(const DafFile& file, const DafArray& array) {
    CkSummary out;
    out.structure = array.integers[0], out.frame = array.integers[1], out.type = array.integers[2];
    out.has_rates = array.integers[3] != 0;
    out.start_ticks = array.doubles[0], out.stop_ticks = array.doubles[1];
    out.where = file.name() + ": segment " + std::to_string(&array - file.arrays().data() + 1) + " (" +
                in_quotes(array.name) + ", structure " + std::to_string(out.structure) + ", type " +
                std::to_string(out.type) + ")";
    if (out.stop_ticks < out.start_ticks) throw InputError(out.where + ": ends before it begins");
    return out;
}

std::unique_ptr<CkSegment> load_ck_segment(const DafFile& file, const DafArray& array) {
    const CkSummary about = ck_summary(file, array);
    switch (about.type) {
        case 1:
        case 3:
            return make_ck_instants(about, file.words(array));
        case 2:
            return make_ck_constant_rates(about, file.words(array));
        case 4:
            return make_ck_chebyshev(about, file.words(array));
        case 5:
            return make_ck_interpolated(about, file.words(array));
        default:
            throw InputError(about.where + ": found type " + std::to_string(about.type) +
                             "; accepted: 1, 2, 3, 4, 5");
    }
}

CkIntervals::CkIntervals(const SegmentWords& words, std::span<const double> times,
                         std::span<const double> starts) {
    for (std::size_t i = 0; i < starts.size(); ++i) {
        const auto at = std::lower_bound(times.begin(), times.end(), starts[i]);
        const auto first = static_cast<std::size_t>(at - times.begin());
        if (at == times.end() || *at != starts[i] || (i == 0 ? first != 0 : first <= firsts_.back()))
            words.fail("interval " + std::to_string(i + 1) + ": begins at " + plain(starts[i]) +
                       ", where no attitude is that comes after the interval before");
        firsts_.push_back(first);
    }
    firsts_.push_back(times.size());
}

std::vector<TickSpan> CkIntervals::spans(std::span<const double> times) const {
    std::vector<TickSpan> out;
    for (std::size_t i = 0; i + 1 < firsts_.size(); ++i)
        out.push_back({times[firsts_[i]], times[firsts_[i + 1] - 1]});
    return out;
}

std::optional<CkIntervals::Samples> CkIntervals::at(std::span<const double> times, double ticks) const {
    const std::size_t after = times_up_to(times, ticks);
    if (after == 0) return {};
    const auto next = std::upper_bound(firsts_.begin(), firsts_.end(), after - 1);
    const Samples samples{*(next - 1), *next};
    if (after == samples.end && ticks > times[after - 1]) return {};
    return samples;
}

}  // namespace hilcam
