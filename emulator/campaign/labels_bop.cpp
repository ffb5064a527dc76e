// Labels of the Benchmark for 6D Object Pose Estimation: thodan/bop_toolkit, docs/bop_datasets_format.md.
//
// Lengths are in mm. Places have their origin at the centre of the first pixel, as in OpenCV, so they are
// half a pixel less than hilcam's. A scene has the pictures of a thousand cases. The numbers in
// scene_gt_info.json are counted as by scripts/calc_gt_info.py there: px_count_all and bbox_obj over three
// times the picture's width and height, with the picture in the middle, and no boxes for invisible objects.
// Boxes include all columns and rows of their pixels, where that script's are one less. Ground is not an
// object here, because it has no model.

#include <algorithm>
#include <map>

#include "emulator/campaign/bop_models.h"
#include "emulator/campaign/label_writer.h"
#include "emulator/campaign/picture_case.h"
#include "emulator/campaign/run_lengths.h"
#include "io/images/image_file.h"
#include "io/system/durable_file.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/pixel_box.h"

namespace hilcam {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr std::uint64_t kCasesOfScene = 1000;

std::string six_digits(std::uint64_t number) { return case_name(number); }

Quat quat_of(const OrderedJson& wxyz) { return {wxyz.at(0), wxyz.at(1), wxyz.at(2), wxyz.at(3)}; }

OrderedJson rows_of(const Mat3d& m) {
    return {m.x.x, m.x.y, m.x.z, m.y.x, m.y.y, m.y.z, m.z.x, m.z.y, m.z.z};
}
OrderedJson mm_of(const OrderedJson& metres) {
    return {1e3 * metres.at(0).get<double>(), 1e3 * metres.at(1).get<double>(),
            1e3 * metres.at(2).get<double>()};
}
// Returns an object's silhouette from the record; null for ground.
const OrderedJson* silhouette_of(const CaseRecord& record, const OrderedJson& frame, const std::string& id) {
    const auto all = frame.find("silhouettes");
    if (all == frame.end())
        throw InputError(case_name(record.plan.number) +
                         ".json: has no silhouettes, which 'labels: [bop]' is made of: it is an older "
                         "program's; remove it, and the case is made again");
    const auto found = all->find(id);
    return found == all->end() ? nullptr : &*found;
}

// A mask as written to its file, and its counts.
struct Mask {
    DnImage picture;
    std::uint64_t px = 0;
    PixelBox box_px;
};
Mask mask_from(const std::string& runs, int width, int height) {
    Mask mask{DnImage(width, height), 0, {width, height, 0, 0}};
    const auto pixels = mask_of(parse_run_lengths(runs), width, height);
    std::copy(pixels.begin(), pixels.end(), mask.picture.data());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            if (mask.picture.row(y)[static_cast<std::size_t>(x)] == 0) continue;
            ++mask.px;
            PixelBox& box = mask.box_px;
            box = {std::min(box.x0, x), std::min(box.y0, y), std::max(box.x1, x + 1),
                   std::max(box.y1, y + 1)};
        }
    return mask;
}

class BopLabels : public LabelWriter {
  public:
    explicit BopLabels(const LabelContext& context) : context_(context) {}

    void add(const CaseRecord& record) override {
        const std::uint64_t scene = (record.plan.number - 1) / kCasesOfScene;
        const std::filesystem::path folder = context_.folder / "bop" / split_of(record) / six_digits(scene);
        if (folder != scene_folder_) finish_scene(folder);
        const auto count = static_cast<std::uint64_t>(context_.campaign.pictures.count);
        for (std::size_t i = 0; i < record.frames.size(); ++i)
            add_picture(record, i, (record.plan.number - 1) % kCasesOfScene * count + i);
    }

    void finish() override {
        finish_scene({});
        if (!camera_.is_null())
            write_durably(context_.folder / "bop" / "camera.json", camera_.dump(2) + "\n");
        write_bop_models(context_.folder / "bop" / "models", context_.campaign, context_.shapes);
    }

  private:
    LabelContext context_;
    struct Scene {
        OrderedJson cameras = OrderedJson::object(), poses = OrderedJson::object(),
                    infos = OrderedJson::object();
    };
    // Cases of a scene come in sequence, but cases of several splits alternate.
    std::map<std::filesystem::path, Scene> scenes_;
    std::filesystem::path scene_folder_;
    Scene* scene_ = nullptr;
    OrderedJson camera_;

    void finish_scene(const std::filesystem::path& next) {
        // Scenes with smaller numbers receive no more pictures.
        const std::string number = next.filename().string();
        std::erase_if(scenes_, [&](const auto& entry) {
            const auto& [folder, scene] = entry;
            if (!number.empty() && folder.filename() == number) return false;
            write_durably(folder / "scene_camera.json", scene.cameras.dump(1) + "\n");
            write_durably(folder / "scene_gt.json", scene.poses.dump(1) + "\n");
            write_durably(folder / "scene_gt_info.json", scene.infos.dump(1) + "\n");
            return true;
        });
        scene_folder_ = next;
        scene_ = next.empty() ? nullptr : &scenes_[next];
    }

