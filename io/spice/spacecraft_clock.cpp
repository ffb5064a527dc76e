#include "io/spice/spacecraft_clock.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"

namespace hilcam {

SpacecraftClock::SpacecraftClock(const KernelPool& pool, int clock, const EphemerisTime& time) : time_(time) {
    const std::string id = std::to_string(-clock), what = "the clock " + std::to_string(clock);
    const int type = pool.integer("SCLK_DATA_TYPE_" + id).value_or(1);
    if (type != 1)
        throw InputError(pool.find("SCLK_DATA_TYPE_" + id)->where + ": SCLK_DATA_TYPE_" + id + ": found " +
                         std::to_string(type) + "; accepted: 1");
    parallel_is_tt_ = pool.integer("SCLK01_TIME_SYSTEM_" + id).value_or(1) == 2;
    const std::string moduli_key = "SCLK01_MODULI_" + id, key = "SCLK01_COEFFICIENTS_" + id;
    const auto moduli = pool.numbers(moduli_key);
    const auto triples = pool.numbers(key);
    if (!moduli || !triples)
        throw InputError("no kernel has " + (moduli ? key : moduli_key) + ", which " + what +
                         " needs; accepted: an SCLK kernel of that spacecraft");
    double ticks_per_count = 1;
    for (std::size_t i = 1; i < moduli->size(); ++i) ticks_per_count *= (*moduli)[i];
    const std::string where = pool.find(key)->where + ": " + key;
    if (!(ticks_per_count >= 1 && ticks_per_count < 1e15))
        throw InputError(pool.find(moduli_key)->where + ": " + moduli_key +
                         ": accepted: counts of 1 and more");
    if (triples->size() % 3 != 0)
        throw InputError(where + ": found " + std::to_string(triples->size()) +
                         " numbers; accepted: triples");
    for (std::size_t i = 0; i < triples->size(); i += 3) {
        const Piece piece{(*triples)[i], (*triples)[i + 1], (*triples)[i + 2] / ticks_per_count};
        const bool rises = pieces_.empty() || (piece.ticks > pieces_.back().ticks &&
                                               piece.parallel_s > pieces_.back().parallel_s);
        if (!rises || !(piece.seconds_per_tick > 0))
            throw InputError(where + ": triple " + std::to_string(i / 3 + 1) + ": found " +
                             plain(piece.ticks) + ", " + plain(piece.parallel_s) + ", " +
                             plain((*triples)[i + 2]) +
                             "; accepted: ticks and times that rise, a rate above 0");
        pieces_.push_back(piece);
    }
}

const SpacecraftClock::Piece& SpacecraftClock::piece_at(double parallel_s) const {
    const auto after = std::upper_bound(pieces_.begin(), pieces_.end(), parallel_s,
                                        [](double t, const Piece& p) { return t < p.parallel_s; });
    return after == pieces_.begin() ? pieces_.front() : *(after - 1);
}

double SpacecraftClock::ticks(double et_s) const {
    const double parallel = parallel_s(et_s);
    const Piece& p = piece_at(parallel);
    return p.ticks + (parallel - p.parallel_s) / p.seconds_per_tick;
}

double SpacecraftClock::seconds_per_tick(double et_s) const {
    return piece_at(parallel_s(et_s)).seconds_per_tick;
}

double SpacecraftClock::et_s(double ticks) const {
    const auto after = std::upper_bound(pieces_.begin(), pieces_.end(), ticks,
                                        [](double t, const Piece& p) { return t < p.ticks; });
    const Piece& p = after == pieces_.begin() ? pieces_.front() : *(after - 1);
    const double parallel = p.parallel_s + (ticks - p.ticks) * p.seconds_per_tick;
    if (!parallel_is_tt_) return parallel;
    // The difference of 2 ms changes by 1e-13 s over a time as long as itself.
    double et = parallel;
    for (int i = 0; i < 2; ++i) et += parallel - time_.tt_s(et);
    return et;
}

}  // namespace hilcam
