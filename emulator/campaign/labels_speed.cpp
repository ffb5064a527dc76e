// Labels in SPEED+'s format (Park, Maertens, Lecuyer, Izzo, D'Amico, "SPEED+: Next-generation dataset for
// spacecraft pose estimation across domain gap", IEEE Aerospace Conference 2022): the target's attitude and
// position in each picture. q_vbs2tango_true is scalar first and, by the data set's own tools, p_camera =
// R(q) p_target + r. Places count from the picture's corner, like hilcam's.

#include <map>

#include "emulator/campaign/label_writer.h"
#include "io/system/durable_file.h"

namespace hilcam {
namespace {

using OrderedJson = nlohmann::ordered_json;

class SpeedLabels : public LabelWriter {
  public:
    explicit SpeedLabels(const LabelContext& context) : context_(context) {}

    void add(const CaseRecord& record) override {
        for (std::size_t i = 0; i < record.frames.size(); ++i) {
            const OrderedJson& truth = record.frames[i].at("truth");
            const std::filesystem::path shown =
                shown_picture(context_.campaign, record.plan.number, static_cast<std::int64_t>(i));
            if (camera_.is_null()) camera_ = camera_of(truth.at("image"));
            const auto target = static_cast<std::size_t>(context_.campaign.target) - 1;
            const OrderedJson& object = truth.at("objects").at(target);
            std::string& list = lists_[split_of(record)];
            list += (list.empty() ? "\n" : ",\n") +
                    OrderedJson{{"filename", shown.filename().string()},
                                {"q_vbs2tango_true", object.at("camera_from_body_wxyz")},
                                {"r_Vo2To_vbs_true", object.at("position_camera_m")}}
                        .dump();
            link_or_copy(context_.folder / shown, context_.folder / "speed" / "images" / shown.filename());
        }
    }

    void finish() override {
        for (const auto& [split, list] : lists_)
            write_durably(context_.folder / "speed" / (split + ".json"), "[" + list + "]\n");
        if (!camera_.is_null())
            write_durably(context_.folder / "speed" / "camera.json", camera_.dump(2) + "\n");
    }

  private:
    LabelContext context_;
    std::map<std::string, std::string> lists_;
    OrderedJson camera_;

    OrderedJson camera_of(const OrderedJson& image) const {
        const double fx = image.at("focal_length_px").at(0), fy = image.at("focal_length_px").at(1);
        const double cx = image.at("principal_point_px").at(0), cy = image.at("principal_point_px").at(1);
        return {{"Nu", image.at("width_px")},
                {"Nv", image.at("height_px")},
                {"ppx", context_.pitch_m},
                {"ppy", context_.pitch_m},
                {"fx", fx * context_.pitch_m},
                {"fy", fy * context_.pitch_m},
                {"ccx", cx},
                {"ccy", cy},
                {"cameraMatrix", {{fx, 0.0, cx}, {0.0, fy, cy}, {0.0, 0.0, 1.0}}},
                {"distCoeffs", image.at("distortion")}};
    }
};

}  // namespace

std::unique_ptr<LabelWriter> make_speed_labels(const LabelContext& context) {
    return std::make_unique<SpeedLabels>(context);
}

}  // namespace hilcam
