#pragma once
// Writes the camera's GenICam description (GenApi schema 1.1) from its feature table.

#include <cstdint>
#include <string>
#include <vector>

#include "io/gige/device/gige_features.h"

namespace hilcam {

std::string genicam_xml(const FeatureTable& table, const std::string& model);

}  // namespace hilcam
