#include "sensor/point_light.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr std::size_t kSourcesAtOnce = 8192;
// Number of spots drawn together, in bands of rows: enough for the threads of a bench machine, with bands
// much higher than images that overlap two of them.
constexpr std::size_t kSpotsAtOnce = 8192;
constexpr std::size_t kFewSpots = 64;  // fewer spots are not worth waking threads for

constexpr int kReach = PointSpread::kMaxRadius_px;
constexpr int kAcross = 2 * kReach + 1;
constexpr int kPitch = PointSpread::kField_px;  // numbers from row to row of a patch that includes wings

// Returns the light to subtract around a point: the wings themselves, which are added elsewhere,
// and those of its copies, one in every field, that the table has folded in. Copies outside 25 x 25 fields
// count as a uniform plane beyond the radius of a circle with that square's area; where D falls as r^-3, its
// density integrates to 2 pi R^2 D(R).
std::vector<double> near_wings(const FarWings& wings) {
    constexpr int kCopies = 12;
    constexpr double kField2 = static_cast<double>(PointSpread::kField_px) * PointSpread::kField_px;
    const double radius_px = (2 * kCopies + 1) * PointSpread::kField_px / std::sqrt(kPi);
    const double beyond = 2 * kPi * radius_px * radius_px * wings.density(radius_px) / kField2;
    std::vector<double> out(std::size_t{kAcross} * kPitch);
    for (int y = -kReach; y <= kReach; ++y)
        for (int x = -kReach; x <= kReach; ++x) {
            double sum = beyond;
            for (int j = -kCopies; j <= kCopies; ++j)
                for (int i = -kCopies; i <= kCopies; ++i)
                    sum += wings.density(
                        std::hypot(x - i * PointSpread::kField_px, y - j * PointSpread::kField_px));
            out[static_cast<std::size_t>((y + kReach) * kPitch + x + kReach)] = sum;
        }
    return out;
}

// count: a multiple of eight.
void add_vectors(const float* in, int count, float* out) {
    using Four [[gnu::vector_size(16)]] = float;
    for (int i = 0; i < count; i += 4) {
        Four a, b;
        std::memcpy(&a, in + i, sizeof(a)), std::memcpy(&b, out + i, sizeof(b));
        b += a;
        std::memcpy(out + i, &b, sizeof(b));
    }
}

}  // namespace

PointLight::PointLight(const DetectorView& view, std::vector<LightChannel>& channels,
                       const std::vector<FarWings>& wings, int bins)
    : view_(view),
      channels_(channels),
      bins_(bins),
      glare_e_(channels.size()),
      trails_(view),
      patch_(std::size_t{kAcross} * kPitch) {
    sources_.reserve(kSourcesAtOnce), spots_until_.reserve(kSourcesAtOnce);
    spots_.reserve(kSpotsAtOnce);
    for (std::vector<std::uint32_t>& spots : band_spots_) spots.reserve(kSpotsAtOnce);
    const auto height = static_cast<std::size_t>(view.detector.height_px);
    for (std::size_t band = 0; band < kBands; ++band)
        band_of_row_.resize(height * (band + 1) / kBands, static_cast<std::uint8_t>(band));
    for (const FarWings& w : wings) near_wings_.push_back(near_wings(w));
    if (view.camera.stray_light.has_halo())
        halos_.assign(channels.size(), PointHalos(view.camera.stray_light, view.detector));
}

void PointLight::begin(const Exposure& exposure) {
    exposure_ = exposure;
    jitter_px_ = std::sqrt(jitter_blur_rad2(view_.camera.jitter, exposure.exposure_s)) *
                 view_.detector.focal_length_px;
    // A hundredth of a pixel is invisible.
    if (jitter_px_ < 0.01) jitter_px_ = 0;
    trails_.begin(exposure, jitter_px_);
    std::fill(glare_e_.begin(), glare_e_.end(), 0.0);
    for (PointHalos& halos : halos_) halos.clear();
}

PointLight::Source PointLight::source_of(const PointSource& point, std::size_t c) const {
    const double m = view_.sampling.oversampling;
    const Vec2d middle_px{static_cast<double>(point.position_px.x) / m,
                          static_cast<double>(point.position_px.y) / m};
    Source out{{middle_px, {}, false, 0}, 0, static_cast<int>(c), false};
    if (!std::isfinite(middle_px.x) || !std::isfinite(middle_px.y)) return out;
    out.electrons =
        std::min(channels_[c].electrons_of(point.irradiance_w_m2_um, bins_, exposure_.exposure_s), 1e9);
    if (!(out.electrons > 0)) return out;
    out.wide_halo = !halos_.empty() && out.electrons > halos_[c].min_e();
    const double way = exposure_.exposure_s / m;
    out.trail = trails_.of_sky(middle_px, {way * static_cast<double>(point.drift_px_s.x),
                                           way * static_cast<double>(point.drift_px_s.y)});
    return out;
}

