#include "emulator/run/pixel_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "emulator/run/still_camera.h"
#include "sensor/mosaic.h"
#include "sensor/optics.h"
#include "sensor/published_frame.h"

namespace hilcam {
namespace {

FrameRaster raster(const ScenarioConfig& s) {
    return raster_of(s.camera, static_cast<int>(s.quality.oversampling),
                     {s.camera.binning_x, s.camera.binning_y});
}

// Pixels of the image along one axis that a pixel of the frame is made of.
struct Reach {
    int first, last;  // the one after it
};
Reach reach_of(const RasterAxis& axis, int frame_px, int guard_px) {
    const double a = axis.image_px(frame_px), b = axis.image_px(frame_px + 1);
    return {static_cast<int>(std::lround(std::min(a, b))) + guard_px,
            static_cast<int>(std::lround(std::max(a, b))) + guard_px};
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

class Report {
  public:
    Report(const StillCamera& camera, FramePixel pixel, const PixelRecord& record)
        : camera_(camera), response_(electrons_per_radiance(camera, pixel)), entries_(record.entries) {
        std::stable_sort(entries_.begin(), entries_.end(), [&](const auto& a, const auto& b) {
            return a.part != b.part ? a.part < b.part : electrons(a) > electrons(b);
        });
        for (const PixelRecord::Entry& entry : entries_) {
            if (entry.is_shared) continue;
            of_part_[static_cast<std::size_t>(entry.part)] += electrons(entry);
            all_ += electrons(entry);
        }
    }

    std::string text() {
        add_sums();
        out_ << "\n";
        for (std::size_t i = 0; i < kLightParts; ++i) add_entries(static_cast<LightPart>(i));
        return out_.str();
    }

  private:
    const StillCamera& camera_;
    Spectrum response_;
    std::vector<PixelRecord::Entry> entries_;
    std::array<double, kLightParts> of_part_{};
    double all_ = 0;
    std::ostringstream out_;

    double electrons(const PixelRecord::Entry& entry) const {
        return static_cast<double>(sum_of_products(response_, entry.light));
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

    void add_entries(LightPart part) {
        // What is less than a thousandth of the pixel is counted alone.
        constexpr double kLeast = 1e-3;
        std::size_t left_out = 0;
        double left_out_e = 0;
        for (const PixelRecord::Entry& entry : entries_) {
            if (entry.part != part) continue;
            if (std::abs(electrons(entry)) < kLeast * std::abs(all_)) {
                ++left_out, left_out_e += entry.is_shared ? 0 : electrons(entry);
                continue;
            }
            add_entry(entry);
        }
        if (left_out > 0)
            out_ << name_of(part) << ": " << left_out << (left_out == 1 ? " entry" : " entries")
                 << " below a thousandth of the pixel, " << number(left_out_e, "%.1f") << " e- in all\n";
    }

    void add_entry(const PixelRecord::Entry& entry) {
        out_ << name_of(entry.part) << "  " << number(electrons(entry), "%.1f") << " e-";
        if (entry.count > 1) out_ << " (" << entry.count << " times)";
        if (entry.is_shared)
            out_ << ", found by rays that pixels share; what this pixel gets of it is in rays.glossy";
        if (entry.depth > 1) out_ << ", met by a ray from surface " << entry.depth - 1;
        if (entry.object == PixelRecord::kNoObject) {
            out_ << "\n";
            return;
        }
        add_surface(entry);
    }

    void add_surface(const PixelRecord::Entry& entry) {
        const std::vector<LoadedObject>& objects = camera_.objects();
        const bool is_loaded = entry.object < objects.size();
        out_ << "\n    "
             << (is_loaded ? "object '" + objects[entry.object].name + "'" : std::string("the ground"));
        if (entry.depth == 0) {
            out_ << ", drawn as points\n";
            return;
        }
        if (is_loaded && entry.surface < objects[entry.object].surfaces.size())
            out_ << ", surface '" << objects[entry.object].surfaces[entry.surface].name << "'"
                 << (entry.back ? " (back)" : "");
        const RecordedSurface surface = camera_.renderer().surface_of(entry);
        out_ << ", triangle " << entry.triangle << " of " << surface.triangles << " at level of detail "
             << surface.level;
        if (surface.level_error_m > 0)
            out_ << " (off by up to " << number(1e3 * surface.level_error_m) << " mm)";
        out_ << ", " << number(surface.distance_m, "%.6g") << " m away";
        if (entry.depth == 1)
            out_ << ", seen by " << number(100.0 * static_cast<double>(entry.samples) / 16, "%.0f")
                 << " % of a pixel";
        if (entry.alpha > 0) out_ << ", facets of alpha " << number(static_cast<double>(entry.alpha));
        if (surface.node)
            out_ << ", light looked up at place " << *surface.node << " (places "
                 << number(1e3 * surface.nodes_apart_m) << " mm apart)";
        out_ << "\n";
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
    const Reach x = reach_of(lies.x, pixel.x, guard_px), y = reach_of(lies.y, pixel.y, guard_px);
    return {x.first, y.first, x.last, y.last};
}

std::string pixel_report(const StillCamera& camera, FramePixel pixel, const PixelRecord& record) {
    return "pixel " + std::to_string(pixel.x) + ' ' + std::to_string(pixel.y) + " of " +
           camera.scenario().name + ": electrons of its own light on the axis, before the lens blurs it\n" +
           Report(camera, pixel, record).text();
}

}  // namespace hilcam
