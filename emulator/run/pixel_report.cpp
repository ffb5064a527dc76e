#include "emulator/run/pixel_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "emulator/run/still_camera.h"
#include "render/visibility/pixel_samples.h"
#include "sensor/mosaic.h"
#include "sensor/optics.h"
#include "sensor/published_frame.h"

namespace hilcam {
namespace {

FrameRaster raster(const ScenarioConfig& s) {
    return raster_of(s.camera, static_cast<int>(s.quality.oversampling),
                     {s.camera.binning_x, s.camera.binning_y});
}

// Electrons per radiance of a pixel's light in this exposure; of a detector with filters, by that over the pixel.
Spectrum electrons_per_radiance(const StillCamera& camera, FramePixel pixel) {
    const CameraModel& model = camera.scenario().camera;
    const FrameRaster lies = raster(camera.scenario());
    const double oversampling = static_cast<double>(camera.scenario().quality.oversampling);
    const auto on_array = [&](const RasterAxis& axis, int at) {
        return static_cast<int>(std::floor(axis.image_px(at + 0.5) / oversampling));
    };
    const int channel = Mosaic(model).channel(on_array(lies.x, pixel.x), on_array(lies.y, pixel.y));
    return static_cast<float>(camera.exposure().exposure_s / (oversampling * oversampling)) *
           channel_responses(model, camera.grid())[static_cast<std::size_t>(channel)];
}

std::string number(double value, const char* format = "%.4g") {
    char text[32];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

// A surface, and the light that it adds to the pixel, part by part.
struct Group {
    PixelRecord::Entry surface;  // the first of its entries
    struct Share {
        LightPart part;
        double electrons;
    };
    std::vector<Share> shares;
    double electrons = 0;

    bool is_of(const PixelRecord::Entry& entry) const {
        return surface.depth == entry.depth && surface.object == entry.object &&
               surface.triangle == entry.triangle && surface.is_shared == entry.is_shared;
    }
};

class Report {
  public:
    Report(const StillCamera& camera, FramePixel pixel, const PixelRecord& record) : camera_(camera) {
        const Spectrum response = electrons_per_radiance(camera, pixel);
        for (const PixelRecord::Entry& entry : record.entries)
            take(entry, static_cast<double>(sum_of_products(response, entry.light)));
        std::stable_sort(groups_.begin(), groups_.end(), [](const Group& a, const Group& b) {
            return rank(a) != rank(b) ? rank(a) < rank(b) : a.electrons > b.electrons;
        });
    }

    std::string text() {
        add_sums();
        add_groups(0, "Without a surface of the scene:");
        add_groups(1, "Sent by what the camera sees:");
        add_groups(2, "Found by rays from there:");
        add_groups(3,
                   "Met by glossy rays that pixels share, as found; rays.glossy above is what this pixel "
                   "gets of it:");
        return out_.str();
    }

  private:
    const StillCamera& camera_;
    std::vector<Group> groups_;
    std::array<double, kLightParts> of_part_{};
    double all_ = 0;
    std::ostringstream out_;

    static int rank(const Group& group) {
        return group.surface.is_shared ? 3 : std::min(group.surface.depth, 2);
    }

    void take(const PixelRecord::Entry& entry, double electrons) {
        if (!entry.is_shared) of_part_[static_cast<std::size_t>(entry.part)] += electrons, all_ += electrons;
        auto group =
            std::find_if(groups_.begin(), groups_.end(), [&](const Group& g) { return g.is_of(entry); });
        if (group == groups_.end()) group = groups_.insert(groups_.end(), Group{entry, {}, 0});
        group->shares.push_back({entry.part, electrons});
        group->electrons += electrons;
    }

    void add_sums() {
        char line[128];
        for (std::size_t i = 0; i < kLightParts; ++i) {
            if (of_part_[i] == 0) continue;
            std::snprintf(line, sizeof line, "  %-22s %12.1f e- %6.1f %%\n", kLightPartNames[i].data(),
                          of_part_[i], all_ > 0 ? 100 * of_part_[i] / all_ : 0.0);
            out_ << line;
        }
        std::snprintf(line, sizeof line, "  %-22s %12.1f e-\n", "sum", all_);
        out_ << line;
    }

    void add_groups(int of_rank, const char* title) {
        // What is less than a thousandth of the pixel is counted alone.
        constexpr double kLeast = 1e-3;
        std::size_t count = 0, left_out = 0;
        double left_out_e = 0;
        for (const Group& group : groups_) {
            if (rank(group) != of_rank) continue;
            if (count++ == 0) out_ << title << '\n';
            if (std::abs(group.electrons) < kLeast * std::abs(all_))
                ++left_out, left_out_e += group.electrons;
            else
                add_group(group);
        }
        if (left_out > 0)
            out_ << "  " << left_out
                 << " more below a thousandth of the pixel each: " << number(left_out_e, "%.1f") << " e-\n";
    }

    void add_group(const Group& group) {
        out_ << "  ";
        for (std::size_t i = 0; i < group.shares.size(); ++i)
            out_ << (i > 0 ? ", " : "") << name_of(group.shares[i].part) << ' '
                 << number(group.shares[i].electrons, "%.1f") << " e-";
        if (group.surface.object != PixelRecord::kNoObject) out_ << "\n      " << surface_text(group.surface);
        out_ << '\n';
    }

    std::string surface_text(const PixelRecord::Entry& entry) const {
        const std::vector<LoadedObject>& objects = camera_.objects();
        const bool is_loaded = entry.object < objects.size();
        std::ostringstream text;
        text << (is_loaded ? "object '" + objects[entry.object].name + "'" : std::string("the ground"));
        if (entry.depth == 0) return text.str() + ", drawn as points";
        if (is_loaded && entry.surface < objects[entry.object].surfaces.size())
            text << ", surface '" << objects[entry.object].surfaces[entry.surface].name << "'"
                 << (entry.back ? " (back)" : "");
        const RecordedSurface surface = camera_.renderer().surface_of(entry);
        text << ", triangle " << entry.triangle << " of " << surface.triangles << " at level of detail "
             << surface.level;
        if (surface.level_error_m > 0)
            text << " (off by up to " << number(1e3 * surface.level_error_m) << " mm)";
        text << ", " << number(surface.distance_m, "%.6g") << " m from the camera";
        if (entry.depth == 1)
            text << ", fills "
                 << number(100.0 * static_cast<double>(entry.samples) / kVisibilitySamples, "%.0f")
                 << " % of the pixel";
        if (entry.depth > 2) text << ", met by the ray of depth " << entry.depth - 1;
        if (entry.alpha > 0) text << ", facets of alpha " << number(static_cast<double>(entry.alpha));
        if (surface.node)
            text << ", light looked up at place " << *surface.node << " (places "
                 << number(1e3 * surface.nodes_apart_m) << " mm apart)";
        return text.str();
    }
};

}  // namespace

PixelBox radiance_pixels(const StillCamera& camera, FramePixel pixel) {
    const FrameRaster lies = raster(camera.scenario());
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= lies.width_px || pixel.y >= lies.height_px)
        throw InputError("--pixel " + std::to_string(pixel.x) + ' ' + std::to_string(pixel.y) +
                         ": the frame has no such pixel; accepted: 0 to " +
                         std::to_string(lies.width_px - 1) + " and 0 to " +
                         std::to_string(lies.height_px - 1));
    const int guard_px = camera.renderer().geometry().guard_px;
    const PixelReach x = reach_of(lies.x, pixel.x), y = reach_of(lies.y, pixel.y);
    return {x.first + guard_px, y.first + guard_px, x.last + guard_px, y.last + guard_px};
}

std::string pixel_report(const StillCamera& camera, FramePixel pixel, const PixelRecord& record) {
    return "pixel " + std::to_string(pixel.x) + ' ' + std::to_string(pixel.y) + " of " +
           camera.scenario().name + ": electrons of its own light on the axis, before the lens blurs it\n" +
           Report(camera, pixel, record).text();
}

}  // namespace hilcam
