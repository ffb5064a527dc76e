#include "emulator/campaign/picture_case.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "emulator/campaign/case_search.h"
#include "emulator/campaign/noise_variance.h"
#include "emulator/campaign/optical_flow.h"
#include "emulator/campaign/run_lengths.h"
#include "emulator/campaign/view_draw.h"
#include "emulator/run/picture_run.h"
#include "emulator/run/truth_source.h"
#include "io/images/image_file.h"
#include "io/system/durable_file.h"
#include "io/truth/truth_files.h"
#include "render/vocabulary/stopwatch.h"
#include "render/vocabulary/units.h"
#include "sensor/published_frame.h"

namespace hilcam {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr std::uint64_t kFirstOtherPaths = 1'000'000;  // no camera of a bench has a seed of that number

constexpr std::array kFrameEndings = {".png", ".tiff", ".fits", ".raw"};

bool wants(const std::vector<std::string>& words, const char* word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

// Masks, shares of light and hidden points need the first three layers; the others are written.
TruthRequest asked_layers(const CampaignConfig& c) {
    TruthRequest request;
    request.stars = false;
    request.visibility = request.object = request.normal = request.depth = true;
    request.range = wants(c.pictures.layers, "range");
    request.position = c.pictures.flow || wants(c.pictures.layers, "position");
    request.part = c.pictures.flow;
    request.silhouettes = wants(c.labels, "bop");
    return request;
}

FrameRecord record_of_picture(const ScenarioConfig& s, const StillCamera& camera, std::uint64_t id) {
    FrameRecord record;
    record.id = id;
    record.exposure_mid = camera.time();
    record.camera = camera.shown_camera();
    record.black_level_dn = camera.exposure().black_level_dn.value_or(s.camera.offset_dn);
    record.exposure_s = camera.exposure().exposure_s;
    record.gain_db = camera.exposure().gain_db;
    record.bits = s.camera.frame_bits();
    record.binning_x = s.camera.binning_x, record.binning_y = s.camera.binning_y;
    return record;
}

// The target's brightness: the mean electrons of its pixels that face the Sun, before noise.
struct Brightness {
    double signal_e = 0, snr = 0, saturated_fraction = 0;
};
Brightness brightness_of(CaseCamera& camera, const FrameTruth& truth, const SeenThing& target,
                         const ElectronImage& electrons, double exposure_s) {
    const ScenarioConfig& s = camera.scenario();
    const CameraSheet& sheet = camera.sheet();
    const Vec3f sun = to_float(truth.sun_camera_dir);
    const auto binning_x = s.camera.binning_x, binning_y = s.camera.binning_y;
    double sum_e = 0;
    std::uint64_t lit = 0, saturated = 0;
    for (int y = 0; y < truth.raster.height_px; ++y)
        for (std::size_t x = 0; x < static_cast<std::size_t>(truth.raster.width_px); ++x) {
            if (truth.layers.object.row(y)[x] != target.id) continue;
            const DirectionImage& normal = truth.layers.normal;
            if (!(normal.row(y, 0)[x] * sun.x + normal.row(y, 1)[x] * sun.y + normal.row(y, 2)[x] * sun.z >
                  0))
                continue;
            // The first of the binned pixels stands for all of them.
            const auto ey = static_cast<int>(y * binning_y);
            const auto ex = static_cast<std::size_t>(static_cast<std::int64_t>(x) * binning_x);
            if (ey >= electrons.height() || ex >= static_cast<std::size_t>(electrons.width())) continue;
            const auto e = static_cast<double>(electrons.row(ey)[ex]);
            sum_e += e, ++lit;
            if (e >= sheet.full_scale_e) ++saturated;
        }
    if (lit == 0) return {};
    Brightness out;
    const double mean_e = sum_e / static_cast<double>(lit);
    out.signal_e = std::max(0.0, mean_e - sheet.dark_e_s * exposure_s);
    const double held_e = std::min(out.signal_e, sheet.full_scale_e);
    // The dark current in the sheet belongs to the sheet's own exposure.
    const double dark_e2 = sheet.dark_total_e * sheet.dark_total_e - sheet.dark_shot_e * sheet.dark_shot_e +
                           sheet.dark_e_s * exposure_s;
    out.snr = held_e / std::sqrt(held_e + dark_e2);
    out.saturated_fraction = static_cast<double>(saturated) / static_cast<double>(lit);
    return out;
}

OrderedJson masks_of(const FrameTruth& truth) {
    OrderedJson masks = OrderedJson::object();
    for (const SeenThing& thing : truth.things)
        if (thing.visible_px > 0 && !thing.is_body)
            masks[std::to_string(thing.id)] =
                run_length_text(run_lengths_of(truth.layers.object, truth.raster, thing.id));
    return masks;
}

OrderedJson keypoints_of(const std::vector<KeypointSet>& sets, const FrameTruth& truth) {
    OrderedJson out = OrderedJson::object();
    for (const KeypointSet& set : sets) {
        OrderedJson points = OrderedJson::array();
        const std::vector<SeenKeypoint> seen = seen_keypoints(set, truth);
        for (std::size_t i = 0; i < seen.size(); ++i)
            points.push_back({set.names[i], std::round(1e6 * seen[i].place_px.x) / 1e6,
                              std::round(1e6 * seen[i].place_px.y) / 1e6, seen[i].visibility});
        out[std::to_string(set.object)] = points;
    }
    return out;
}

// Returns the step of the depth picture in mm: a power of ten, large enough for the farthest object.
double depth_step_mm(const FrameTruth& truth) {
    float max_m = 0;
    for (const float d : truth.layers.depth_m.all())
        if (std::isfinite(d) && d < 1e7f) max_m = std::max(max_m, d);
    double step_mm = 0.1;
    while (static_cast<double>(max_m) * 1e3 / step_mm > 65535) step_mm *= 10;
    return step_mm;
}

// Makes BOP's depth picture: 16 bits, 0 for no object.
DnImage depth_picture(const FrameTruth& truth, double step_mm) {
    DnImage picture(truth.raster.width_px, truth.raster.height_px);
    for (int y = 0; y < truth.raster.height_px; ++y) {
        const auto depth = truth.layers.depth_m.row(y);
        for (std::size_t x = 0; x < static_cast<std::size_t>(truth.raster.width_px); ++x) {
            const double steps = static_cast<double>(depth[x]) * 1e3 / step_mm;
            picture.row(y)[x] =
                steps >= 0 && steps <= 65535 ? static_cast<std::uint16_t>(std::lround(steps)) : 0;
        }
    }
    return picture;
}

// Returns each object's silhouette: its mask in the frame, its pixels inside and outside the frame, and how
// many pixels of the mask have a depth.
OrderedJson silhouettes_of(const FrameTruth& truth, const DnImage& depth) {
    OrderedJson out = OrderedJson::object();
    const auto width = static_cast<std::size_t>(truth.raster.width_px);
    IdImage ids(truth.raster.width_px, truth.raster.height_px);
    for (int y = 0; y < truth.raster.height_px; ++y) {
        const auto row = truth.layers.object.row(y);
        std::copy(row.begin(), row.end(), ids.row(y).begin());
    }
    for (const PixelSilhouette& silhouette : truth.silhouettes) {
        for (const std::size_t px : silhouette.hidden_px)
            ids.row(static_cast<int>(px / width))[px % width] = silhouette.thing;
        std::uint64_t valid_px = 0;
        for (int y = 0; y < truth.raster.height_px; ++y)
            for (std::size_t x = 0; x < width; ++x)
                valid_px += ids.row(y)[x] == silhouette.thing && depth.row(y)[x] != 0;
        const PixelBox& box = silhouette.box_px;
        out[std::to_string(silhouette.thing)] = {
            {"px", silhouette.px},
            {"box_px", {box.x0, box.y0, box.x1 - box.x0, box.y1 - box.y0}},
            {"valid_px", valid_px},
            {"mask", run_length_text(run_lengths_of(ids, truth.raster, silhouette.thing))}};
        for (const std::size_t px : silhouette.hidden_px) {
            const auto y = static_cast<int>(px / width);
            ids.row(y)[px % width] = truth.layers.object.row(y)[px % width];
        }
    }
    return out;
}

class PictureMaker {
  public:
    PictureMaker(const CampaignConfig& campaign, const std::filesystem::path& folder, CaseCamera& camera,
                 const std::vector<KeypointSet>& keypoints, CaseRecord& record)
        : campaign_(campaign),
          folder_(folder),
          camera_(camera),
          keypoints_(keypoints),
          record_(record),
          writer_(picture_run_of(camera.scenario(), camera.number())),
          document_(truth_source(camera.scenario(), camera.camera().grid(), camera.number(), {})),
          truth_(truth_record(camera, asked_layers(campaign))) {
        if (campaign.pictures.flow) before_ = truth_record(camera, asked_layers(campaign));
    }

    void make() {
        for (std::int64_t i = 0; i < campaign_.pictures.count; ++i) {
            if (i > 0) camera_.take_time(static_cast<double>(i) * campaign_.pictures.interval_s);
            make_picture(i);
        }
        const Stopwatch watch;
        files_.commit();
        for (const std::filesystem::path& name : names_)
            record_.files.emplace_back(name.string(), std::filesystem::file_size(folder_ / name));
        record_.files_s += 1e-3 * watch.ms();
    }

  private:
    const CampaignConfig& campaign_;
    const std::filesystem::path& folder_;
    CaseCamera& camera_;
    const std::vector<KeypointSet>& keypoints_;
    CaseRecord& record_;
    PictureWriter writer_;
    TruthDocument document_;
    FrameTruth truth_, before_;  // records of this picture, and of the one before it
    VarianceImage variance_;
    DnImage depth_;  // BOP's
    DurableFiles files_;
    std::vector<std::filesystem::path> names_;  // names of those files in the campaign's folder

    void make_picture(std::int64_t index) {
        StillCamera& camera = camera_.camera();
        const ScenarioConfig& s = camera_.scenario();
        const auto id = static_cast<std::uint64_t>(index) + 1;
        const RandomKey key{seed_of_camera(s, camera_.number() - 1), id};
        Stopwatch watch;
        const std::vector<double> rendering_e2 = render(key);
        record_.render_s += 1e-3 * watch.ms();
        watch = {};
        const ElectronImage& electrons = camera.expose();
        const FrameRecord record = record_of_picture(s, camera, id);
        describe(index, record, electrons);
        if (campaign_.pictures.variance)
            variance_ = noise_variance(s.camera, electrons, camera.exposure(), rendering_e2);
        const DnImage& frame = camera.digitise(key);
        record_.sensor_s += 1e-3 * watch.ms();
        watch = {};
        write(index, frame, record);
        record_.files_s += 1e-3 * watch.ms();
    }

    // Renders the picture and returns the variance of its mean electrons [e-^2]. For that, renders it with
    // other light paths as often as necessary. Returns nothing when variance is not requested, or when the
    // second rendering is the same because nothing is random.
    std::vector<double> render(RandomKey key) {
        StillCamera& camera = camera_.camera();
        RenderingNoise noise;
        const auto add = [&] { noise.add(camera.expose(), camera_.scenario().camera, camera.exposure()); };
        const auto add_other = [&](std::uint64_t n) {
            camera.render({seed_of_nth(key.seed, kFirstOtherPaths + n), key.frame});
            add();
        };
        if (campaign_.pictures.variance) add_other(1);
        camera.render(key, &truth_);
        if (!campaign_.pictures.variance) return {};
        add();
        if (!noise.is_random()) return {};
        for (std::uint64_t n = 2; n < RenderingNoise::kRenderings; ++n) add_other(n);
        camera.render(key, &truth_);  // the camera holds the picture again
        return noise.variance_e2();
    }

    void describe(std::int64_t index, const FrameRecord& record, const ElectronImage& electrons) {
        const PictureNames names = picture_names(campaign_, record_.plan.number, index);
        OrderedJson out = {{"name", names.stem},
                           {"truth", OrderedJson::parse(document_.line(truth_, record))}};
        out["masks"] = masks_of(truth_);
        if (!keypoints_.empty()) out["keypoints"] = keypoints_of(keypoints_, truth_);
        if (wants(campaign_.labels, "bop")) {
            const double step_mm = depth_step_mm(truth_);
            depth_ = depth_picture(truth_, step_mm);
            out["depth_step_mm"] = step_mm;
            out["silhouettes"] = silhouettes_of(truth_, depth_);
        }
        record_.frames.push_back(std::move(out));
        if (index > 0) return;
        if (camera_.target() >= truth_.things.size() || truth_.things[camera_.target()].is_body) return;
        const SeenThing& target = truth_.things[camera_.target()];
        const Brightness bright = brightness_of(camera_, truth_, target, electrons, record.exposure_s);
        const Vec3d to_camera = transposed(to_matrix(target.camera_from_thing)) * -target.position_camera_m;
        record_.figures = {
            {"range_m", target.distance_m},
            {"phase_deg", target.phase_rad / kDegree_rad},
            {"azimuth_deg", std::atan2(to_camera.y, to_camera.x) / kDegree_rad},
            {"elevation_deg",
             std::asin(std::clamp(to_camera.z / length(to_camera), -1.0, 1.0)) / kDegree_rad},
            {"visible_px", target.visible_px},
            {"visible_fraction", std::isfinite(target.visible_fraction) ? target.visible_fraction : 0},
            {"lit_share", lit_share_of(truth_, target)},
            {"signal_e", bright.signal_e},
            {"snr", bright.snr},
            {"saturated_fraction", bright.saturated_fraction}};
    }

    std::filesystem::path place(const std::filesystem::path& name) {
        names_.push_back(name);
        return files_.begin(folder_ / name);
    }

    void write(std::int64_t index, const DnImage& frame, const FrameRecord& record) {
        const PictureNames names = picture_names(campaign_, record_.plan.number, index);
        writer_.write_frame(place(names.frame), frame, record);
        if (campaign_.pictures.view) writer_.write_view(place(names.view), frame, record);
        if (wants(campaign_.labels, "bop")) write_numbers(place(names.depth), depth_);
        if (!campaign_.pictures.layers.empty()) write_layers(place(names.layers));
        if (campaign_.pictures.variance) {
            const NamedChannel channels[] = {{"variance.DN2", variance_.plane(0)}};
            write_channels_exr(place(names.variance), variance_.width(), variance_.height(), "DN^2",
                               channels);
        }
        if (!campaign_.pictures.flow) return;
        if (index > 0) {
            const FlowImage flow = optical_flow(before_, truth_);
            const NamedChannel channels[] = {{"flow.X", flow.plane(0)}, {"flow.Y", flow.plane(1)}};
            write_channels_exr(place(picture_names(campaign_, record_.plan.number, index - 1).flow),
                               flow.width(), flow.height(), "px of the frame, to the right and down",
                               channels);
        }
        std::swap(before_, truth_);
    }

    // Writes only the requested layers.
    void write_layers(const std::filesystem::path& file) {
        const TruthRequest all = truth_.request;
        const std::vector<std::string>& words = campaign_.pictures.layers;
        truth_.request.object = wants(words, "object"), truth_.request.range = wants(words, "range");
        truth_.request.depth = wants(words, "depth"), truth_.request.normal = wants(words, "normal");
        truth_.request.position = wants(words, "position");
        write_truth_exr(file, truth_, document_.legend(truth_));
        truth_.request = all;
    }
};

}  // namespace

PictureNames picture_names(const CampaignConfig& campaign, std::uint64_t number, std::int64_t index) {
    std::string stem = case_name(number);
    if (campaign.pictures.count > 1) {
        std::array<char, 24> text{};
        std::snprintf(text.data(), text.size(), "_%02lld", static_cast<long long>(index + 1));
        stem += text.data();
    }
    const char* ending = kFrameEndings[static_cast<std::size_t>(campaign.pictures.kind)];
    return {stem,
            std::filesystem::path("images") / (stem + ending),
            std::filesystem::path("views") / (stem + ".png"),
            std::filesystem::path("layers") / (stem + ".exr"),
            std::filesystem::path("depth") / (stem + ".png"),
            std::filesystem::path("flow") / (stem + ".exr"),
            std::filesystem::path("variance") / (stem + ".exr")};
}

PictureCases::PictureCases(const CampaignConfig& campaign)
    : campaign_(campaign),
      draw_(campaign),
      camera_(campaign),
      keypoints_(load_keypoints(campaign.keypoints)) {
    find_parts(camera_.scenario(), keypoints_);
    // Makes what the children share before they are forked.
    camera_.sheet();
    camera_.camera().dark();
}

CaseRecord PictureCases::make(std::uint64_t number, const std::filesystem::path& folder) {
    CaseRecord record;
    Stopwatch watch;
    record.plan = find_case(campaign_, draw_, number, camera_);
    record.draw_s = 1e-3 * watch.ms();
    PictureMaker(campaign_, folder, camera_, keypoints_, record).make();
    record.done = true;
    return record;
}

}  // namespace hilcam
