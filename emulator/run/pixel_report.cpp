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

std::string option(FramePixel pixel) {
    return "--pixel " + std::to_string(pixel.x) + ' ' + std::to_string(pixel.y);
}

// Returns the number of the filter over a pixel. Throws InputError where pixels under different filters are
// binned.
int channel_of(const CameraModel& model, const FrameRaster& lies, int oversampling, FramePixel pixel) {
    const Mosaic mosaic(model);
    const PixelReach x = reach_of(lies.x, pixel.x), y = reach_of(lies.y, pixel.y);
    const int channel = mosaic.channel(x.first / oversampling, y.first / oversampling);
    for (int row = y.first / oversampling; row < y.last / oversampling; ++row)
        for (int column = x.first / oversampling; column < x.last / oversampling; ++column)
            if (mosaic.channel(column, row) != channel)
                throw InputError(option(pixel) +
                                 ": is binned of pixels under several filters; accepted: --set "
                                 "camera.binning_x=1 --set camera.binning_y=1");
    return channel;
}

// Returns the electrons per radiance of a pixel's light in this exposure, by the filter over the pixel.
Spectrum electrons_per_radiance(const StillCamera& camera, FramePixel pixel) {
    const CameraModel& model = camera.scenario().camera;
    const auto oversampling = static_cast<int>(camera.scenario().quality.oversampling);
    const int channel = channel_of(model, raster(camera.scenario()), oversampling, pixel);
    return static_cast<float>(camera.exposure().exposure_s / (1.0 * oversampling * oversampling)) *
           channel_responses(model, camera.grid())[static_cast<std::size_t>(channel)];
}

std::string number(double value, const char* format = "%.4g") {
    char text[32];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

// An object of the renderer by its name.
struct Thing {
    std::string name;
    const LoadedObject* loaded;  // the object with its parts on joints; null: the terrain
};
// The renderer has the scenario's objects, then all their parts on joints, then the terrain
// (scene_loader.cpp).
Thing thing_of(const StillCamera& camera, std::size_t number) {
    const std::vector<ObjectConfig>& objects = camera.scenario().objects;
    if (number < objects.size()) return {"object '" + objects[number].name + "'", &camera.objects()[number]};
    std::size_t part = number - objects.size();
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const std::vector<JointConfig>& joints = objects[i].joints;
        if (part < joints.size())
            return {"object '" + objects[i].name + '/' + joints[part].node + "'", &camera.objects()[i]};
        part -= joints.size();
    }
    return {"the ground", nullptr};
}

// The Sun lights only surfaces, so an entry without one is ground that is alone in the scene
// (ground_light.h).
bool is_ground(const PixelRecord::Entry& entry) {
    return entry.object == PixelRecord::kNoObject && entry.part == LightPart::kSun;
}

// The light that one surface adds to the pixel, split into parts.
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
               surface.triangle == entry.triangle && surface.is_shared == entry.is_shared &&
               is_ground(surface) == is_ground(entry);
    }
};

