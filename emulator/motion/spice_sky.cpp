#include "emulator/motion/spice_sky.h"

#include "emulator/motion/spice_coverage.h"
#include "render/sky/body_bounds.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"

namespace hilcam {
namespace {

constexpr int kSun = 10, kBarycentre = 0, kEarthCode = 399, kItrf93Class = 3000;
constexpr std::array<int, kBodyCount> kCodes = {199, 299, 399, 301, 499, 599, 699, 799, 899};

bool has_binary_earth(const KernelSet& set) {
    for (const auto& file : set.binaries)
        if (file->kind() == "PCK")
            for (const DafArray& array : file->arrays())
                if (orientation_class(array) == kItrf93Class) return true;
    return false;
}

// Returns the frame that turns with a body; nothing: the kernels do not have one.
std::optional<std::string> frame_of(const KernelSet& set, int code) {
    const std::string key = "OBJECT_" + std::to_string(code) + "_FRAME";
    if (const KernelVariable* named = set.pool.find(key))
        return named->texts.empty() ? std::to_string(set.pool.integer(key).value()) : named->texts.front();
    if (code == kEarthCode)
        return has_binary_earth(set) ? std::optional<std::string>("ITRF93") : std::nullopt;
    if (set.pool.find("BODY" + std::to_string(code) + "_POLE_RA")) return "IAU_" + std::to_string(code);
    return {};
}

class SpiceSky final : public BodySource {
  public:
    SpiceSky(std::shared_ptr<SpiceKernels> kernels, const std::optional<int>& origin, bool with_bodies,
             TimeTai start)
        : kernels_(std::move(kernels)) {
        const double et_s = kernels_->set.time.et_s(start);
        if (with_bodies) add_bodies(et_s);
        if (origin) set_origin(*origin, start);
    }

    std::optional<StateVector> from_sun(BodyId id, TimeTai time) const override {
        const int code = codes_[index_of(id)];
        StateVector s;
        if (code == 0 || !knows(code, kSun, kernels_->set.time.et_s(time), s)) return {};
        return s;
    }
    std::optional<StateVector> sun_from_barycenter(TimeTai time) const override {
        StateVector s;
        if (!has_sun_ || !knows(kSun, kBarycentre, kernels_->set.time.et_s(time), s)) return {};
        return s;
    }
    std::optional<Mat3d> fixed_from_icrf(BodyId id, TimeTai time) const override {
        const std::optional<int>& frame = frames_[index_of(id)];
        FrameTurn turn;
        if (!frame || !kernels_->frames.turn(*frame, kernels_->set.time.et_s(time), turn)) return {};
        return transposed(turn.reference_from_frame);
    }
    StateVector origin_from_sun(TimeTai time) const override {
        const MotionValidity validity = origin_coverage_.validity(time);
        StateVector s;
        if (!knows(origin_, kSun, origin_coverage_.et_s(validity.nearest), s))
            return {origin_at_start_.position_m, {}};
        if (validity.status != MotionStatus::kOk) s.velocity_m_s = {};
        return s;
    }

  private:
    std::shared_ptr<SpiceKernels> kernels_;
    std::array<int, kBodyCount> codes_{};  // 0: the program's own series
    std::array<std::optional<int>, kBodyCount> frames_{};
    bool has_sun_ = false;
    int origin_ = 0;
    SpiceCoverage origin_coverage_;
    StateVector origin_at_start_;

    // Impossible values from the kernels count as unknown. Loop.
    bool knows(int body, int center, double et_s, StateVector& out) const {
        return kernels_->bodies.state(body, center, et_s, out) && is_possible(out);
    }
    void require_both(int body, const std::string& key) {
        kernels_->bodies.require(body, key);
        if (kernels_->bodies.has(kSun)) kernels_->bodies.require(kSun, key);
    }
    void add_bodies(double et_s) {
        StateVector s;
        if (kernels_->bodies.has(kSun)) {
            kernels_->bodies.require(kSun, "sun");
            has_sun_ = knows(kSun, kBarycentre, et_s, s);
        }
        for (std::size_t i = 0; i < kBodyCount; ++i) {
            const int code = naif_code_in(*kernels_, static_cast<BodyId>(i));
            if (kernels_->bodies.has(code)) {
                require_both(code, std::string(kBodyNames[i]));
                if (knows(code, kSun, et_s, s)) codes_[i] = code;
            }
            const auto frame = frame_of(kernels_->set, kCodes[i]);
            FrameTurn turn;
            if (!frame) continue;
            const int number = kernels_->frames.require(*frame, std::string(kBodyNames[i]));
            if (kernels_->frames.turn(number, et_s, turn)) frames_[i] = number;
        }
    }
    void set_origin(int code, TimeTai start) {
        origin_ = code;
        const std::string key = "origin.object";
        require_both(code, key);
        origin_coverage_ = SpiceCoverage(kernels_->bodies.coverage(code, kSun), kernels_->set.time);
        const MotionValidity validity = origin_coverage_.validity(start);
        if (origin_coverage_.empty())
            throw InputError(
                key + ": the kernels never say where " + std::to_string(code) +
                " is about the Sun; accepted: with an ephemeris of the planets (DE), which has the Sun");
        if (validity.status != MotionStatus::kOk)
            throw InputError(key + ": the kernels do not know where " + std::to_string(code) +
                             " is at the scenario's start; the nearest instant in them is " +
                             format_utc(validity.nearest));
        if (!knows(code, kSun, origin_coverage_.et_s(start), origin_at_start_))
            throw InputError(key + ": where " + std::to_string(code) +
                             " is about the Sun at the scenario's start cannot be; accepted: at most " +
                             plain(kFarthestPlace_m) + " m away and " + plain(kFastestMotion_m_s) +
                             " m/s fast");
    }
};

}  // namespace

int naif_code(const std::optional<BodyId>& body) { return body ? kCodes[index_of(*body)] : kSun; }

int naif_code_in(const SpiceKernels& kernels, const std::optional<BodyId>& body) {
    const int code = naif_code(body);
    const bool one_body = body == BodyId::kMercury || body == BodyId::kVenus || body == BodyId::kMars;
    return one_body && !kernels.bodies.has(code) ? code / 100 : code;
}

std::shared_ptr<const BodySource> make_spice_sky(std::shared_ptr<SpiceKernels> kernels,
                                                 const std::optional<int>& origin, bool with_bodies,
                                                 TimeTai start) {
    return std::make_shared<SpiceSky>(std::move(kernels), origin, with_bodies, start);
}

}  // namespace hilcam
