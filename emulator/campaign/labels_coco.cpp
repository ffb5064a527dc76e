// Labels in COCO's format: cocodataset.org, "Data format", for object detection and key points. Boxes are [x,
// y, width, height] from the picture's corner, masks are compressed run lengths, key points are x, y, v.

#include <map>

#include "emulator/campaign/label_writer.h"
#include "emulator/campaign/picture_case.h"
#include "io/system/durable_file.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

using OrderedJson = nlohmann::ordered_json;

class CocoLabels : public LabelWriter {
  public:
    explicit CocoLabels(const LabelContext& context) : context_(context) {}

    void add(const CaseRecord& record) override {
        Part& part = parts_[split_of(record)];
        const auto count = static_cast<std::uint64_t>(context_.campaign.pictures.count);
        for (std::size_t i = 0; i < record.frames.size(); ++i) {
            const OrderedJson& frame = record.frames[i];
            const OrderedJson& image = frame.at("truth").at("image");
            const std::uint64_t id = (record.plan.number - 1) * count + i + 1;
            append(part.images, {{"id", id},
                                 {"file_name", shown_picture(context_.campaign, record.plan.number,
                                                             static_cast<std::int64_t>(i))
                                                   .generic_string()},
                                 {"width", image.at("width_px")},
                                 {"height", image.at("height_px")}});
            for (const OrderedJson& object : frame.at("truth").at("objects"))
                if (object.at("visible_px") != 0) add_object(part, id, frame, image, object);
        }
    }

    void finish() override {
        OrderedJson categories = OrderedJson::array();
        for (std::size_t i = 0; i < context_.objects.size(); ++i) {
            OrderedJson category = {{"id", i + 1}, {"name", context_.objects[i]}};
            for (const KeypointSet& set : context_.keypoints)
                if (set.object == i + 1)
                    category["keypoints"] = set.names, category["skeleton"] = OrderedJson::array();
            categories.push_back(category);
        }
        for (const auto& [split, part] : parts_)
            write_durably(context_.folder / "coco" / (split + ".json"),
                          "{\"info\":" + OrderedJson{{"description", context_.campaign.name}}.dump() +
                              ",\n\"categories\":" + categories.dump() + ",\n\"images\":[" + part.images +
                              "],\n\"annotations\":[" + part.annotations + "]}\n");
    }

  private:
    struct Part {
        std::string images, annotations;  // elements of the lists, as text
        std::uint64_t count = 0;
    };
    LabelContext context_;
    std::map<std::string, Part> parts_;

    static void append(std::string& list, const OrderedJson& element) {
        list += (list.empty() ? "\n" : ",\n") + element.dump();
    }

    static void add_object(Part& part, std::uint64_t image_id, const OrderedJson& frame,
                           const OrderedJson& image, const OrderedJson& object) {
        const std::string number = std::to_string(object.at("id").get<std::uint64_t>());
        OrderedJson label = {{"id", ++part.count},
                             {"image_id", image_id},
                             {"category_id", object.at("id")},
                             {"iscrowd", 0},
                             {"area", object.at("visible_px")},
                             {"bbox", object.at("visible_box_px")},
                             {"segmentation",
                              {{"size", {image.at("height_px"), image.at("width_px")}},
                               {"counts", frame.at("masks").at(number)}}}};
        if (frame.contains("keypoints") && frame.at("keypoints").contains(number)) {
            OrderedJson numbers = OrderedJson::array();
            int labelled = 0;
            for (const OrderedJson& point : frame.at("keypoints").at(number)) {
                const int visibility = point.at(3);
                // Points outside the picture have the place 0, 0.
                numbers.push_back(visibility > 0 ? point.at(1) : OrderedJson(0));
                numbers.push_back(visibility > 0 ? point.at(2) : OrderedJson(0));
                numbers.push_back(visibility);
                labelled += visibility > 0;
            }
            label["keypoints"] = numbers;
            label["num_keypoints"] = labelled;
        }
        append(part.annotations, label);
    }
};

}  // namespace

std::unique_ptr<LabelWriter> make_coco_labels(const LabelContext& context) {
    return std::make_unique<CocoLabels>(context);
}

std::string split_of(const CaseRecord& record) {
    return record.plan.split.empty() ? "all" : record.plan.split;
}

std::filesystem::path shown_picture(const CampaignConfig& campaign, std::uint64_t number,
                                    std::int64_t index) {
    const PictureNames names = picture_names(campaign, number, index);
    return campaign.pictures.view ? names.view : names.frame;
}

void link_or_copy(const std::filesystem::path& from, const std::filesystem::path& to) {
    DurableFiles files;
    const std::filesystem::path now = files.begin(to);
    std::error_code error;
    std::filesystem::remove(now, error);
    std::filesystem::create_hard_link(from, now, error);
    if (error) std::filesystem::copy_file(from, now, error);
    if (error) throw DeviceError(to.string() + " cannot be written: " + error.message());
    std::filesystem::rename(now, to, error);
    if (error) throw DeviceError(to.string() + " cannot be written: " + error.message());
}

}  // namespace hilcam
