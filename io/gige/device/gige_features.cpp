#include "io/gige/device/gige_features.h"

namespace hilcam {

std::vector<EnumEntry> counted(std::initializer_list<const char*> names) {
    std::vector<EnumEntry> entries;
    for (const char* const name : names) entries.push_back({name, entries.size()});
    return entries;
}

void FeatureTable::add(const char* category, std::vector<Feature> rows) {
    for (Feature& f : rows) {
        f.category = category;
        features.push_back(std::move(f));
    }
}

FeatureTable gige_features(const CameraLimits& limits, bool multipart,
                           const std::vector<std::string>& more_lines, const LinePlan& plan) {
    std::vector<std::string> lines = {"Line0"};
    lines.insert(lines.end(), more_lines.begin(), more_lines.end());
    FeatureTable table(limits, multipart, std::move(lines), plan);
    add_device_features(table);
    add_image_features(table);
    add_acquisition_features(table);
    add_line_features(table);
    add_sequencer_features(table);
    add_chunk_features(table);
    add_event_features(table);
    add_transport_features(table);
    add_fault_features(table);
    for (Feature& f : table.features)
        if (f.category == "TransportLayerControl" && f.visibility.empty()) f.visibility = "Expert";
    return table;
}

}  // namespace hilcam
