#include "io/spice/kernel_frames.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

constexpr int kDeepestFrame = 16;

// Counts nested requests of dynamic frames, also through the states of bodies. Frames that depend on each
// other in a circle are not known.
class DynamicDepth {
  public:
    DynamicDepth() { ++depth_; }
    ~DynamicDepth() { --depth_; }
    DynamicDepth(const DynamicDepth&) = delete;
    DynamicDepth& operator=(const DynamicDepth&) = delete;
    static bool too_deep() {
        constexpr int kMax = 3;
        return depth_ > kMax;
    }

  private:
    static thread_local int depth_;
};
thread_local int DynamicDepth::depth_ = 0;

bool is_finite(const FrameTurn& t) {
    return hilcam::is_finite(t.reference_from_frame.x) && hilcam::is_finite(t.reference_from_frame.y) &&
           hilcam::is_finite(t.reference_from_frame.z) && hilcam::is_finite(t.rate_rad_s);
}

}  // namespace

int KernelFrames::require(std::string_view name, const std::string& key) {
    const FrameDefinition frame = frame_named(kernels_->pool, name, key);
    require(frame, key);
    return frame.code;
}

void KernelFrames::require(int code, const std::string& key) {
    // Stored under the requested code as well, because the planets' frames have two codes.
    FrameDefinition frame = frame_coded(kernels_->pool, code, key);
    frame.code = code;
    require(frame, key);
}

void KernelFrames::require(const FrameDefinition& frame, const std::string& key) {
    if (frames_.contains(frame.code)) return;
    if (frames_.size() > 10000) throw InputError(key + ": the kernels' frames refer to too many others");
    frames_[frame.code] = frame;
    switch (frame.kind) {
        case FrameClass::kInertial:
            return;
        case FrameClass::kFixedOffset:
            return require(frame.relative, frame.where + ": frame " + in_quotes(frame.name));
        case FrameClass::kPck:
            return require_body(frame, key);
        case FrameClass::kCk:
            return require_structure(frame, key);
        case FrameClass::kDynamic:
            return require_dynamic(frame);
    }
}

void KernelFrames::require_dynamic(const FrameDefinition& frame) {
    const std::string key = frame.where + ": frame " + in_quotes(frame.name);
    require(frame.relative, key);
    if (frame.dynamic->family != DynamicFrame::Family::kTwoVector) return;
    for (const FrameVector& v : frame.dynamic->vectors) {
        require(v.frame, key);
        if (v.kind == FrameVector::Kind::kConstant) continue;
        if (!places_) throw InputError(key + ": stands on places of bodies, which are not asked for here");
        // One of the two may be a centre without segments, at which the other's chain ends.
        if (!places_->has(v.observer) && !places_->has(v.target)) places_->require(v.target, key);
        for (const int body : {v.observer, v.target})
            if (places_->has(body)) places_->require(body, key);
    }
}

void KernelFrames::require_body(const FrameDefinition& frame, const std::string& key) {
    auto& list = bodies_[frame.class_code];
    if (!list.empty()) return;
    // Binary kernels take precedence over text; the last loaded comes first.
    for (std::size_t k = kernels_->binaries.size(); k-- > 0;) {
        const DafFile& file = *kernels_->binaries[k];
        if (file.kind() != "PCK") continue;
        for (std::size_t i = file.arrays().size(); i-- > 0;)
            if (orientation_class(file.arrays()[i]) == frame.class_code)
                list.push_back(load_binary_orientation(file, file.arrays()[i]));
    }
    if (auto text = text_orientation(kernels_->pool, frame.class_code)) list.push_back(std::move(text));
    if (list.empty())
        throw InputError(key + ": frame " + in_quotes(frame.name) + ": no kernel says how body " +
                         std::to_string(frame.class_code) +
                         " is turned; accepted: with a planetary constants kernel (PCK) "
                         "that has BODY" +
                         std::to_string(frame.class_code) + "_POLE_RA, or a binary one");
    for (std::size_t i = 0; i < list.size(); ++i) require(list[i]->frame, "frame " + in_quotes(frame.name));
}

