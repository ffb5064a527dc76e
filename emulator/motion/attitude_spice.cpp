// Attitude from a frame of SPICE kernels.

#include "emulator/motion/attitude_laws.h"
#include "emulator/motion/spice_coverage.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

class SpiceAttitude final : public AttitudeLaw {
  public:
    SpiceAttitude(std::shared_ptr<SpiceKernels> kernels, const std::string& frame, Quat frame_from_body)
        : kernels_(std::move(kernels)),
          frame_from_body_(frame_from_body),
          name_("spice: frame " + in_quotes(frame)) {
        frame_ = kernels_->frames.require(frame, "attitude.spice.frame");
        // Frames that do not turn in J2000 are known at all times.
        std::vector<double> at = {-1e10, 1e10};
        kernels_->frames.add_boundaries(frame_, at);
        const auto spans = known_spans(std::move(at), [&](double et_s) {
            FrameTurn turn;
            return kernels_->frames.turn(frame_, et_s, turn);
        });
        if (spans.empty()) {
            const auto& why = kernels_->frames.left_out();
            throw InputError(name_ + ": the kernels never know it" +
                             (why.empty() ? "" : " (" + why.front() + ")"));
        }
        coverage_ = SpiceCoverage(spans, kernels_->set.time);
    }

    MotionValidity validity(TimeTai time) const override { return coverage_.validity(time); }
    AttitudeState at(const MotionContext& context, const OwnMotion&) const override {
        FrameTurn turn;
        if (!kernels_->frames.turn(frame_, coverage_.et_s(context.frame.time()), turn))
            return kUnknownAttitude;
        const Quat world_from_body = normalized(to_quat(turn.reference_from_frame) * frame_from_body_);
        return {world_from_body, transposed(to_matrix(world_from_body)) * turn.rate_rad_s};
    }
    std::string name() const override { return name_; }

  private:
    std::shared_ptr<SpiceKernels> kernels_;
    int frame_ = 0;
    Quat frame_from_body_;
    std::string name_;
    SpiceCoverage coverage_;
};

}  // namespace

std::unique_ptr<AttitudeLaw> make_spice_attitude(std::shared_ptr<SpiceKernels> kernels,
                                                 const std::string& frame, Quat frame_from_body) {
    return std::make_unique<SpiceAttitude>(std::move(kernels), frame, frame_from_body);
}

}  // namespace hilcam
