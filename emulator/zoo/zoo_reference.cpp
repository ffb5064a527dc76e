#include "emulator/zoo/zoo_reference.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>

#include "emulator/characterise/characterise_setup.h"
#include "emulator/progress/progress.h"
#include "emulator/tradeoff/reference_cache.h"
#include "render/vocabulary/stopwatch.h"

namespace hilcam {
namespace {

// No measured frame uses these light paths.
constexpr std::uint64_t kFirstFrame = std::uint64_t{1} << 33;
constexpr int kFewestFrames = 4;

// Sums over even and over odd frames.
class Halves {
  public:
    explicit Halves(std::size_t pixels) : sums_{std::vector<double>(pixels), std::vector<double>(pixels)} {}
    void add(int frame, const ElectronImage& picture) {
        std::vector<double>& sum = sums_[static_cast<std::size_t>(frame % 2)];
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += static_cast<double>(picture.data()[i]);
    }
    // frames: total number in both halves, an even number.
    double mean_of_half(std::size_t half, std::size_t i, int frames) const {
        return 2 * sums_[half][i] / frames;
    }

  private:
    std::array<std::vector<double>, 2> sums_;
};

struct Sums {
    Halves still, moved;
};

// Averages light first and cuts it off afterwards, like a frame without randomness.
void fill(const Sums& sums, double full_e, ZooReference& out) {
    const auto cut = [full_e](double charge_e) { return std::min(charge_e, full_e); };
    for (std::size_t i = 0; i < out.mean.pixels(); ++i) {
        std::array<double, 2> still, moved;
        for (std::size_t half = 0; half < 2; ++half) {
            still[half] = sums.still.mean_of_half(half, i, out.frames);
            moved[half] = sums.moved.mean_of_half(half, i, out.frames);
        }
        const double mean_e = cut(0.5 * (still[0] + still[1]));
        out.mean.data()[i] = static_cast<float>(mean_e);
        out.error.data()[i] = static_cast<float>(0.5 * (cut(still[0]) - cut(still[1])));
        out.change.data()[i] = static_cast<float>(cut(0.5 * (moved[0] + moved[1])) - mean_e);
        out.change_error.data()[i] =
            static_cast<float>(0.5 * (cut(moved[0]) - cut(still[0]) - cut(moved[1]) + cut(still[1])));
    }
}

NoiseError standard_error_of(const ZooReference& reference, const SensorNoise& noise) {
    ElectronImage off = clone(reference.mean);
    for (std::size_t i = 0; i < off.pixels(); ++i) off.data()[i] += reference.error.data()[i];
    return noise_error(off, reference.mean, reference.dark, noise);
}

int pan_columns(const ScenarioConfig& reference) {
    return std::max<int>(1, static_cast<int>(reference.quality.oversampling) / 4);
}

std::string key_with_pan(const std::string& key) { return key + "with its pan\n"; }

}  // namespace

std::vector<std::string> zoo_reference_overrides() {
    return {"quality.visibility=rays", "quality.oversampling=4", "quality.samples_per_axis=1",
            "quality.guard_px=28"};
}

double pan_px_of(const ScenarioConfig& reference) {
    const auto across = static_cast<double>(reference.quality.oversampling);
    return across > 1 ? pan_columns(reference) / across : 0;
}

ZooReference render_zoo_reference(StillCamera& camera, const ScenarioConfig& s, const ReferenceLimits& limits,
                                  const std::function<void(const std::string&)>& log) {
    const Stopwatch watch;
    const SensorNoise noise(s.camera, s.camera.gain_db);
    const double full_e = configured_saturation_e(s.camera, s.camera.gain_db);
    const int columns = pan_px_of(s) > 0 ? pan_columns(s) : 0;
    ZooReference out;
    out.dark = camera.dark();
    for (ElectronImage* image : {&out.mean, &out.error, &out.change, &out.change_error})
        *image = ElectronImage(out.dark.width(), out.dark.height());
    Sums sums{Halves(out.dark.pixels()), Halves(out.dark.pixels())};
    Progress progress("reference");
    for (int goal = kFewestFrames; goal <= limits.max_frames; goal *= 2) {
        for (; out.frames < goal; ++out.frames) {
            progress.now(fmt::format("reference, frame {} of {} or more", out.frames + 1, goal));
            camera.render(
                {static_cast<std::uint64_t>(s.seed), kFirstFrame + static_cast<std::uint64_t>(out.frames)});
            sums.still.add(out.frames, camera.expose());
            sums.moved.add(out.frames, camera.expose_moved(columns));
        }
        fill(sums, full_e, out);
        out.standard_error = standard_error_of(out, noise);
        if (out.standard_error.p99 <= limits.standard_error_sigma) break;
    }
    out.seconds = watch.seconds();
    log(fmt::format(
        "reference of {} frames: standard error {:.3f} of the sensor's noise or less in 99 % of {} lit "
        "pixels, {:.3f} rms; took {:.1f} s",
        out.frames, out.standard_error.p99, out.standard_error.lit_px, out.standard_error.rms, out.seconds));
    return out;
}

std::optional<ZooReference> kept_zoo_reference(const Cache& cache, const std::string& key) {
    ZooReference out;
    const std::array<ElectronImage*, 3> beside = {&out.error, &out.change, &out.change_error};
    std::optional<ReferencePicture> picture = kept_reference(cache, key_with_pan(key), beside);
    if (!picture) return std::nullopt;
    static_cast<ReferencePicture&>(out) = std::move(*picture);
    return out;
}

void keep_zoo_reference(const Cache& cache, const std::string& key, const ZooReference& r) {
    const std::array<const ElectronImage*, 3> beside = {&r.error, &r.change, &r.change_error};
    keep_reference(cache, key_with_pan(key), r, beside);
}

}  // namespace hilcam
