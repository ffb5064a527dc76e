#include "emulator/clone/clone_bench.h"

#include <algorithm>
#include <map>
#include <utility>

#include "emulator/characterise/camera_bench.h"
#include "emulator/characterise/characterise_setup.h"

namespace hilcam {
namespace {

constexpr SensorSampling kPlateSampling{16, 1, 1};  // the plate has no detail to resolve
constexpr std::uint64_t kNumbersOfASeries = 100'000;

// The benches of one camera, one for each temperature.
class CloneBench {
  public:
    CloneBench(const CameraModel& camera, DetectorPictures pictures, std::uint64_t seed)
        : camera_(on_clone_bench(camera)),
          pictures_(std::move(pictures)),
          seed_(seed),
          setup_(lab_setup(camera_)) {
        setup_.camera = camera_;
        setup_.lamp_w_m2_um = 1;
        e_per_s_ = photons_per_s(setup_, evenly_lit(setup_, lab_selection(setup_))) *
                   configured_quantum_efficiency(setup_);
    }
    void take(const BenchSeries& series, std::uint64_t number, DnImage& frame) {
        const FrameSeries& s = series.settings;
        CameraBench& bench = at(s.temperature_c.value_or(camera_.temperature_c));
        // Setting the light renders nothing but takes a pass of the optics.
        const Exposure exposure{s.exposure_s, s.gain_db, {}, {}};
        if (set_ != &series || bench_set_ != &bench)
            bench.expose(exposure, series.charge_e / (e_per_s_ * s.exposure_s));
        set_ = &series, bench_set_ = &bench;
        const DnImage& taken = bench.frame(number);
        std::copy(taken.all().begin(), taken.all().end(), frame.all().begin());
    }

  private:
    CameraBench& at(double temperature_c) {
        std::unique_ptr<CameraBench>& bench = benches_[temperature_c];
        if (!bench) {
            CameraModel camera = camera_;
            camera.temperature_c = temperature_c;
            bench = std::make_unique<CameraBench>(camera, setup_.grid, kPlateSampling, 1.0, pictures_, seed_);
            bench->show({1, 1, 0});
        }
        return *bench;
    }

    CameraModel camera_;
    DetectorPictures pictures_;
    std::uint64_t seed_;
    LabSetup setup_;
    double e_per_s_ = 0;
    std::map<double, std::unique_ptr<CameraBench>> benches_;
    const BenchSeries* set_ = nullptr;
    const CameraBench* bench_set_ = nullptr;
};

DetectorPictures copy_of(const DetectorPictures& p) {
    DetectorPictures out;
    const auto copy = [](const PixelMap& from, PixelMap& to) {
        if (from.width() == 0) return;
        to = PixelMap(from.width(), from.height());
        std::copy(from.all().begin(), from.all().end(), to.all().begin());
    };
    copy(p.prnu, out.prnu), copy(p.offset_e, out.offset_e), copy(p.dark_e_s, out.dark_e_s);
    out.defects = p.defects;
    return out;
}

}  // namespace

CameraModel on_clone_bench(CameraModel c) {
    c.window_px.clear();
    c.binning_x = c.binning_y = 1;
    c.black_rows = c.black_columns = 0;
    c.jitter = {};
    c.cosmic_rays.rate_cm2_s = 0;
    c.auto_exposure.on = false;
    c.sequence.clear();
    return c;
}

FrameSet bench_frames(const CameraModel& camera, const DetectorPictures& pictures,
                      const std::vector<BenchSeries>& series, std::uint64_t seed) {
    const auto bench = std::make_shared<CloneBench>(camera, copy_of(pictures), seed);
    const auto taken = std::make_shared<std::vector<BenchSeries>>(series);
    FrameSet out;
    out.name = camera.name;
    out.width = static_cast<int>(camera.width_px), out.height = static_cast<int>(camera.height_px);
    out.bits = static_cast<int>(camera.bits);
    for (std::size_t i = 0; i < taken->size(); ++i) {
        FrameSeries s = (*taken)[i].settings;
        s.read = [bench, taken, i](std::size_t k, DnImage& frame) {
            bench->take((*taken)[i], (i + 1) * kNumbersOfASeries + k, frame);
        };
        out.series.push_back(std::move(s));
    }
    return out;
}

}  // namespace hilcam