void PointLight::add(std::span<const PointSource> points, ElectronImage& light_e) {
    const std::size_t channels = channels_.size(), at_once = kSourcesAtOnce / channels;
    for (std::size_t first = 0; first < points.size(); first += at_once) {
        const std::span<const PointSource> some =
            points.subspan(first, std::min(at_once, points.size() - first));
        sources_.resize(some.size() * channels), spots_.resize(some.size() * channels);
        // In most exposures each source has one spot, and all are made at once.
        std::atomic<bool> single = trails_.scattered() == 1;
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, some.size(), kFewSpots), [&](const auto& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i)
                for (std::size_t c = 0; c < channels; ++c) {
                    Source& source = sources_[i * channels + c] = source_of(some[i], c);
                    if (source.trail.parts > 1)
                        single = false;
                    else
                        spots_[i * channels + c] =
                            source.trail.parts == 1 ? spot_of(part_of(source, 0), 0) : Spot{};
                }
        });
        if (single)
            finish_spots(light_e);
        else
            draw_sources(light_e);
    }
}

// A bright pixel belongs to the picture and moves with it.
void PointLight::add(const BrightPixel& pixel, ElectronImage& light_e) {
    const Vec2d way_px{exposure_.image_rate_px_s.x * exposure_.exposure_s,
                       exposure_.image_rate_px_s.y * exposure_.exposure_s};
    const PointTrails::Trail trail = PointTrails::straight(pixel.position_px, way_px);
    for (int part = 0; part < trail.parts; ++part)
        for (std::size_t i = 0; i < trails_.scattered(); ++i) {
            const Vec2d px = trails_.scattered_px(trails_.place(trail, part), i);
            const double electrons = pixel.electrons * (1.0 / trail.parts) * trails_.share(i);
            // The electrons already include the fill factor.
            const Spot spot = spot_of(pixel.channel, px, electrons / view_.camera.fill_factor, false);
            glare_e_[static_cast<std::size_t>(pixel.channel)] += spot.glare_e;
            draw(spot, all_rows(), light_e);
            take_off_wings(px, pixel.channel, electrons, light_e);
        }
}

// Spots are numbered over all sources.
void PointLight::draw_sources(ElectronImage& light_e) {
    spots_until_.clear();
    std::size_t count = 0;
    for (const Source& source : sources_)
        spots_until_.push_back(count += static_cast<std::size_t>(source.trail.parts) * trails_.scattered());
    for (std::size_t first = 0; first < count; first += kSpotsAtOnce) {
        spots_.resize(std::min(kSpotsAtOnce, count - first));
        make_spots(first);
        finish_spots(light_e);
    }
}

void PointLight::finish_spots(ElectronImage& light_e) {
    if (view_.camera.stray_light.veiling_glare_fraction > 0)
        for (const Spot& spot : spots_) {
            const auto channel = static_cast<std::size_t>(spot.channel);
            glare_e_[channel] += spot.glare_e;
            if (spot.wide_halo)
                halos_[channel].collect(spot.at_px, spot.electrons * view_.camera.fill_factor);
        }
    draw_spots(light_e);
}

void PointLight::make_spots(std::size_t first_spot) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, spots_.size(), kFewSpots), [&](const auto& range) {
        const std::size_t first = first_spot + range.begin();
        auto until = std::upper_bound(spots_until_.begin(), spots_until_.end(), first);
        auto s = static_cast<std::size_t>(until - spots_until_.begin());
        std::size_t in_source = first - (s > 0 ? spots_until_[s - 1] : 0);
        Part part;
        bool known = false;  // belongs to the present part
        for (std::size_t i = range.begin(); i < range.end(); ++i, ++in_source) {
            for (; first_spot + i >= spots_until_[s]; ++s) in_source = 0, known = false;
            const std::size_t of_part = in_source % trails_.scattered();
            if (of_part == 0 || !known)
                part = part_of(sources_[s], static_cast<int>(in_source / trails_.scattered())), known = true;
            spots_[i] = spot_of(part, of_part);
        }
    });
}

PointLight::Part PointLight::part_of(const Source& source, int number) const {
    const Vec2d place_px = trails_.place(source.trail, number);
    const bool near = std::abs(place_px.x) <= 1e6 && std::abs(place_px.y) <= 1e6;
    const double electrons = source.electrons * (1.0 / source.trail.parts);
    return {place_px, near ? electrons * view_.light_of_point(place_px.x, place_px.y) : 0, source.channel,
            source.wide_halo};
}

PointLight::Spot PointLight::spot_of(const Part& part, std::size_t i) const {
    if (!(part.electrons > 0)) return {};
    return spot_of(part.channel, trails_.scattered_px(part.place_px, i), part.electrons * trails_.share(i),
                   part.wide_halo);
}

