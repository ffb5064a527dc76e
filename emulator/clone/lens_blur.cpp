#include "emulator/clone/lens_blur.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/units.h"
#include "sensor/optics.h"
#include "sensor/optics_otf.h"
#include "sensor/system_mtf.h"

namespace hilcam {
namespace {

constexpr double kFirst_cy_px = 0.05, kLast_cy_px = 0.5;  // frequencies that count
constexpr double kModelError =
    0.003;  // error of the edge's method; keeps quiet frequencies from ruling the fit
constexpr int kBlurSteps = 24;
constexpr double kSameHeight = 0.06;  // pieces of this difference in image height are one zone

// Eight bins over the wavelengths that the camera sees.
SpectralGrid seen_grid(const CameraModel& camera) {
    constexpr double kFirst_um = 0.35, kLast_um = 1.1, kStep_um = 0.005;
    double first = kLast_um, last = kFirst_um;
    for (double um = kFirst_um; um < kLast_um; um += kStep_um)
        if (camera.quantum_efficiency.at(um) * camera.transmission.at(um) > 0)
            first = std::min(first, um), last = std::max(last, um + kStep_um);
    if (first >= last) first = 0.5, last = 0.6;
    std::vector<double> edges;
    for (int i = 0; i <= kMaxBins; ++i) edges.push_back(first + (last - first) * i / kMaxBins);
    return SpectralGrid(edges);
}

CameraModel without_blur(CameraModel camera) {
    camera.defocus_m = camera.wavefront_rms_m = 0;
    camera.zernike_m.clear(), camera.field_zones.clear(), camera.measured_mtf.mtf = {};
    camera.stray_light = {}, camera.jitter = {};
    return camera;
}

// MTF of the camera at a piece's frequencies for steps of the blur. Both kinds lower the MTF by about the
// square of the blur, so the square is the variable: it is found without bias, below zero as well.
struct BlurTable {
    std::vector<double> square_m2;         // square of the blur at each step
    std::vector<std::vector<double>> mtf;  // curve at each step
};

class BlurModel {
  public:
    explicit BlurModel(const CameraModel& camera)
        : camera_(without_blur(camera)),
          grid_(seen_grid(camera_)),
          response_(channel_responses(camera_, grid_).front()) {}

    // The lenses are the same for all pieces, and take long to compute.
    void prepare(BlurKind kind) {
        const double wavelength_m = 0.5e-6 * (grid_.from_um(0) + grid_.to_um(grid_.size() - 1));
        // A wavefront error up to 0.25 waves; a defocus up to three waves at the pupil's edge.
        const double most = kind == BlurKind::kWavefront ? 0.25 * wavelength_m
                                                         : 3 * wavelength_m * 8 * square(camera_.f_number);
        square_m2_.clear(), lenses_.clear();
        for (int i = 0; i <= kBlurSteps; ++i) {
            const double blur = most * i / kBlurSteps;
            const LensState lens = kind == BlurKind::kWavefront ? LensState{0, blur} : LensState{blur, 0};
            square_m2_.push_back(square(blur));
            lenses_.emplace_back(camera_, OpticsOtf(camera_, grid_, response_, lens));
        }
    }
    BlurTable table(const EdgeMtf& at) const {
        BlurTable out{square_m2_, {}};
        for (const SystemMtf& mtf : lenses_) {
            out.mtf.emplace_back();
            for (const double f : at.frequency_cy_px)
                out.mtf.back().push_back(
                    std::abs(mtf.at(f * std::cos(at.normal_rad), f * std::sin(at.normal_rad))));
        }
        return out;
    }