class Report {
  public:
    Report(const StillCamera& camera, FramePixel pixel, const PixelRecord& record)
        : camera_(camera), is_one_(record.box.x1 - record.box.x0 == 1 && record.box.y1 - record.box.y0 == 1) {
        const Spectrum response = electrons_per_radiance(camera, pixel);
        for (const PixelRecord::Entry& entry : record.entries)
            if (entry.light.bin != Spectrum{}.bin)
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
    bool is_one_;  // the pixel is a single pixel of the image
    std::vector<Group> groups_;
    std::array<double, kLightParts> of_part_{};
    double all_ = 0;
    std::ostringstream out_;

    static int rank(const Group& group) {
        if (is_ground(group.surface)) return 1;
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
        // Always names the brightest entry, because the light in a mirror depends on the mirror. Others below
        // a thousandth of the pixel are only counted.
        constexpr double kMinShare = 1e-3;
        std::size_t count = 0, left_out = 0;
        double left_out_e = 0;
        for (const Group& group : groups_) {
            if (rank(group) != of_rank) continue;
            const bool is_first = count++ == 0;
            if (is_first) out_ << title << '\n';
            if (is_first || std::abs(group.electrons) >= kMinShare * std::abs(all_))
                add_group(group);
            else
                ++left_out, left_out_e += group.electrons;
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
        if (is_ground(group.surface)) out_ << "\n      the ground";
        if (group.surface.object != PixelRecord::kNoObject) out_ << "\n      " << surface_text(group.surface);
        out_ << '\n';
    }

    std::string surface_text(const PixelRecord::Entry& entry) const {
        const Thing thing = thing_of(camera_, entry.object);
        std::ostringstream text;
        text << thing.name;
        if (entry.depth == 0) return text.str() + ", drawn as points";
        if (thing.loaded && entry.surface < thing.loaded->surfaces.size())
            text << ", surface '" << thing.loaded->surfaces[entry.surface].name << "'"
                 << (entry.back ? " (back)" : "");
        const RecordedSurface surface = camera_.renderer().surface_of(entry);
        text << ", triangle " << entry.triangle << " of " << surface.triangles << " at level of detail "
             << surface.level;
        if (surface.level_error_m > 0)
            text << " (off by up to " << number(1e3 * surface.level_error_m) << " mm)";
        text << ", " << number(surface.distance_m, "%.6g") << " m from the camera";
        if (entry.depth == 1 && entry.samples > 0 && is_one_)
            text << ", fills "
                 << number(100.0 * static_cast<double>(entry.samples) / kVisibilitySamples, "%.0f")
                 << " % of the pixel";
        if (entry.depth > 2) text << ", met by the ray of depth " << entry.depth - 1;
        if (entry.alpha > 0) text << ", facets of alpha " << number(static_cast<double>(entry.alpha));
        if (surface.probe)
            text << ", light looked up at probe " << *surface.probe << " (probes "
                 << number(1e3 * surface.probes_apart_m) << " mm apart)";
        return text.str();
    }
};

}  // namespace

PixelBox radiance_pixels(const StillCamera& camera, FramePixel pixel) {
    const FrameRaster lies = raster(camera.scenario());
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= lies.width_px || pixel.y >= lies.height_px)
        throw InputError(option(pixel) + ": the frame has no such pixel; accepted: 0 to " +
                         std::to_string(lies.width_px - 1) + " and 0 to " +
                         std::to_string(lies.height_px - 1));
    const ImageGeometry& image = camera.renderer().geometry();
    const auto lit = [](const PixelReach& all, int size_px) {
        return PixelReach{std::max(all.first, 0), std::min(all.last, size_px)};
    };
    channel_of(camera.scenario().camera, lies, static_cast<int>(camera.scenario().quality.oversampling),
               pixel);
    const PixelReach x = lit(reach_of(lies.x, pixel.x), image.width_px),
                     y = lit(reach_of(lies.y, pixel.y), image.height_px);
    if (x.first >= x.last || y.first >= y.last)
        throw InputError(option(pixel) + ": is a black pixel, which no light reaches; accepted: one beyond " +
                         std::to_string(camera.scenario().camera.black_columns) + " black columns and " +
                         std::to_string(camera.scenario().camera.black_rows) + " black rows");
    const int guard_px = image.guard_px;
    return {x.first + guard_px, y.first + guard_px, x.last + guard_px, y.last + guard_px};
}

std::string pixel_report(const StillCamera& camera, FramePixel pixel, const PixelRecord& record) {
    return "pixel " + std::to_string(pixel.x) + ' ' + std::to_string(pixel.y) + " of " +
           camera.scenario().name + ": electrons of its own light on the axis, before the lens blurs it\n" +
           Report(camera, pixel, record).text();
}

}  // namespace hilcam
