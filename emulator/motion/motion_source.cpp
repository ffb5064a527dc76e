#include "emulator/motion/motion_source.h"

#include <algorithm>
#include <array>

#include "render/sky/motion_bounds.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {

MotionValidity validity_of(TimeTai time, TimeTai first, TimeTai last) {
    if (time < first) return {MotionStatus::kBefore, first};
    if (last < time) return {MotionStatus::kAfter, last};
    return {MotionStatus::kOk, time};
}

MotionSource::MotionSource(std::unique_ptr<Trajectory> trajectory, std::unique_ptr<AttitudeLaw> attitude,
                           AttitudeJitter jitter)
    : trajectory_(std::move(trajectory)), attitude_(std::move(attitude)), jitter_(std::move(jitter)) {}

namespace {

// Evaluates a part at an instant that it covers: the context's, or the nearest one.
template <class F>
auto at_valid(const MotionContext& context, const MotionValidity& validity, F&& evaluate) {
    if (validity.status == MotionStatus::kOk) return evaluate(context);
    const WorldFrame frame = context.frame.at(validity.nearest);
    return evaluate(MotionContext{frame, context.things, context.standing});
}

}  // namespace

MotionStatus MotionSource::given_place(const MotionContext& context, Motion& out) const {
    const MotionValidity where = trajectory_->validity(context.frame.time());
    const StateVector state =
        at_valid(context, where, [&](const MotionContext& c) { return trajectory_->at(c); });
    out.time = context.frame.time();
    out.pose.position_world_m = state.position_m;
    out.velocity_world_m_s = state.velocity_m_s;
    return where.status;
}

MotionStatus MotionSource::given_attitude(const MotionContext& context, Motion& out) const {
    const TimeTai time = context.frame.time();
    const bool stands = trajectory_->validity(time).status != MotionStatus::kOk;
    const OwnMotion self({out.pose.position_world_m, out.velocity_world_m_s}, stands,
                         stands ? std::nullopt : trajectory_->acceleration(context));
    const MotionValidity how = attitude_->validity(time);
    AttitudeState attitude =
        at_valid(context, how, [&](const MotionContext& c) { return attitude_->at(c, self); });
    if (how.status != MotionStatus::kOk) attitude.rate_body_rad_s = {};
    attitude = jitter_.applied(attitude.world_from_body, attitude.rate_body_rad_s, time);
    out.pose.world_from_body = attitude.world_from_body;
    out.rate_body_rad_s = attitude.rate_body_rad_s;
    return how.status;
}

MotionStatus MotionSource::place(const MotionContext& context, Motion& out) const {
    Motion found = out;
    const MotionStatus status = given_place(context, found);
    return take_possible(found, out) ? status : MotionStatus::kImpossible;
}

MotionStatus MotionSource::turn(const MotionContext& context, Motion& out) const {
    Motion found = out;
    const MotionStatus status = given_attitude(context, found);
    return take_possible(found, out) ? status : MotionStatus::kImpossible;
}

void MotionSource::begin(const MotionContext& context, bool attitude, Motion& out) const {
    attitude ? given_attitude(context, out) : given_place(context, out);
    if (const std::string what = impossible_part(out); !what.empty())
        throw InputError((attitude ? attitude_->name() : trajectory_->name()) + ": at " +
                         format_utc(context.frame.time()) + ": found " + what);
}

std::string MotionSource::gap_at(TimeTai time) const {
    const auto gap_of = [&](const auto& part) -> std::string {
        const MotionValidity v = part.validity(time);
        if (v.status == MotionStatus::kOk) return {};
        const char* why = v.status == MotionStatus::kBefore ? "begins at "
                          : v.status == MotionStatus::kAfter
                              ? "ends at "
                              : "has a gap there; the nearest instant in it is ";
        return part.name() + ": found the instant " + format_utc(time) + "; it " + why +
               format_utc(v.nearest);
    };
    const std::string gap = gap_of(*trajectory_);
    return gap.empty() ? gap_of(*attitude_) : gap;
}

void MotionSource::require(TimeTai time) const {
    if (const std::string gap = gap_at(time); !gap.empty()) throw InputError(gap + " (or outside: hold)");
}

MotionSources::MotionSources(std::vector<std::unique_ptr<MotionSource>> sources,
                             std::span<const std::string> names)
    : names_(names.begin(), names.end()), sources_(std::move(sources)) {
    // done[0]: positions, done[1]: attitudes.
    std::array<std::vector<std::uint8_t>, 2> done;
    for (auto& part : done)
        for (const auto& source : sources_) part.push_back(!source);
    const auto known = [&](const std::vector<MotionNeed>& needs) {
        return std::all_of(needs.begin(), needs.end(),
                           [&](const MotionNeed& n) { return done[n.attitude].at(n.thing) != 0; });
    };
    // Each round takes the parts with all needs done; a round that takes none has found a circle.
    for (bool progress = true; progress;) {
        progress = false;
        for (std::size_t i = 0; i < sources_.size(); ++i)
            for (const bool attitude : {false, true}) {
                if (done[attitude][i] || (attitude && !done[0][i])) continue;
                if (!known(attitude ? sources_[i]->turn_needs() : sources_[i]->place_needs())) continue;
                order_.push_back({i, attitude});
                done[attitude][i] = 1;
                progress = true;
            }
    }
    for (std::size_t i = 0; i < sources_.size(); ++i)
        if (!done[0][i] || !done[1][i])
            throw InputError(
                "motion of " + in_quotes(names[i]) +
                ": follows itself, directly or through other things; accepted: motions without a cycle");
}

std::string MotionSources::gap_at(TimeTai time) const {
    for (const auto& source : sources_) {
        if (!source) continue;
        if (std::string gap = source->gap_at(time); !gap.empty()) return gap;
    }
    return {};
}

MotionSources::Held MotionSources::evaluate(const WorldFrame& frame, std::span<const std::uint8_t> live,
                                            std::span<Motion> motions,
                                            std::span<std::uint8_t> standing) const {
    Held held;
    std::fill(standing.begin(), standing.end(), std::uint8_t{0});
    for (const MotionNeed& part : order_) {
        if (live[part.thing]) continue;
        const MotionSource& source = *sources_[part.thing];
        Motion& out = motions[part.thing];
        const MotionContext context{frame, motions, standing};
        const MotionStatus status = part.attitude ? source.turn(context, out) : source.place(context, out);
        if (status == MotionStatus::kOk) continue;
        if (status == MotionStatus::kImpossible && held.impossible++ == 0) held.first_impossible = part.thing;
        if (status != MotionStatus::kImpossible) ++held.unknown;
        if (!part.attitude) standing[part.thing] = 1;
    }
    for (std::size_t i = 0; i < motions.size(); ++i)
        if (standing[i] != 0) motions[i].velocity_world_m_s = {};
    return held;
}

void MotionSources::begin(const WorldFrame& frame, std::span<Motion> motions) const {
    std::vector<std::uint8_t> standing(motions.size());
    for (const MotionNeed& part : order_) try {
            const MotionContext context{frame, motions, standing};
            sources_[part.thing]->begin(context, part.attitude, motions[part.thing]);
        } catch (const InputError& error) {
            throw InputError("motion of " + in_quotes(names_[part.thing]) + ": " + error.what());
        }
}

}  // namespace hilcam
