#include "render/radiosity/solve_ahead.h"

#include <algorithm>
#include <utility>

namespace hilcam {

SolveAhead::SolveAhead(std::span<IrradianceCache* const> lights, const EmbreeScene& scene,
                       const RadiosityTerms& terms)
    : lights_(lights.begin(), lights.end()),
      terms_(terms),
      solver_(std::vector<const IrradianceCache*>(lights.begin(), lights.end()), scene),
      links_(lights.size()) {
    const std::size_t count = lights.size();
    stage_.links.resize(count), stage_.has_links.resize(count);
    stage_.solutions.resize(count);
    stage_.has_solution.assign(count, std::vector<std::uint8_t>(terms_.count()));
    for (SolveKey* key : {&shown_, &stage_.key, &wanted_}) key->reserve(count, terms_);
    for (std::size_t i = 0; i < count; ++i) {
        if (!lights_[i]) continue;
        order_.push_back(i);
        lights_[i]->adopt(links_[i]);
        for (std::size_t t = 0; t < terms_.count(); ++t)
            stage_.solutions[i].push_back(lights_[i]->make_solution(terms_.kind(t)));
    }
    members_.reserve(count);
    if (!order_.empty()) ahead_.start([this] { prepare(wanted_); });
}

void SolveAhead::bring_to(const SolveKey& key) {
    if (key == shown_) return;
    ahead_.give_up();
    ahead_.wait();
    prepare(key);
    adopt();
}

void SolveAhead::look_ahead(const SolveKey& key) {
    if (is_busy() || key == shown_ || key == stage_.key) return;
    wanted_ = key;
    ahead_.ask();
}

// Fills the stage with everything that the key needs and the lights lack, and keeps what it already has. If
// the work is given up, something is missing.
void SolveAhead::prepare(const SolveKey& key) {
    prepare_links(key);
    if (AheadThread::was_given_up()) return;
    std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
        return std::pair(key.group[a], a) < std::pair(key.group[b], b);
    });
    for (std::size_t first = 0, last = 0; first < order_.size(); first = last) {
        while (last < order_.size() && key.group[order_[last]] == key.group[order_[first]]) ++last;
        const bool regrouped = is_regrouped(key, order_[first]);
        for (std::size_t t = 0; t < terms_.count(); ++t) {
            prepare_group(key, t, {order_.data() + first, last - first}, regrouped);
            if (AheadThread::was_given_up()) return;
        }
    }
    stage_.key = key;
}

void SolveAhead::prepare_links(const SolveKey& key) {
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        if (!lights_[i]) continue;
        const bool wanted = key.near[i] != shown_.near[i];
        if (wanted == (stage_.has_links[i] != 0) && (!wanted || stage_.key.near[i] == key.near[i])) continue;
        if (wanted) {
            stage_.links[i].make(key.near[i], i, solver_.lights(), solver_.scene());
            stage_.key.near[i] = key.near[i];
        }
        const bool given_up = AheadThread::was_given_up();
        stage_.has_links[i] = wanted && !given_up;
        // Solutions with other links are invalid.
        for (std::vector<std::uint8_t>& has : stage_.has_solution) std::fill(has.begin(), has.end(), 0);
        if (given_up) return;
    }
}

// True when the group of an object has other members than in the light that is in use. A group is solved
// together until all of it has converged, so each member depends on the others, even on those that it does
// not see.
bool SolveAhead::is_regrouped(const SolveKey& key, std::size_t member) const {
    if (key.group == shown_.group) return false;
    return std::any_of(order_.begin(), order_.end(), [&](std::size_t i) {
        return (key.group[i] == key.group[member]) != (shown_.group[i] == shown_.group[member]);
    });
}

void SolveAhead::prepare_group(const SolveKey& key, std::size_t term, std::span<const std::size_t> group,
                               bool regrouped) {
    members_.clear();
    bool differs = regrouped, staged = true, shines = false;
    for (const std::size_t i : group) {
        const RadiositySource& source = key.sources[i][term];
        members_.push_back(
            {i, stage_.has_links[i] ? &stage_.links[i] : &links_[i], source, &stage_.solutions[i][term]});
        differs = differs || stage_.has_links[i] || source != shown_.sources[i][term];
        staged = staged && stage_.has_solution[i][term] && source == stage_.key.sources[i][term];
        shines = shines || source.kind != RadiositySource::Kind::kNone;
    }
    if (staged && differs) return;
    // A source that is off keeps its solution, because its level is zero.
    if (differs && shines) solver_.solve(members_);
    for (const RadiositySolver::Member& member : members_) {
        stage_.has_solution[member.object][term] = differs && shines && !AheadThread::was_given_up();
        stage_.key.sources[member.object][term] = member.source;
    }
}

std::size_t SolveAhead::bytes(std::size_t i) const {
    std::size_t bytes = solver_.bytes(i) + stage_.links[i].bytes();
    for (const RadiositySolution& solution : stage_.solutions[i]) bytes += solution.bytes();
    return bytes;
}

void SolveAhead::adopt() {
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        if (!lights_[i]) continue;
        if (stage_.has_links[i]) {
            std::swap(links_[i], stage_.links[i]);
            lights_[i]->adopt(links_[i]);
            stage_.has_links[i] = false;
        }
        for (std::size_t t = 0; t < terms_.count(); ++t)
            if (stage_.has_solution[i][t]) {
                lights_[i]->adopt(t, stage_.solutions[i][t]);
                stage_.has_solution[i][t] = false;
            }
    }
    shown_ = stage_.key;
}

}  // namespace hilcam
