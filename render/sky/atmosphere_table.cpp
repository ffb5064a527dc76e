#include "render/sky/atmosphere_table.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "render/sky/atmosphere_models.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// From this height on, viewers count as being at the table's largest height.
constexpr double kAbove_m = 100e3;

using Geometry = std::array<double, AtmosphereTable::kAxes>;
constexpr std::array<const char*, AtmosphereTable::kAxes> kNames = {
    "zenith angle of the Sun", "zenith angle of the viewer", "azimuth", "height of the viewer"};

double angle_rad_between(Vec3d a, Vec3d b) { return std::acos(std::clamp(dot(a, b), -1.0, 1.0)); }

// Returns the angles at the ground point of a ray. to_viewer, sun_dir: unit.
Geometry geometry_of(Vec3d ground_m, Vec3d to_viewer, Vec3d sun_dir, double viewer_height_m) {
    const Vec3d up = normalized(ground_m);
    const Vec3d viewer = to_viewer - dot(to_viewer, up) * up, sun = sun_dir - dot(sun_dir, up) * up;
    const double lengths = length(viewer) * length(sun);
    const double azimuth = lengths > 1e-9 ? std::acos(std::clamp(dot(viewer, sun) / lengths, -1.0, 1.0)) : 0;
    return {angle_rad_between(sun_dir, up), angle_rad_between(to_viewer, up), azimuth, viewer_height_m};
}

class TableAtmosphere final : public Atmosphere {
  public:
    explicit TableAtmosphere(const AtmosphereTable& table) : table_(table) {}

    // Outside the air the height does not matter.
    double height_m(Vec3d origin_m) const {
        const double height = length(origin_m) - kEarthEquatorialRadius_m;
        return height >= kAbove_m ? std::max(height, table_.axes[AtmosphereTable::kHeight].back()) : height;
    }

    double top_m() const override { return kAbove_m; }

    Sight look(Vec3d origin_m, Vec3d dir, double distance_m, Vec3d sun_dir) const override {
        Sight out;
        out.transmittance.bin.fill(1);
        if (!std::isfinite(distance_m)) return out;
        const Vec3d ground = origin_m + distance_m * dir;
        // An object in front of the ground: the table covers only the whole path.
        if (length(ground) > kEarthEquatorialRadius_m + 1000) return out;
        const AtmosphereTable::Cell cell = at(geometry_of(ground, -dir, sun_dir, height_m(origin_m)));
        out.transmittance = cell.tau_2;
        out.radiance_sr = cell.radiance_sr;
        return out;
    }
    Spectrum sun_transmittance(Vec3d point_m, Vec3d sun_dir) const override {
        const Vec3d up = normalized(point_m);
        if (length(point_m) > kEarthEquatorialRadius_m + 1000) {
            Spectrum clear;
            clear.bin.fill(1);
            return clear;
        }
        if (dot(up, sun_dir) <= 0) return {};
        return at(straight_down(point_m, sun_dir)).tau_1;
    }
    Spectrum sky_irradiance(Vec3d point_m, Vec3d sun_dir) const override {
        if (dot(point_m, sun_dir) <= 0) return {};
        return at(straight_down(point_m, sun_dir)).sky;
    }
    std::string missing(Vec3d origin_m, Vec3d dir, double distance_m, Vec3d sun_dir) const override {
        if (!std::isfinite(distance_m)) return {};
        const Vec3d ground = origin_m + distance_m * dir;
        if (dot(ground, sun_dir) <= 0) return {};  // night
        const Geometry g = geometry_of(ground, -dir, sun_dir, height_m(origin_m));
        for (std::size_t k = 0; k < g.size(); ++k) {
            const std::vector<double>& axis = table_.axes[k];
            const bool is_height = k == AtmosphereTable::kHeight;
            if (g[k] >= axis.front() - 1e-9 && (is_height || g[k] <= axis.back() + 1e-9)) continue;
            const double unit = is_height ? 1000 : kDegree_rad;
            return std::string(kNames[k]) + " of " + std::to_string(g[k] / unit) +
                   "; the table reaches from " + std::to_string(axis.front() / unit) + " to " +
                   std::to_string(axis.back() / unit) + (is_height ? " km" : " deg");
        }
        return {};
    }
    std::uint64_t rays_outside() const override { return outside_.load(std::memory_order_relaxed); }
    std::string describe() const override {
        return "table of " + std::to_string(table_.cells.size()) +
               " geometries; rays that miss the ground are clear";
    }

  private:
    AtmosphereTable table_;
    mutable std::atomic<std::uint64_t> outside_{0};

    // tau_1 and the sky do not depend on the viewer: values for a vertical view from the largest height.
    Geometry straight_down(Vec3d point_m, Vec3d sun_dir) const {
        return {angle_rad_between(normalized(point_m), sun_dir),
                table_.axes[AtmosphereTable::kViewZenith].front(),
                table_.axes[AtmosphereTable::kAzimuth].front(), table_.axes[AtmosphereTable::kHeight].back()};
    }

    AtmosphereTable::Cell at(const Geometry& g) const {
        std::array<std::size_t, AtmosphereTable::kAxes> low{}, high{};
        std::array<float, AtmosphereTable::kAxes> share{};
        bool inside = true;
        for (std::size_t k = 0; k < g.size(); ++k) {
            const std::vector<double>& axis = table_.axes[k];
            inside &=
                g[k] >= axis.front() - 1e-9 && (k == AtmosphereTable::kHeight || g[k] <= axis.back() + 1e-9);
            const double value = std::clamp(g[k], axis.front(), axis.back());
            const auto above = std::upper_bound(axis.begin(), axis.end(), value);
            high[k] = static_cast<std::size_t>(std::min(above, axis.end() - 1) - axis.begin());
            low[k] = above == axis.begin() ? 0 : static_cast<std::size_t>(above - axis.begin()) - 1;
            const double step = axis[high[k]] - axis[low[k]];
            share[k] = step > 0 ? static_cast<float>((value - axis[low[k]]) / step) : 0.0f;
        }
        if (!inside) outside_.fetch_add(1, std::memory_order_relaxed);
        AtmosphereTable::Cell out;
        for (unsigned corner = 0; corner < 16; ++corner) {
            float weight = 1;
            std::size_t index = 0;
            for (std::size_t k = 0; k < g.size(); ++k) {
                const bool upper = (corner >> k & 1u) != 0;
                weight *= upper ? share[k] : 1 - share[k];
                index = index * table_.axes[k].size() + (upper ? high[k] : low[k]);
            }
            if (weight <= 0) continue;
            const AtmosphereTable::Cell& cell = table_.cells[index];
            out.tau_1 += weight * cell.tau_1;
            out.tau_2 += weight * cell.tau_2;
            out.radiance_sr += weight * cell.radiance_sr;
            out.sky += weight * cell.sky;
        }
        return out;
    }
};

}  // namespace

std::unique_ptr<Atmosphere> make_table_atmosphere(const AtmosphereRequest& request) {
    HILCAM_CHECK(request.table != nullptr);
    return std::make_unique<TableAtmosphere>(*request.table);
}

}  // namespace hilcam
