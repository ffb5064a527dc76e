#include "emulator/scenario/motion_builder.h"

#include <algorithm>
#include <cmath>

#include "emulator/motion/attitude_laws.h"
#include "emulator/motion/ephemeris.h"
#include "emulator/motion/relative_motion.h"
#include "emulator/motion/spice_sky.h"
#include "emulator/motion/trajectories.h"
#include "emulator/scenario/initial_world.h"
#include "emulator/scenario/site.h"
#include "io/spice/kernel_names.h"
#include "render/sky/motion_bounds.h"
#include "render/sky/own_bodies.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr const char* kCameraName = "camera";

OrbitCenter center_numbered(std::size_t number) {
    if (number == kBodyCount) return {std::nullopt};
    return {static_cast<BodyId>(number)};
}

OrbitCenter center_of(const MotionConfig& m) { return center_numbered(m.center); }

class Builder {
  public:
    explicit Builder(const ScenarioConfig& scenario)
        : scenario_(scenario), start_(parse_utc(scenario.time_utc)) {
        names_.push_back(kCameraName);
        for (const ObjectConfig& object : scenario.objects) names_.push_back(object.name);
        // A pose in local axes turns with the body.
        site_ = site_of(scenario);
        for (std::size_t thing = 0; thing < names_.size(); ++thing) {
            const PoseConfig& pose = thing == 0 ? scenario.camera_pose : scenario.objects[thing - 1].pose;
            local_.emplace_back();
            if (pose.frame == PoseConfig::Frame::kLocal) local_.back() = local_motion(pose, site_.value());
        }
    }

    MotionSources build() {
        std::vector<std::unique_ptr<MotionSource>> sources(names_.size());
        for (std::size_t thing = 0; thing < names_.size(); ++thing) {
            const MotionConfig* motion = config_of(thing);
            if (!motion) continue;
            try {
                sources[thing] = source_of(*motion, thing);
            } catch (const InputError& error) {
                throw InputError(scenario_.places.at(
                    key_of(thing), "motion of " + in_quotes(names_[thing]) + ": " + error.what()));
            }
        }
        MotionSources out(std::move(sources), names_);
        begin(out);
        return out;
    }
    // Returns remarks about unused contents of the files that build() has read, each with its motion's key.
    const std::vector<std::string>& warnings() const { return warnings_; }

  private:
    const ScenarioConfig& scenario_;
    TimeTai start_;
    std::vector<std::string> names_;
    std::optional<PlaceConfig> site_;
    std::vector<std::optional<MotionConfig>> local_;  // local motion of each thing with a pose in local axes
    std::vector<std::size_t> asked_;                  // chain of things whose orbits are being computed
    std::vector<std::string> warnings_;

    static std::string key_of(std::size_t thing) {
        return thing == 0 ? "camera_motion" : "objects." + std::to_string(thing - 1) + ".motion";
    }
    void warn(std::size_t thing, const std::vector<std::string>& notes) {
        for (const std::string& note : notes) {
            const std::string line = scenario_.places.at(key_of(thing), key_of(thing) + ": " + note);
            if (std::find(warnings_.begin(), warnings_.end(), line) == warnings_.end())
                warnings_.push_back(line);
        }
    }

    // Refuses a scenario that begins with an impossible state.
    void begin(const MotionSources& sources) const {
        std::vector<Motion> motions = initial_motions(scenario_, start_);
        for (std::size_t thing = 0; thing < motions.size(); ++thing)
            if (const std::string what = impossible_part(motions[thing]); !what.empty())
                throw InputError("pose of " + in_quotes(names_[thing]) + ": found " + what);
        sources.begin({start_, scenario_.origin}, motions);
    }

    const MotionConfig* config_of(std::size_t thing) const {
        if (local_[thing]) return &*local_[thing];
        if (thing == 0) return scenario_.camera_motion ? &*scenario_.camera_motion : nullptr;
        const ObjectConfig& object = scenario_.objects[thing - 1];
        return object.motion ? &*object.motion : nullptr;
    }

    std::size_t thing_named(const std::string& name) const {
        const auto at = std::find(names_.begin(), names_.end(), name);
        if (at != names_.end()) return static_cast<std::size_t>(at - names_.begin());
        std::string all;
        for (const std::string& n : names_) all += (all.empty() ? "" : ", ") + n;
        throw refused("of", in_quotes(name), all);
    }

    PlacedFrame frame_of(MotionFrame kind, const std::string& of, const MotionConfig& m,
                         std::size_t self) const {
        PlacedFrame frame;
        frame.kind = static_cast<PlacedFrame::Kind>(kind);
        frame.center = center_of(m);
        if (kind == MotionFrame::kLocal) frame = local_frame(site_.value());
        // An attitude against LVLH refers to the thing's own orbit, unless another thing is named.
        if (frame.follows_thing()) frame.thing = of.empty() ? self : thing_named(of);
        return frame;
    }

