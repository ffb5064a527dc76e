#pragma once
// Writes labels in formats of other programs, from one record after the other.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "emulator/campaign/case_record.h"
#include "emulator/campaign/keypoints.h"
#include "emulator/scenario/object_config.h"

namespace hilcam {

// Facts of the campaign that all formats need.
struct LabelContext {
    const CampaignConfig& campaign;
    std::filesystem::path folder;
    // Names of the scenario's objects, by number from 1, and of its terrain.
    std::vector<std::string> objects;
    std::vector<ObjectConfig> shapes;  // the scenario's objects without its terrain
    std::vector<KeypointSet> keypoints;
    bool has_colors = false;  // true: pictures for viewing have three channels
    double pitch_m = 0;       // pixel pitch of the frame
};

class LabelWriter {
  public:
    virtual ~LabelWriter() = default;
    // Adds a case that is done. Cases come in rising order of their numbers.
    virtual void add(const CaseRecord& record) = 0;
    // Writes the files that cover all cases. Throws DeviceError.
    virtual void finish() = 0;
};

// coco/SPLIT.json: boxes, run lengths, key points. Pictures are named relative to the campaign's folder.
std::unique_ptr<LabelWriter> make_coco_labels(const LabelContext& context);
// bop/SPLIT/000000/: scene_camera.json, scene_gt.json, scene_gt_info.json, gray or rgb, depth, mask,
// mask_visib; bop/models (bop_models.h).
std::unique_ptr<LabelWriter> make_bop_labels(const LabelContext& context);
// yolo/data.yaml, images/SPLIT, labels/SPLIT.
std::unique_ptr<LabelWriter> make_yolo_labels(const LabelContext& context);
// speed/camera.json, SPLIT.json, images.
std::unique_ptr<LabelWriter> make_speed_labels(const LabelContext& context);
// shards/SPLIT-000000.tar for WebDataset.
std::unique_ptr<LabelWriter> make_shards(const LabelContext& context);

// Returns the name of the case's split, or "all" when the campaign has none.
std::string split_of(const CaseRecord& record);
// Returns the picture that other programs receive: the one for viewing if it exists, else the frame.
std::filesystem::path shown_picture(const CampaignConfig& campaign, std::uint64_t number, std::int64_t index);
// Makes a hard link, or a copy where the file system has no hard links. Replaces an existing file.
void link_or_copy(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace hilcam
