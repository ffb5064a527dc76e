// Labels in YOLO's format (docs.ultralytics.com, "Object detection datasets", "Pose estimation datasets"): a
// text file for each picture with a line for each object: its class from 0, the centre and size of its box,
// and its key points with COCO's visibility, all as fractions of the picture.

#include <algorithm>
#include <map>
#include <set>

#include "emulator/campaign/label_writer.h"
#include "io/system/durable_file.h"

namespace hilcam {
namespace {

using OrderedJson = nlohmann::ordered_json;

class YoloLabels : public LabelWriter {
  public:
    explicit YoloLabels(const LabelContext& context) : context_(context) {
        for (const KeypointSet& set : context.keypoints) points_ = std::max(points_, set.names.size());
    }

    void add(const CaseRecord& record) override {
        const std::string split = split_of(record);
        splits_.insert(split);
        for (std::size_t i = 0; i < record.frames.size(); ++i) {
            const std::filesystem::path shown =
                shown_picture(context_.campaign, record.plan.number, static_cast<std::int64_t>(i));
            const std::filesystem::path folder = context_.folder / "yolo";
            link_or_copy(context_.folder / shown, folder / "images" / split / shown.filename());
            write_durably(folder / "labels" / split / (shown.stem().string() + ".txt"),
                          lines(record.frames[i]));
        }
    }

    void finish() override {
        std::string text = "path: .\n";
        for (const std::string& split : splits_) text += split + ": images/" + split + "\n";
        text += "nc: " + std::to_string(context_.objects.size()) + "\nnames:\n";
        for (std::size_t i = 0; i < context_.objects.size(); ++i)
            text += "  " + std::to_string(i) + ": " + OrderedJson(context_.objects[i]).dump() + "\n";
        if (points_ > 0) text += "kpt_shape: [" + std::to_string(points_) + ", 3]\n";
        write_durably(context_.folder / "yolo" / "data.yaml", text);
    }

  private:
    LabelContext context_;
    std::set<std::string> splits_;
    std::size_t points_ = 0;  // number for each object, the most that any has; missing ones are not visible

    std::string lines(const OrderedJson& frame) const {
        const OrderedJson& image = frame.at("truth").at("image");
        const double width = image.at("width_px"), height = image.at("height_px");
        std::string text;
        for (const OrderedJson& object : frame.at("truth").at("objects")) {
            const OrderedJson& box = object.at("visible_box_px");
            if (box.is_null()) continue;
            const double x = box.at(0), y = box.at(1), w = box.at(2), h = box.at(3);
            const auto id = object.at("id").get<std::uint64_t>();
            text += std::to_string(id - 1);
            for (const double share : {(x + w / 2) / width, (y + h / 2) / height, w / width, h / height})
                text += " " + exact_number(share);
            text += points_of(frame, id, width, height) + "\n";
        }
        return text;
    }

    std::string points_of(const OrderedJson& frame, std::uint64_t id, double width, double height) const {
        std::string text;
        std::size_t count = 0;
        if (const std::string key = std::to_string(id);
            frame.contains("keypoints") && frame.at("keypoints").contains(key))
            for (const OrderedJson& point : frame.at("keypoints").at(key)) {
                const int visibility = point.at(3);
                const double x = point.at(1), y = point.at(2);
                text += visibility > 0 ? " " + exact_number(x / width) + " " + exact_number(y / height) +
                                             " " + std::to_string(visibility)
                                       : std::string(" 0 0 0");
                ++count;
            }
        for (; count < points_; ++count) text += " 0 0 0";
        return text;
    }
};

}  // namespace

std::unique_ptr<LabelWriter> make_yolo_labels(const LabelContext& context) {
    return std::make_unique<YoloLabels>(context);
}

}  // namespace hilcam