    std::unique_ptr<MotionSource> source_of(const MotionConfig& m, std::size_t thing) {
        AttitudeJitter jitter;
        if (m.attitude.jitter)
            jitter = AttitudeJitter(*m.attitude.jitter, static_cast<std::uint64_t>(scenario_.seed),
                                    static_cast<std::uint32_t>(thing), start_);
        auto source =
            std::make_unique<MotionSource>(trajectory_of(m, thing), attitude_of(m, thing), std::move(jitter));
        if (m.outside == MotionConfig::Outside::kRefuse) source->require(start_);
        return source;
    }

    Keyframes keyframes_of(const MotionConfig& m) const {
        std::vector<Keyframe> keyframes;
        for (const KeyframeConfig& k : m.keyframes) {
            Keyframe& out = keyframes.emplace_back();
            out.time = start_ + to_ns(k.at_s);
            out.position_m = k.position_m;
            if (k.has_velocity) out.velocity_m_s = k.velocity_m_s;
            if (k.attitude.given()) out.attitude = frame_from_body(k.attitude);
        }
        return Keyframes(keyframes);
    }

    std::unique_ptr<Trajectory> trajectory_of(const MotionConfig& m, std::size_t thing) {
        const StateVector at_start{m.position_m, m.velocity_m_s};
        switch (m.kind) {
            case MotionConfig::Kind::kKeyframes:
                return make_keyframed(frame_of(m.frame, m.of, m, thing), keyframes_of(m));
            case MotionConfig::Kind::kKepler:
                return kepler_of(m);
            case MotionConfig::Kind::kTle: {
                const TleConfig& tle = m.tle.value();
                const std::string file = tle.file.string();
                const std::vector<ElementSet> sets = load_element_sets(tle.file, tle.checksum);
                return make_tle(choose_element_set(sets, tle.satellite, start_, file), tle.valid_s);
            }
            case MotionConfig::Kind::kOem: {
                const EphemerisFileConfig& oem = m.oem.value();
                std::vector<std::string> notes;
                std::vector<OemSegment> segments = load_oem(oem.file, oem.object, &notes);
                warn(thing, notes);
                if (m.outside == MotionConfig::Outside::kRefuse) require_no_gap(segments, oem.file.string());
                return make_oem(std::move(segments), oem.file.string());
            }
            case MotionConfig::Kind::kSpice:
                return spice_place_of(m);
            case MotionConfig::Kind::kCw: {
                PlacedFrame lvlh{PlacedFrame::Kind::kLvlh, thing_named(m.of), center_of(m)};
                const StateVector chief = orbit_of(lvlh.thing, lvlh.center);
                return make_drifting(lvlh, at_start, mean_motion_rad_s(chief, gravity_m3_s2(lvlh.center)),
                                     start_);
            }
            case MotionConfig::Kind::kFixed:
                break;
        }
        return make_fixed(frame_of(m.frame, m.of, m, thing), at_start, start_);
    }

    std::shared_ptr<SpiceKernels> kernels(const char* key) const {
        if (scenario_.spice) return scenario_.spice->loaded;
        throw InputError(std::string(key) +
                         ": the scenario has no kernels; accepted: with 'spice: {kernels: [...]}'");
    }

    std::unique_ptr<Trajectory> spice_place_of(const MotionConfig& m) const {
        const std::shared_ptr<SpiceKernels> set = kernels("kind: spice");
        const std::string& name = m.spice.value().object;
        const int object = require_kernel_code(set->set.pool, name, "spice.object");
        if (scenario_.origin.kind == OriginConfig::Kind::kSpice) {
            const int home = require_kernel_code(set->set.pool, scenario_.origin.object, "origin.object");
            // This is the object at the origin itself.
            if (home == object) return make_fixed({}, {}, start_);
            return make_spice_place(set, {object, home, {}}, name);
        }
        const OrbitCenter center = center_of(m);
        return make_spice_place(set, {object, naif_code_in(*set, center.body), center}, name);
    }

    std::unique_ptr<Trajectory> kepler_of(const MotionConfig& m) const {
        const KeplerConfig& k = m.kepler.value();
        const double mean =
            k.has_true ? mean_anomaly(k.true_anomaly_rad, k.eccentricity) : k.mean_anomaly_rad;
        const TimeTai epoch = k.epoch_utc.empty() ? start_ : parse_utc(k.epoch_utc);
        return make_kepler(
            center_of(m),
            {k.semi_major_axis_m, k.eccentricity, k.inclination_rad, k.node_rad, k.periapsis_rad, mean},
            epoch);
    }