PointLight::Spot PointLight::spot_of(int c, Vec2d at_px, double electrons, bool wide_halo) const {
    const StrayLightConfig& stray = view_.camera.stray_light;
    Spot out{at_px, electrons, 0, 0, c, wide_halo, 0};
    if (stray.glare_radius_px <= 0) {
        out.glare_e = electrons * view_.camera.fill_factor * stray.veiling_glare_fraction;
        out.electrons *= 1 - stray.veiling_glare_fraction;
    }
    const LightChannel& channel = channels_[static_cast<std::size_t>(c)];
    const SpiderSpikes& spikes = channel.mtfs.front().spikes();
    constexpr double kSeen_e = 0.02;  // fainter spikes stay in the core
    if (out.electrons * spikes.peak() > kSeen_e) {
        out.spikes_e = spikes.share() * out.electrons;
        out.electrons -= out.spikes_e;
    }
    for (const PointSpread& spread : spreads_of(out))
        out.radius_px = std::max(out.radius_px, spread.radius_for(out.electrons));
    return out;
}

// Sorts spots by the rows that their images touch; charge may cross over to the row before and after.
void PointLight::sort_into_bands() {
    const int height = view_.detector.height_px;
    for (std::vector<std::uint32_t>& spots : band_spots_) spots.clear();
    for (std::size_t i = 0; i < spots_.size(); ++i) {
        const Spot& spot = spots_[i];
        if (spot.radius_px == Spot::kNone) continue;
        const int y = static_cast<int>(std::floor(spot.at_px.y)),
                  reach = (spot.spikes_e > 0 ? std::abs(y) + height : spot.radius_px) + 1;
        if (y + reach < 0 || y - reach >= height) continue;
        const auto band_of = [&](int row) {
            return band_of_row_[static_cast<std::size_t>(std::clamp(row, 0, height - 1))];
        };
        for (std::size_t band = band_of(y - reach); band <= band_of(y + reach); ++band)
            band_spots_[band].push_back(static_cast<std::uint32_t>(i));
    }
}

void PointLight::draw_spots(ElectronImage& light_e) {
    if (spots_.size() < kFewSpots) {
        for (const Spot& spot : spots_)
            if (spot.radius_px != Spot::kNone) draw(spot, all_rows(), light_e);
        return;
    }
    sort_into_bands();
    const auto height = static_cast<std::size_t>(view_.detector.height_px);
    tbb::parallel_for(std::size_t{0}, kBands, [&](std::size_t band) {
        const Rows rows{static_cast<int>(height * band / kBands),
                        static_cast<int>(height * (band + 1) / kBands)};
        for (const std::uint32_t i : band_spots_[band]) draw(spots_[i], rows, light_e);
    });
}

PictureWindow PointLight::window_of(Rows rows, ElectronImage& light_e) const {
    const auto top = static_cast<int>(view_.camera.black_rows),
               left = static_cast<int>(view_.camera.black_columns);
    return {
        0, rows.begin, view_.detector.width_px, rows.end, light_e.row(top).data() + left, light_e.width()};
}

void PointLight::draw(const Spot& spot, Rows rows, ElectronImage& light_e) const {
    const Vec2d at_px = spot.at_px;
    const std::vector<PointSpread>& spreads = spreads_of(spot);
    if (view_.mosaic.one_color() && spreads.size() == 1 && spot.spikes_e == 0 &&
        spreads.front().add(at_px.x, at_px.y, spot.electrons, window_of(rows, light_e)))
        return;
    PointSpread::Room room;
    if (spot.spikes_e > 0) draw_spikes(spot, rows, light_e);
    const double field = spreads.size() > 1 ? view_.lens.field_fraction(at_px.x, at_px.y) : 0;
    for (std::size_t z = 0; z < spreads.size(); ++z) {
        const double weight = zone_weight(view_.camera.field_zones, z, field);
        if (weight > 0)
            add_patch(spreads[z].at(at_px.x, at_px.y, spot.electrons * weight, room), spot.channel, rows,
                      light_e);
    }
}

void PointLight::draw_spikes(const Spot& spot, Rows rows, ElectronImage& light_e) const {
    const auto left = static_cast<std::size_t>(view_.camera.black_columns);
    const int top = static_cast<int>(view_.camera.black_rows);
    const bool one_color = view_.mosaic.one_color();
    channels_[static_cast<std::size_t>(spot.channel)].mtfs.front().spikes().draw(
        spot.at_px.x, spot.at_px.y, spot.spikes_e * view_.camera.fill_factor, view_.detector.width_px,
        {rows.begin, rows.end}, [&](int x, int y, float electrons) {
            if (!one_color && view_.mosaic.channel(x, y) != spot.channel) return;
            light_e.row(y + top)[static_cast<std::size_t>(x) + left] += electrons;
        });
}