void KernelFrames::require_structure(const FrameDefinition& frame, const std::string& key) {
    if (structures_.contains(frame.class_code)) return;
    Structure& s = structures_[frame.class_code];
    for (std::size_t k = kernels_->binaries.size(); k-- > 0;) {
        const DafFile& file = *kernels_->binaries[k];
        if (file.kind() != "CK") continue;
        for (std::size_t i = file.arrays().size(); i-- > 0;)
            if (file.arrays()[i].integers[0] == frame.class_code)
                s.segments.push_back(load_ck_segment(file, file.arrays()[i]));
    }
    if (s.segments.empty())
        throw InputError(key + ": frame " + in_quotes(frame.name) + ": no C-kernel has the structure " +
                         std::to_string(frame.class_code) + "; accepted: with a CK that has it");
    // Some kernels give the clock as text, which NAIF's readers ignore.
    const std::string clock_key = "CK_" + std::to_string(frame.class_code) + "_SCLK";
    const KernelVariable* named = kernels_->pool.find(clock_key);
    const int clock =
        named && named->texts.empty() ? kernels_->pool.integer(clock_key).value() : frame.class_code / 1000;
    s.clock = std::make_unique<SpacecraftClock>(kernels_->pool, clock, kernels_->time);
    for (const auto& segment : s.segments)
        for (const TickSpan& span : segment->spans()) s.spans.push_back({span, segment.get()});
    std::stable_sort(s.spans.begin(), s.spans.end(),
                     [](const auto& a, const auto& b) { return a.ticks.start < b.ticks.start; });
    // A segment may refer to a frame that is not available, such as a dynamic one; the times that it covers
    // are then unknown.
    for (std::size_t i = 0; i < s.segments.size(); ++i) try {
            require(s.segments[i]->about().frame, s.segments[i]->about().where);
        } catch (const InputError& error) {
            if (std::find(left_out_.begin(), left_out_.end(), error.what()) == left_out_.end())
                left_out_.push_back(error.what());
        }
}

bool KernelFrames::turn(int code, double et_s, FrameTurn& out) const {
    return turn(code, et_s, out, 0) && is_finite(out);
}

bool KernelFrames::turn_in(int reference, double et_s, const FrameTurn& inner, FrameTurn& out,
                           int depth) const {
    FrameTurn outer;
    if (!turn(reference, et_s, outer, depth + 1)) return false;
    out = composed(outer, inner);
    return true;
}

bool KernelFrames::turn(int code, double et_s, FrameTurn& out, int depth) const {
    const auto at = frames_.find(code);
    if (at == frames_.end() || depth > kDeepestFrame) return false;
    const FrameDefinition& frame = at->second;
    switch (frame.kind) {
        case FrameClass::kInertial:
            out = {frame.relative_from_frame, {}};
            return true;
        case FrameClass::kFixedOffset:
            return turn_in(frame.relative, et_s, {frame.relative_from_frame, {}}, out, depth);
        case FrameClass::kPck: {
            for (const auto& body : bodies_.find(frame.class_code)->second)
                if (body->covers(et_s)) return turn_in(body->frame, et_s, body->at(et_s), out, depth);
            return false;
        }
        case FrameClass::kCk:
            return structure_turn(structures_.find(frame.class_code)->second, et_s, out, depth);
        case FrameClass::kDynamic:
            return dynamic_turn(frame, et_s, out, depth);
    }
    return false;
}

bool KernelFrames::dynamic_turn(const FrameDefinition& frame, double et_s, FrameTurn& out, int depth) const {
    const DynamicDepth here;
    if (DynamicDepth::too_deep()) return false;
    if (const auto frozen = frame.dynamic->frozen_et_s) {
        FrameTurn base, then;
        if (!moving_turn(frame, *frozen, then, depth) || !turn(frame.relative, *frozen, base, depth + 1))
            return false;
        return turn_in(frame.relative, et_s,
                       {transposed(base.reference_from_frame) * then.reference_from_frame, {}}, out, depth);
    }
    if (!moving_turn(frame, et_s, out, depth)) return false;
    if (frame.dynamic->inertial) out.rate_rad_s = {0, 0, 0};
    return true;
}

bool KernelFrames::moving_turn(const FrameDefinition& frame, double et_s, FrameTurn& out, int depth) const {
    const DynamicFrame& dynamic = *frame.dynamic;
    if (dynamic.family == DynamicFrame::Family::kEarth) {
        out = earth_of_date(dynamic.earth, et_s);
        return true;
    }
    if (dynamic.family == DynamicFrame::Family::kEuler)
        return turn_in(frame.relative, et_s, euler_turn(dynamic, et_s), out, depth);
    if (!vector_axes(dynamic, et_s, out.reference_from_frame, depth)) return false;
    // At the beginning and the end of the kernels, only one side exists.
    constexpr double kStep_s = 1;
    Mat3d before = out.reference_from_frame, after = before;
    const double span_s = (vector_axes(dynamic, et_s - kStep_s, before, depth) ? kStep_s : 0) +
                          (vector_axes(dynamic, et_s + kStep_s, after, depth) ? kStep_s : 0);
    out.rate_rad_s = span_s > 0 ? rate_of(out.reference_from_frame, before, after, span_s) : Vec3d{0, 0, 0};
    return true;
}

