// Features of the sequencer, by SFNC 2.4's names.

#include "io/gige/device/gige_features.h"
#include "io/lines/sequencer.h"

namespace hilcam {

namespace r = feature_register;

namespace {

constexpr double kLastSet = kSequencerSets - 1, kLastPath = kSequencerPaths - 1;

std::vector<EnumEntry> set_features(const CameraLimits& l) {
    if (!l.reversible) return counted({"ExposureTime", "Gain", "BlackLevel", "TestPattern"});
    return counted({"ExposureTime", "Gain", "BlackLevel", "TestPattern", "ReverseX", "ReverseY"});
}

std::vector<EnumEntry> sources(const FeatureTable& t) {
    std::vector<EnumEntry> entries;
    for (const EnumEntry& entry : events_of(t.plan))
        if (is_sequencer_source(static_cast<LineEvent>(entry.value), t.limits.lockstep))
            entries.push_back(entry);
    return entries;
}

}  // namespace

void add_sequencer_features(FeatureTable& t) {
    if (!t.limits.has_sequencer) return;
    const char* const kLocked = "SequencerIsNotConfigured";
    t.add("SequencerControl",
          {
              enumeration("SequencerMode", r::kSequencerMode, counted({"Off", "On"}),
                          "Whether frames use the sets")
                  .locked_by("SequencerConfigurationModeReg"),
              enumeration("SequencerConfigurationMode", r::kSequencerConfigurationMode,
                          counted({"Off", "On"}), "Whether sets can be written")
                  .locked_by("SequencerModeReg"),
              enumeration("SequencerFeatureSelector", r::kSequencerFeatureSelector, set_features(t.limits),
                          "A setting that sets can hold")
                  .selects({"SequencerFeatureEnable"}),
              boolean("SequencerFeatureEnable", r::kSequencerFeatureEnable, "Whether all sets hold it")
                  .locked_by(kLocked),
              integer("SequencerSetSelector", r::kSequencerSetSelector, "A set")
                  .between(0, kLastSet)
                  .selects({"SequencerSetSave", "SequencerSetLoad", "SequencerPathSelector",
                            "SequencerSetNext", "SequencerTriggerSource", "SequencerTriggerActivation"}),
              command("SequencerSetSave", r::kSequencerSetSave, "Keeps the camera's settings in the set")
                  .locked_by(kLocked),
              command("SequencerSetLoad", r::kSequencerSetLoad, "Gives the camera the set's settings")
                  .locked_by(kLocked),
              integer("SequencerSetActive", r::kSequencerSetActive, "The set of the newest frame")
                  .between(0, kLastSet)
                  .read_only(),
              integer("SequencerSetStart", r::kSequencerSetStart, "The set of the first frame")
                  .between(0, kLastSet)
                  .locked_by(kLocked),
              integer("SequencerPathSelector", r::kSequencerPathSelector, "A way out of the set")
                  .between(0, kLastPath)
                  .selects({"SequencerSetNext", "SequencerTriggerSource", "SequencerTriggerActivation"}),
              integer("SequencerSetNext", r::kSequencerSetNext, "The set that the path leads to")
                  .between(0, kLastSet)
                  .locked_by(kLocked),
              enumeration("SequencerTriggerSource", r::kSequencerTriggerSource, sources(t),
                          "What makes that set the active one")
                  .locked_by(kLocked),
              enumeration("SequencerTriggerActivation", r::kSequencerTriggerActivation,
                          counted({"RisingEdge", "FallingEdge", "AnyEdge"}), "Of a line")
                  .locked_by(kLocked),
          });
    t.formulas.push_back({kLocked, "ENABLED = 0", "ENABLED", "SequencerConfigurationModeReg"});
}

}  // namespace hilcam
