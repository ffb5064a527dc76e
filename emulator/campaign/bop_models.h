#pragma once
// The models folder of a BOP data set: each object's mesh as a PLY file in text, with vertex normals, and
// models_info.json (thodan/bop_toolkit, docs/bop_datasets_format.md and scripts/calc_model_info.py).
//
// A model is in millimetres and in the object's own axes, which the labels' cam_R_m2c and cam_t_m2c are of; its
// origin is the object's, not the middle of its box. Its parts are not turned by joints. Colours are left out,
// and so are symmetries, which nobody has told.

#include <filesystem>
#include <vector>

#include "emulator/campaign/campaign_config.h"
#include "emulator/scenario/object_config.h"

namespace hilcam {

// Writes obj_000001.ply, ... and models_info.json. An object whose mesh, make or scale the campaign varies has no
// model: there are several of it. The same campaign gives the same bytes, and each file is there whole or not at
// all, so that several may write at once. Throws InputError, DeviceError.
void write_bop_models(const std::filesystem::path& folder, const CampaignConfig& campaign,
                      const std::vector<ObjectConfig>& objects);

}  // namespace hilcam