    void add_picture(const CaseRecord& record, std::size_t index, std::uint64_t id) {
        const OrderedJson& frame = record.frames[index];
        const OrderedJson& truth = frame.at("truth");
        const OrderedJson& image = truth.at("image");
        const double fx = image.at("focal_length_px").at(0), fy = image.at("focal_length_px").at(1);
        const double cx = image.at("principal_point_px").at(0).get<double>() - 0.5;
        const double cy = image.at("principal_point_px").at(1).get<double>() - 0.5;
        const double step_mm = frame.at("depth_step_mm");
        const std::string key = std::to_string(id);
        const Mat3d camera_from_world = transposed(to_matrix(quat_of(truth.at("pose").at("attitude_wxyz"))));
        const OrderedJson& place = truth.at("pose").at("position_m");
        const Vec3d shift_mm = -1e3 * (camera_from_world * Vec3d{place.at(0), place.at(1), place.at(2)});
        scene_->cameras[key] = {{"cam_K", {fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0}},
                                {"depth_scale", step_mm},
                                {"cam_R_w2c", rows_of(camera_from_world)},
                                {"cam_t_w2c", {shift_mm.x, shift_mm.y, shift_mm.z}}};
        if (camera_.is_null())
            camera_ = {{"width", image.at("width_px")},
                       {"height", image.at("height_px")},
                       {"fx", fx},
                       {"fy", fy},
                       {"cx", cx},
                       {"cy", cy},
                       {"depth_scale", step_mm}};
        OrderedJson poses = OrderedJson::array(), infos = OrderedJson::array();
        for (const OrderedJson& object : truth.at("objects"))
            if (const auto* silhouette =
                    silhouette_of(record, frame, std::to_string(object.at("id").get<std::uint64_t>()))) {
                poses.push_back(
                    {{"cam_R_m2c", rows_of(to_matrix(quat_of(object.at("camera_from_body_wxyz"))))},
                     {"cam_t_m2c", mm_of(object.at("position_camera_m"))},
                     {"obj_id", object.at("id")}});
                infos.push_back(add_masks(frame, image, object, *silhouette,
                                          six_digits(id) + "_" + six_digits(infos.size()) + ".png"));
            }
        scene_->poses[key] = poses, scene_->infos[key] = infos;
        const auto picture = static_cast<std::int64_t>(index);
        const std::filesystem::path shown = shown_picture(context_.campaign, record.plan.number, picture);
        link_or_copy(context_.folder / shown, scene_folder_ / (context_.has_colors ? "rgb" : "gray") /
                                                  (six_digits(id) + shown.extension().string()));
        link_or_copy(context_.folder / picture_names(context_.campaign, record.plan.number, picture).depth,
                     scene_folder_ / "depth" / (six_digits(id) + ".png"));
    }

    // Writes both masks of an object, and returns its entry for scene_gt_info.json.
    OrderedJson add_masks(const OrderedJson& frame, const OrderedJson& image, const OrderedJson& object,
                          const OrderedJson& silhouette, const std::string& name) const {
        const int width = image.at("width_px"), height = image.at("height_px");
        const OrderedJson& masks = frame.at("masks");
        const auto runs = masks.find(std::to_string(object.at("id").get<std::uint64_t>()));
        const Mask whole = mask_from(silhouette.at("mask").get<std::string>(), width, height);
        const Mask visible = runs == masks.end() ? Mask{DnImage(width, height), 0, {}}
                                                 : mask_from(runs->get<std::string>(), width, height);
        DurableFiles files;
        write_numbers(files.begin(scene_folder_ / "mask" / name), whole.picture);
        write_numbers(files.begin(scene_folder_ / "mask_visib" / name), visible.picture);
        files.commit();
        const auto all_px = silhouette.at("px").get<std::uint64_t>();
        const PixelBox& box = visible.box_px;
        const OrderedJson nothing{-1, -1, -1, -1};
        return {{"bbox_obj", visible.px > 0 ? silhouette.at("box_px") : nothing},
                {"bbox_visib",
                 visible.px > 0 ? OrderedJson{box.x0, box.y0, box.x1 - box.x0, box.y1 - box.y0} : nothing},
                {"px_count_all", all_px},
                {"px_count_valid", silhouette.at("valid_px")},
                {"px_count_visib", visible.px},
                {"visib_fract",
                 all_px > 0 ? static_cast<double>(visible.px) / static_cast<double>(all_px) : 0.0}};
    }
};

}  // namespace

std::unique_ptr<LabelWriter> make_bop_labels(const LabelContext& context) {
    return std::make_unique<BopLabels>(context);
}

}  // namespace hilcam
