#pragma once
// Writes the models folder of a BOP data set: each object's mesh as an ASCII PLY file with vertex normals,
// and models_info.json (thodan/bop_toolkit, docs/bop_datasets_format.md and scripts/calc_model_info.py).
//
// A model is in millimetres and in the object's own axes, to which the labels' cam_R_m2c and cam_t_m2c refer.
// Its origin is the object's origin, not the centre of its box. Joints do not turn its parts. Colours and
// symmetries are not written.

#include <filesystem>
#include <vector>

#include "emulator/campaign/campaign_config.h"
#include "emulator/scenario/object_config.h"

namespace hilcam {

// Writes obj_000001.ply, ... and models_info.json. An object has no model if the campaign varies its mesh,
// make or scale, because its shape then differs from case to case. The same campaign gives the same bytes.
// Each file appears whole or not at all, so several processes may write at the same time. Throws InputError,
// DeviceError.
void write_bop_models(const std::filesystem::path& folder, const CampaignConfig& campaign,
                      const std::vector<ObjectConfig>& objects);

}  // namespace hilcam
