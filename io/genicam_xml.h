#pragma once
// GenICam description (schema 1.1) of the camera, generated from its feature table.

#include <string>

#include "io/gige_features.h"

namespace hilcam {

std::string genicam_xml(const std::vector<Feature>& features, const std::string& model);

}  // namespace hilcam
