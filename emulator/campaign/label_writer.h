#pragma once
// Labels in the formats of others, made of records one after the other.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "emulator/campaign/case_record.h"
#include "emulator/campaign/keypoints.h"
#include "emulator/scenario/object_config.h"

namespace hilcam {

// The facts of a campaign that all formats are told.
struct LabelContext {
    const CampaignConfig& campaign;
    std::filesystem::path folder;
    std::vector<std::string> objects;  // names of the scenario's objects, by number from 1, and its terrain's
    std::vector<ObjectConfig> shapes;  // the scenario's objects without its terrain
    std::vector<KeypointSet> keypoints;
    bool has_colors = false;  // pictures to look at have three channels
    double pitch_m = 0;       // side of a pixel of the frame
};

class LabelWriter {
  public:
    virtual ~LabelWriter() = default;
    // Cases that are done, by rising number.
    virtual void add(const CaseRecord& record) = 0;
    // Writes what belongs to all of them. DeviceError.
    virtual void finish() = 0;
};

// coco/SPLIT.json: boxes, run lengths, key points; pictures are named from the campaign's folder.
std::unique_ptr<LabelWriter> make_coco_labels(const LabelContext& context);
// bop/SPLIT/000000/: scene_camera.json, scene_gt.json, scene_gt_info.json, gray or rgb, depth, mask, mask_visib;
// bop/models (bop_models.h).
std::unique_ptr<LabelWriter> make_bop_labels(const LabelContext& context);
// yolo/data.yaml, images/SPLIT, labels/SPLIT.
std::unique_ptr<LabelWriter> make_yolo_labels(const LabelContext& context);
// speed/camera.json, SPLIT.json, images.
std::unique_ptr<LabelWriter> make_speed_labels(const LabelContext& context);
// shards/SPLIT-000000.tar for WebDataset.
std::unique_ptr<LabelWriter> make_shards(const LabelContext& context);

// The split's name, or "all" where there are none.
std::string split_of(const CaseRecord& record);
// The picture that other programs are given: that to look at, where there is one, else the frame.
std::filesystem::path shown_picture(const CampaignConfig& campaign, std::uint64_t number, std::int64_t index);
// A second name for a file, or where the disk has no such, a copy. It replaces what is there.
void link_or_copy(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace hilcam
