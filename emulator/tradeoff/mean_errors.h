#pragma once
// Averages the errors of several frames of one picture.

#include "emulator/tradeoff/picture_judge.h"

namespace hilcam {

class MeanErrors {
  public:
    void add(const PictureErrors& e) {
        ++count_;
        sum_.noise.p99 += e.noise.p99;
        sum_.noise.rms += e.noise.rms;
        within_ += e.noise.within_half_fraction;
        sum_.noise.lit_px = e.noise.lit_px;
        sum_.false_lights += e.false_lights;
        add(sum_.centroid_px, e.centroid_px);
        add(sum_.photometric_fraction, e.photometric_fraction);
        add(sum_.limb_px, e.limb_px);
        add(sum_.similarity, e.similarity);
    }
    PictureErrors mean() const {
        PictureErrors out = sum_;
        out.noise.p99 /= count_, out.noise.rms /= count_, out.false_lights /= count_;
        out.noise.within_half_fraction = within_ / count_;
        for (auto* figure : {&out.centroid_px, &out.photometric_fraction, &out.limb_px, &out.similarity})
            if (*figure) **figure /= count_;
        return out;
    }

  private:
    // Adds a value to a sum. If any frame lacks the figure, the mean lacks it, too.
    void add(std::optional<double>& sum, const std::optional<double>& value) const {
        if (!value || (count_ > 1 && !sum)) return sum.reset();
        sum = sum.value_or(0) + *value;
    }
    PictureErrors sum_;
    double within_ = 0;
    int count_ = 0;
};

}  // namespace hilcam