    // Returns a thing's state about a centre at the start, to find the mean motion of its orbit.
    StateVector orbit_of(std::size_t thing, const OrbitCenter& center) {
        const WorldFrame frame(start_, scenario_.origin);
        std::vector<Motion> motions = initial_motions(scenario_, start_);
        fill({thing, false}, frame, motions);
        const Motion& m = motions[thing];
        return about_center({frame, motions}, {m.pose.position_world_m, m.velocity_world_m_s}, center);
    }
    // Evaluates a part of a thing at the start, and what it needs.
    void fill(const MotionNeed& part, const WorldFrame& frame, std::vector<Motion>& motions) {
        const MotionConfig* config = config_of(part.thing);
        if (!config) return;
        if (asked_.size() > 2 * names_.size())
            throw InputError(
                "follows itself, directly or through other things; accepted: motions without a cycle");
        asked_.push_back(part.thing);
        if (part.attitude) fill({part.thing, false}, frame, motions);
        const auto source = source_of(*config, part.thing);
        for (const MotionNeed& need : part.attitude ? source->turn_needs() : source->place_needs())
            fill(need, frame, motions);
        const MotionContext context{frame, motions};
        part.attitude ? source->turn(context, motions[part.thing])
                      : source->place(context, motions[part.thing]);
        asked_.pop_back();
    }

    std::unique_ptr<AttitudeLaw> attitude_of(const MotionConfig& m, std::size_t thing) {
        const AttitudeConfig& a = m.attitude;
        using Law = AttitudeConfig::Law;
        if (a.law == Law::kHeld)
            return make_turning(frame_of(a.frame, a.of, m, thing),
                                {frame_from_body(a.attitude), a.rate_body_rad_s}, start_);
        // World axes are ICRF's.
        if (a.law == Law::kPole)
            return make_turning(frame_of(MotionFrame::kWorld, {}, m, thing), pole_attitude(a), start_);
        if (a.law == Law::kKeyframes)
            return make_keyframed_attitude(frame_of(m.frame, m.of, m, thing), keyframes_of(m));
        if (a.law == Law::kAem) {
            const EphemerisFileConfig& aem = a.aem.value();
            std::vector<std::string> notes;
            std::vector<AemSegment> segments = load_aem(aem.file, aem.object, &notes);
            warn(thing, notes);
            if (m.outside == MotionConfig::Outside::kRefuse) require_no_gap(segments, aem.file.string());
            return make_aem(std::move(segments), center_of(m), aem.file.string());
        }
        if (a.law == Law::kSpice) {
            const std::shared_ptr<SpiceKernels> set = kernels("attitude.law: spice");
            const SpiceMounting mounting = mounting_of(a.spice.value(), *set);
            return make_spice_attitude(set, mounting.frame, mounting.frame_from_camera);
        }
        return make_pointing(pointing_of(m));
    }

    // Uses the IAU's angles (Archinal et al. 2018, figure 1): a rotation about z to the node, about the node
    // to the pole, and about the pole to the prime meridian.
    AttitudeState pole_attitude(const AttitudeConfig& a) const {
        const double w =
            std::fmod(a.meridian_rad + a.pole_rate_rad_s * seconds_since_j2000(start_), kTurn_rad);
        const Quat node = from_rotation_vector({0, 0, a.pole_rad[0] + 0.5 * kPi});
        const Quat pole = from_rotation_vector({0.5 * kPi - a.pole_rad[1], 0, 0});
        return {normalized(node * pole * from_rotation_vector({0, 0, w})), {0, 0, a.pole_rate_rad_s}};
    }

    Pointing pointing_of(const MotionConfig& m) const {
        const AttitudeConfig& a = m.attitude;
        using Law = AttitudeConfig::Law;
        Pointing p;
        p.axis = a.axis, p.second_axis = a.second_axis;
        p.aim.center = p.second_aim.center = center_of(m);
        if (a.law == Law::kNadir && a.has_nadir_of)
            p.aim.center = center_numbered(a.nadir_of);
        else if (a.law == Law::kNadir && m.frame == MotionFrame::kLocal)
            p.aim.center = {site_.value().body};
        p.aim.kind = a.law == Law::kNadir      ? Aim::Kind::kNadir
                     : a.law == Law::kSun      ? Aim::Kind::kSun
                     : a.law == Law::kVelocity ? Aim::Kind::kVelocity
                                               : Aim::Kind::kThing;
        if (a.law == Law::kThing) p.aim.thing = thing_named(a.of);
        constexpr std::array kSecond = {Aim::Kind::kNorth, Aim::Kind::kVelocity, Aim::Kind::kOrbitNormal,
                                        Aim::Kind::kNadir, Aim::Kind::kSun};
        p.second_aim.kind = kSecond[static_cast<std::size_t>(a.second)];
        return p;
    }
};

}  // namespace

MotionSources load_motion_sources(const ScenarioConfig& scenario) { return Builder(scenario).build(); }

std::vector<std::string> motion_warnings(const ScenarioConfig& scenario) {
    Builder builder(scenario);
    builder.build();
    return builder.warnings();
}

}  // namespace hilcam
