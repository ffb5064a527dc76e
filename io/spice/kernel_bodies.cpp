#include "io/spice/kernel_bodies.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr int kBarycentre = 0;
constexpr std::size_t kDeepestChain = 16;

StateVector sum(const StateVector& a, const StateVector& b) {
    return {a.position_m + b.position_m, a.velocity_m_s + b.velocity_m_s};
}

}  // namespace

bool KernelBodies::has(int body) const {
    return std::any_of(kernels_->binaries.begin(), kernels_->binaries.end(), [&](const auto& file) {
        return file->kind() == "SPK" && std::any_of(file->arrays().begin(), file->arrays().end(),
                                                    [&](const DafArray& a) { return a.integers[0] == body; });
    });
}

void KernelBodies::require(int body, const std::string& key) {
    if (body == kBarycentre || segments_.contains(body)) return;
    auto& list = segments_[body];
    for (std::size_t k = kernels_->binaries.size(); k-- > 0;) {
        const DafFile& file = *kernels_->binaries[k];
        if (file.kind() != "SPK") continue;
        for (std::size_t i = file.arrays().size(); i-- > 0;)
            if (file.arrays()[i].integers[0] == body)
                list.push_back(load_spk_segment(file, file.arrays()[i]));
    }
    if (list.empty())
        throw InputError(key + ": no SPK has the body " + std::to_string(body) +
                         "; accepted: with a kernel that has it");
    for (const auto& segment : list) {
        frames_->require(segment->about().frame, segment->about().where);
        // A chain may end at a centre without segments; two bodies relative to it can still be compared.
        if (has(segment->about().center)) require(segment->about().center, segment->about().where);
    }
}

bool KernelBodies::step(int& body, double et_s, StateVector& out) const {
    const auto at = segments_.find(body);
    if (at == segments_.end()) return false;
    for (const auto& segment : at->second) {
        if (!segment->about().covers(et_s)) continue;
        StateVector s = segment->at(et_s);
        if (segment->about().frame != kJ2000Frame) {
            FrameTurn turn;
            if (!frames_->turn(segment->about().frame, et_s, turn)) return false;
            const Vec3d position = turn.reference_from_frame * s.position_m;
            s = {position, turn.reference_from_frame * s.velocity_m_s + cross(turn.rate_rad_s, position)};
        }
        out = sum(out, s);
        body = segment->about().center;
        return is_finite(out.position_m) && is_finite(out.velocity_m_s);
    }
    return false;
}

bool KernelBodies::state(int body, int center, double et_s, StateVector& out) const {
    // Follows the chain from the centre to its end, then from the body until it meets a place of that chain.
    struct Place {
        int body;
        StateVector from_center;  // the centre's state relative to this place
    };
    std::array<Place, kDeepestChain> way;
    std::size_t count = 0;
    way[count++] = {center, {}};
    for (int at = center; count < kDeepestChain;) {
        StateVector s = way[count - 1].from_center;
        if (!step(at, et_s, s)) break;
        way[count++] = {at, s};
    }
    StateVector s;
    int at = body;
    for (std::size_t i = 0; i < kDeepestChain; ++i) {
        for (std::size_t k = 0; k < count; ++k)
            if (way[k].body == at) {
                out = {s.position_m - way[k].from_center.position_m,
                       s.velocity_m_s - way[k].from_center.velocity_m_s};
                return true;
            }
        if (!step(at, et_s, s)) return false;
    }
    return false;
}

void KernelBodies::add_boundaries(int body, std::vector<double>& et_s) const {
    std::vector<int> seen;
    add_boundaries(body, et_s, seen);
}

void KernelBodies::add_boundaries(int body, std::vector<double>& et_s, std::vector<int>& seen) const {
    if (std::find(seen.begin(), seen.end(), body) != seen.end()) return;
    seen.push_back(body);
    const auto at = segments_.find(body);
    if (at == segments_.end()) return;
    for (const auto& segment : at->second) {
        et_s.insert(et_s.end(), {segment->about().start_et_s, segment->about().stop_et_s});
        frames_->add_boundaries(segment->about().frame, et_s);
        add_boundaries(segment->about().center, et_s, seen);
    }
}

std::vector<EtSpan> known_spans(std::vector<double> at, const std::function<bool(double)>& known) {
    std::sort(at.begin(), at.end());
    at.erase(std::unique(at.begin(), at.end()), at.end());
    std::vector<EtSpan> out;
    const auto add = [&](double start, double stop) {
        if (!out.empty() && out.back().stop_s == start)
            out.back().stop_s = stop;
        else
            out.push_back({start, stop});
    };
    for (std::size_t i = 0; i < at.size(); ++i) {
        // A known single instant.
        if (known(at[i]) && (out.empty() || out.back().stop_s != at[i])) add(at[i], at[i]);
        if (i + 1 < at.size() && known(at[i] + 0.5 * (at[i + 1] - at[i]))) add(at[i], at[i + 1]);
    }
    return out;
}

std::vector<EtSpan> KernelBodies::coverage(int body, int center) const {
    std::vector<double> at;
    add_boundaries(body, at);
    add_boundaries(center, at);
    return known_spans(std::move(at), [&](double et_s) {
        StateVector s;
        return state(body, center, et_s, s);
    });
}

}  // namespace hilcam