void PointLight::take_off_wings(Vec2d at_px, int c, double electrons, ElectronImage& light_e) {
    const std::vector<double>& wings = near_wings_[static_cast<std::size_t>(c)];
    std::transform(wings.begin(), wings.end(), patch_.begin(),
                   [&](double share) { return static_cast<float>(-electrons * share); });
    add_patch({static_cast<int>(std::floor(at_px.x)) - kReach, static_cast<int>(std::floor(at_px.y)) - kReach,
               kAcross, kPitch, patch_.data()},
              c, all_rows(), light_e);
}

// Adds a patch. In a channel of a colour filter array, only its own pixels receive the light; some of their
// charge crosses over to neighbours.
void PointLight::add_patch(const PointPatch& patch, int c, Rows rows, ElectronImage& light_e) const {
    const int width = view_.detector.width_px;
    const auto left = static_cast<int>(view_.camera.black_columns),
               top = static_cast<int>(view_.camera.black_rows);
    const auto crosstalk = static_cast<float>(view_.camera.crosstalk_fraction);
    if (view_.mosaic.one_color()) {
        const int from = std::max(0, -patch.left), to = std::min(patch.size, width - patch.left);
        // Most patches are within the frame, including the zeros beside them, and are added as whole vectors.
        const bool within = from == 0 && patch.left + patch.pitch <= width;
        for (int y = std::max(rows.begin, patch.top); y < std::min(rows.end, patch.top + patch.size); ++y) {
            const float* in = patch.electrons + (y - patch.top) * patch.pitch;
            float* out = light_e.row(y + top).data() + left;
            if (within)
                add_vectors(in, patch.pitch, out + patch.left);
            else
                for (int i = from; i < to; ++i) out[patch.left + i] += in[i];
        }
        return;
    }
    const auto add = [&](int x, int y, float electrons) {
        if (x < 0 || y < rows.begin || x >= width || y >= rows.end) return;
        light_e.row(y + top)[static_cast<std::size_t>(x + left)] += electrons;
    };
    // Charge one pixel outside the rows, or the window, can still cross over into them.
    for (int j = std::max(0, rows.begin - 1 - patch.top); j < std::min(patch.size, rows.end + 1 - patch.top);
         ++j)
        for (int i = std::max(0, -patch.left - 1); i < std::min(patch.size, width + 1 - patch.left); ++i) {
            const int x = patch.left + i, y = patch.top + j;
            if (view_.mosaic.channel(x, y) != c) continue;
            const float electrons = patch.electrons[j * patch.pitch + i];
            add(x, y, (1 - 4 * crosstalk) * electrons);
            if (crosstalk == 0) continue;
            add(x - 1, y, crosstalk * electrons), add(x + 1, y, crosstalk * electrons);
            add(x, y - 1, crosstalk * electrons), add(x, y + 1, crosstalk * electrons);
        }
}

void PointLight::finish_halos(ElectronImage& light_e) {
    bool any = false;
    for (PointHalos& halos : halos_) {
        if (halos.empty()) continue;
        halos.spread();
        any = true;
    }
    if (!any) return;
    const auto left = static_cast<std::size_t>(view_.camera.black_columns);
    const auto top = static_cast<int>(view_.camera.black_rows);
    tbb::parallel_for(tbb::blocked_range<int>(0, view_.detector.height_px, 16), [&](const auto& range) {
        for (int y = range.begin(); y < range.end(); ++y) {
            const std::span<float> row =
                light_e.row(y + top).subspan(left, static_cast<std::size_t>(view_.detector.width_px));
            const int period = view_.mosaic.period(y);
            for (int phase = 0; phase < std::min(period, view_.detector.width_px); ++phase) {
                const PointHalos& halos = halos_[static_cast<std::size_t>(view_.mosaic.channel(phase, y))];
                if (!halos.empty())
                    halos.add_to_row(y, static_cast<std::size_t>(phase), static_cast<std::size_t>(period),
                                     row);
            }
        }
    });
}

void PointLight::finish(ElectronImage& light_e) {
    finish_halos(light_e);
    if (std::all_of(glare_e_.begin(), glare_e_.end(), [](double e) { return e == 0; })) return;
    const double pixels = static_cast<double>(view_.detector.padded_width()) * view_.detector.padded_height();
    for (int y = 0; y < view_.detector.height_px; ++y) {
        float* row =
            light_e.row(y + static_cast<int>(view_.camera.black_rows)).data() + view_.camera.black_columns;
        for (int x = 0; x < view_.detector.width_px; ++x)
            row[x] +=
                static_cast<float>(glare_e_[static_cast<std::size_t>(view_.mosaic.channel(x, y))] / pixels);
    }
}

}  // namespace hilcam
