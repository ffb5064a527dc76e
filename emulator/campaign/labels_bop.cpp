// Labels of the Benchmark for 6D Object Pose Estimation: thodan/bop_toolkit, docs/bop_datasets_format.md.
// Lengths are in mm; places count from the middle of the first pixel, as OpenCV's, half a pixel less than
// hilcam's; a scene has the pictures of a thousand cases. Silhouettes beyond what is visible have no mask, and
// models are not written.

#include <algorithm>
#include <map>

#include "emulator/campaign/label_writer.h"
#include "emulator/campaign/picture_case.h"
#include "emulator/campaign/run_lengths.h"
#include "io/pictures/image_file.h"
#include "io/system/durable_file.h"

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
OrderedJson box_of(const OrderedJson& box) {
    return box.is_null() ? OrderedJson{-1, -1, -1, -1}
                         : box;  // the toolkit's calc_gt_info.py has the same for nothing
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
    }

  private:
    LabelContext context_;
    struct Scene {
        OrderedJson cameras = OrderedJson::object(), poses = OrderedJson::object(),
                    infos = OrderedJson::object();
    };
    // Cases of a scene come one after the other, but those of several splits by turns.
    std::map<std::filesystem::path, Scene> scenes_;
    std::filesystem::path scene_folder_;
    Scene* scene_ = nullptr;
    OrderedJson camera_;

    void finish_scene(const std::filesystem::path& next) {
        // Scenes of smaller numbers get nothing more.
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
        for (const OrderedJson& object : truth.at("objects")) {
            poses.push_back({{"cam_R_m2c", rows_of(to_matrix(quat_of(object.at("camera_from_body_wxyz"))))},
                             {"cam_t_m2c", mm_of(object.at("position_camera_m"))},
                             {"obj_id", object.at("id")}});
            infos.push_back(
                {{"bbox_obj", box_of(object.at("silhouette_box_px"))},
                 {"bbox_visib", box_of(object.at("visible_box_px"))},
                 {"px_count_all", object.at("silhouette_px")},
                 {"px_count_valid", object.at("visible_px")},
                 {"px_count_visib", object.at("visible_px")},
                 {"visib_fract",
                  object.at("visible_fraction").is_null() ? OrderedJson(0) : object.at("visible_fraction")}});
            write_mask(frame, image, object, id, poses.size() - 1);
        }
        scene_->poses[key] = poses, scene_->infos[key] = infos;
        const auto picture = static_cast<std::int64_t>(index);
        const std::filesystem::path shown = shown_picture(context_.campaign, record.plan.number, picture);
        link_or_copy(context_.folder / shown, scene_folder_ / (context_.has_colors ? "rgb" : "gray") /
                                                  (six_digits(id) + shown.extension().string()));
        link_or_copy(context_.folder / picture_names(context_.campaign, record.plan.number, picture).depth,
                     scene_folder_ / "depth" / (six_digits(id) + ".png"));
    }

    void write_mask(const OrderedJson& frame, const OrderedJson& image, const OrderedJson& object,
                    std::uint64_t id, std::size_t instance) const {
        const int width = image.at("width_px"), height = image.at("height_px");
        DnImage mask(width, height);
        const OrderedJson& masks = frame.at("masks");
        if (const auto runs = masks.find(std::to_string(object.at("id").get<std::uint64_t>()));
            runs != masks.end()) {
            const auto pixels = mask_of(parse_run_lengths(runs->get<std::string>()), width, height);
            std::copy(pixels.begin(), pixels.end(), mask.data());
        }
        DurableFiles files;
        write_numbers(files.begin(scene_folder_ / "mask_visib" /
                                  (six_digits(id) + "_" + six_digits(instance) + ".png")),
                      mask);
        files.commit();
    }
};

}  // namespace

std::unique_ptr<LabelWriter> make_bop_labels(const LabelContext& context) {
    return std::make_unique<BopLabels>(context);
}

}  // namespace hilcam