bool KernelFrames::vector_axes(const DynamicFrame& frame, double et_s, Mat3d& out, int depth) const {
    Vec3d primary, secondary;
    if (!vector_of(frame.vectors[0], et_s, primary, depth) ||
        !vector_of(frame.vectors[1], et_s, secondary, depth))
        return false;
    const auto axes = two_vector_axes(frame, primary, secondary);
    if (axes) out = *axes;
    return axes.has_value();
}

bool KernelFrames::vector_of(const FrameVector& vector, double et_s, Vec3d& out, int depth) const {
    FrameTurn axes;
    if (vector.kind != FrameVector::Kind::kPosition && !turn(vector.frame, et_s, axes, depth + 1))
        return false;
    if (vector.kind == FrameVector::Kind::kConstant) {
        out = axes.reference_from_frame * vector.constant;
        return true;
    }
    StateVector state;
    if (!places_ || !places_->state(vector.target, vector.observer, et_s, state)) return false;
    out = vector.kind == FrameVector::Kind::kPosition
              ? state.position_m
              : state.velocity_m_s - cross(axes.rate_rad_s, state.position_m);
    return length(out) > 0;
}

bool KernelFrames::structure_turn(const Structure& s, double et_s, FrameTurn& out, int depth) const {
    // The kernels of this structure were refused.
    if (!s.clock) return false;
    const double ticks = s.clock->ticks(et_s), seconds_per_tick = s.clock->seconds_per_tick(et_s);
    const auto from = [&](const CkSegment& segment, const CkPointing& p) {
        return turn_in(segment.about().frame, et_s,
                       {to_matrix(p.reference_from_structure), p.rate_reference_rad_s}, out, depth);
    };
    for (const auto& segment : s.segments) {
        if (ticks < segment->about().start_ticks || ticks > segment->about().stop_ticks) continue;
        if (const auto p = segment->at(ticks, seconds_per_tick)) return from(*segment, *p);
    }
    if (!(tolerance_s_ > 0)) return false;
    // Uses the nearest end of a span, with the attitude held.
    const double tolerance = tolerance_s_ / seconds_per_tick;
    const auto after =
        std::upper_bound(s.spans.begin(), s.spans.end(), ticks,
                         [](double t, const Structure::Span& span) { return t < span.ticks.start; });
    const Structure::Span* best = nullptr;
    double nearest = tolerance, where = 0;
    const auto look = [&](const Structure::Span& span) {
        const double end = std::clamp(ticks, span.ticks.start, span.ticks.stop), away = std::abs(end - ticks);
        if (away <= nearest) nearest = away, where = end, best = &span;
    };
    if (after != s.spans.end()) look(*after);
    // Spans may overlap, so a few earlier ones are examined.
    for (auto at = after; at != s.spans.begin() && after - at < 8;) look(*--at);
    if (!best) return false;
    auto p = best->segment->at(where, seconds_per_tick);
    if (!p) return false;
    p->rate_reference_rad_s = {};
    return from(*best->segment, *p);
}

void KernelFrames::add_boundaries(int code, std::vector<double>& et_s) const {
    const auto at = frames_.find(code);
    if (at == frames_.end()) return;
    const FrameDefinition& frame = at->second;
    if (frame.kind == FrameClass::kFixedOffset) return add_boundaries(frame.relative, et_s);
    if (frame.kind == FrameClass::kDynamic) {
        add_boundaries(frame.relative, et_s);
        if (frame.dynamic->family != DynamicFrame::Family::kTwoVector) return;
        for (const FrameVector& v : frame.dynamic->vectors) {
            add_boundaries(v.frame, et_s);
            if (v.kind == FrameVector::Kind::kConstant) continue;
            places_->add_boundaries(v.observer, et_s);
            places_->add_boundaries(v.target, et_s);
        }
    }
    if (frame.kind == FrameClass::kPck) {
        for (const auto& body : bodies_.find(frame.class_code)->second)
            et_s.insert(et_s.end(), {body->start_et_s, body->stop_et_s});
    }
    if (frame.kind == FrameClass::kCk) {
        const Structure& s = structures_.find(frame.class_code)->second;
        for (const Structure::Span& span : s.spans) {
            et_s.push_back(s.clock->et_s(span.ticks.start) - tolerance_s_);
            et_s.push_back(s.clock->et_s(span.ticks.stop) + tolerance_s_);
        }
        for (const auto& segment : s.segments) add_boundaries(segment->about().frame, et_s);
    }
}

}  // namespace hilcam
