#include "emulator/scenario/quality_config.h"

#include <string>

#include "emulator/scenario/quality_ladder.h"
#include "render/vocabulary/check.h"

namespace hilcam {

Fields fields(QualityConfig& q) {
    Fields list = fields(q.render);
    list.push_back(integer("guard_px", q.guard_px, {0, 512},
                           "width of the border around the frame that absorbs the FFT's wrap-around"));
    list.push_back(integer("oversampling", q.oversampling, {1, 8},
                           "number of radiance pixels per detector pixel along each axis; detail finer than "
                           "a pixel then aliases as on a real sensor"));
    list.push_back(choice("psf", q.psf, {"auto", "fft"},
                          "method of convolution with the PSF. auto: a compact kernel where its transfer "
                          "function is within 0.0025 of the exact one; fft: always the exact one"));
    list.push_back(
        choice("motion", q.motion, {"off", "fast", "exact"},
               "treatment of motion during the exposure. off: the middle instant; fast: the middle instant, "
               "blurred along the image motion; exact: the mean of several instants"));
    list.push_back(number("motion_error_px", q.motion_error_px, 1, {0.01, 16},
                          "exact: largest movement of anything between two instants, in pixels"));
    return list;
}

SensorSampling sampling_of(const QualityConfig& q) {
    SensorSampling sampling{static_cast<int>(q.guard_px), ray_grid_of(q.render),
                            static_cast<int>(q.oversampling)};
    if (q.render.uses_buffer() && q.oversampling == 1) {
        sampling.other_grids.push_back(sampling.samples_per_axis);  // a sum of several pictures has no halves
        sampling.samples_per_axis = halved(sampling.samples_per_axis);
    }
    sampling.always_fft = q.psf == PsfMethod::kFft;
    return sampling;
}

void validate(const QualityConfig& q) {
    const std::int64_t n = q.render.probe_directions;
    const std::int64_t samples = q.render.buffer_samples;
    if (samples != 1 && samples != 16 && samples != 64)
        throw refused("buffer_samples", std::to_string(samples), "1, 16, 64");
    if (n != 16 && n != 60 && n != 256) throw refused("probe_directions", std::to_string(n), "16, 60, 256");
}

}  // namespace hilcam