  private:
    CameraModel camera_;
    SpectralGrid grid_;
    Spectrum response_;
    std::vector<double> square_m2_;
    std::vector<SystemMtf> lenses_;
};

bool counts(double f) { return f > kFirst_cy_px - 1e-9 && f < kLast_cy_px + 1e-9; }

struct BlurFit {
    double square_m2 = 0, cost = 0;
};
// Weighted least squares; between two steps the MTF is linear in the square.
BlurFit fit(const BlurTable& table, const EdgeMtf& at, const std::vector<double>& mtf) {
    BlurFit best{0, 1e300};
    for (std::size_t s = 0; s + 1 < table.mtf.size(); ++s) {
        double ab = 0, bb = 0;
        const auto weight = [&](std::size_t k) {
            return counts(at.frequency_cy_px[k]) ? 1 / (square(at.uncertainty[k]) + square(kModelError))
                                                 : 0.0;
        };
        for (std::size_t k = 0; k < mtf.size(); ++k) {
            const double slope = table.mtf[s + 1][k] - table.mtf[s][k];
            ab += weight(k) * slope * (mtf[k] - table.mtf[s][k]), bb += weight(k) * slope * slope;
        }
        if (!(bb > 0)) continue;
        // The first stretch goes on below zero: a lens that is sharper than its aperture allows is noise.
        const double part = std::clamp(ab / bb, s == 0 ? -1e3 : 0.0, 1.0);
        double cost = 0;
        for (std::size_t k = 0; k < mtf.size(); ++k)
            cost +=
                weight(k) * square(mtf[k] - table.mtf[s][k] - part * (table.mtf[s + 1][k] - table.mtf[s][k]));
        if (cost < best.cost)
            best = {table.square_m2[s] + part * (table.square_m2[s + 1] - table.square_m2[s]), cost};
    }
    return best;
}

std::vector<double> at_square(const BlurTable& table, double square_m2) {
    std::size_t s = 0;
    while (s + 2 < table.square_m2.size() && table.square_m2[s + 1] < square_m2) ++s;
    const double part = std::clamp(
        (square_m2 - table.square_m2[s]) / (table.square_m2[s + 1] - table.square_m2[s]), 0.0, 1.0);
    std::vector<double> out;
    for (std::size_t k = 0; k < table.mtf[s].size(); ++k)
        out.push_back((1 - part) * table.mtf[s][k] + part * table.mtf[s + 1][k]);
    return out;
}

// The blur and its error from those of its square.
Measured root(double square_m2, double error_m2) {
    const double value = std::sqrt(std::max(square_m2, 0.0));
    if (value * value > 2 * error_m2) return {value, error_m2 / (2 * value)};
    return {value, std::sqrt(value * value + error_m2) - value};
}

struct FittedPiece {
    double field_fraction = 0, square_m2 = 0, error_m2 = 0, cost = 0;
    LensZone zone;
};

FittedPiece fit_piece(const BlurModel& model, const PlacedPiece& placed) {
    const EdgeMtf& m = placed.piece.mtf;
    const BlurTable table = model.table(m);
    const BlurFit whole = fit(table, m, m.mtf);
    std::vector<double> without;
    for (const std::vector<double>& one : placed.piece.without)
        without.push_back(fit(table, m, one).square_m2);
    FittedPiece out{placed.field_fraction, whole.square_m2, jackknife_uncertainty(without), whole.cost, {}};
    out.zone.field_fraction = placed.field_fraction;
    out.zone.blur_m = root(out.square_m2, out.error_m2);
    const std::vector<double> described = at_square(table, out.square_m2);
    double sum = 0, count = 0;
    for (std::size_t k = 0; k < m.mtf.size() && m.frequency_cy_px[k] < kLast_cy_px + 1e-9; ++k) {
        out.zone.frequency_cy_px.push_back(m.frequency_cy_px[k]);
        out.zone.mtf.push_back(m.mtf[k]), out.zone.uncertainty.push_back(m.uncertainty[k]);
        out.zone.described.push_back(described[k]);
        sum += square(m.mtf[k] - described[k]), ++count;
    }
    out.zone.misfit = std::sqrt(sum / std::max(count, 1.0));
    return out;
}

// Pieces at nearly the same image height become one zone, with the curve of the best measured one.
std::vector<LensZone> zones_of(std::vector<FittedPiece> pieces) {
    std::sort(pieces.begin(), pieces.end(),
              [](const FittedPiece& a, const FittedPiece& b) { return a.field_fraction < b.field_fraction; });
    std::vector<LensZone> out;
    for (std::size_t i = 0; i < pieces.size();) {
        std::size_t end = i + 1;
        while (end < pieces.size() && pieces[end].field_fraction - pieces[i].field_fraction < kSameHeight)
            ++end;
        double weights = 0, sum = 0, height = 0;
        const FittedPiece* best = &pieces[i];
        for (std::size_t k = i; k < end; ++k) {
            const double w = 1 / std::max(square(pieces[k].error_m2), 1e-40);
            weights += w, sum += w * pieces[k].square_m2, height += w * pieces[k].field_fraction;
            if (pieces[k].error_m2 < best->error_m2) best = &pieces[k];
        }
        // Errors of pieces that differ by more than they state are as large as that difference.
        double scatter = 0;
        for (std::size_t k = i; k < end; ++k)
            scatter += square((pieces[k].square_m2 - sum / weights) / std::max(pieces[k].error_m2, 1e-20));
        const auto n = static_cast<double>(end - i);
        const double larger = n > 1 ? std::max(1.0, scatter / (n - 1)) : 1;
        LensZone zone = best->zone;
        zone.field_fraction = height / weights;
        zone.blur_m = root(sum / weights, std::sqrt(larger / weights));
        out.push_back(std::move(zone));
        i = end;
    }
    return out;
}

}  // namespace

LensBlur fit_lens_blur(const CameraModel& camera, const std::vector<PlacedPiece>& pieces) {
    BlurModel model(camera);
    const auto fitted = [&](BlurKind kind) {
        model.prepare(kind);
        std::vector<FittedPiece> out;
        for (const PlacedPiece& piece : pieces) out.push_back(fit_piece(model, piece));
        return out;
    };
    const auto cost = [](const std::vector<FittedPiece>& all) {
        double sum = 0;
        for (const FittedPiece& one : all) sum += one.cost;
        return sum;
    };
    std::vector<FittedPiece> wavefront = fitted(BlurKind::kWavefront);
    constexpr double kWellDescribed = 0.01;  // rms of the MTF; a second fit would take as long as the first
    if (std::all_of(wavefront.begin(), wavefront.end(),
                    [&](const FittedPiece& p) { return p.zone.misfit < kWellDescribed; }))
        return {BlurKind::kWavefront, zones_of(std::move(wavefront))};
    std::vector<FittedPiece> defocus = fitted(BlurKind::kDefocus);
    // Small errors of both kinds look alike; a defocus has to be clearly better.
    if (cost(defocus) < 0.5 * cost(wavefront)) return {BlurKind::kDefocus, zones_of(std::move(defocus))};
    return {BlurKind::kWavefront, zones_of(std::move(wavefront))};
}

}  // namespace hilcam
