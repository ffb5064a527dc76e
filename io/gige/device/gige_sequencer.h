#pragma once
// The sequencer as clients see it (SFNC SequencerControl). io/lines/sequencer.h does the work.
//
// A client configures with SequencerConfigurationMode On: for each set it writes the camera's own features
// (ExposureTime, Gain, ...), the paths, and saves. Then it switches the configuration mode off and
// SequencerMode on. Each of the two modes excludes the other, and paths and sets can be written in the first
// only. SequencerFeatureEnable holds for all sets. AcquisitionStart begins at the start set.

#include "io/gige/device/gige_core.h"

namespace hilcam {

class GigeSequencer {
  public:
    explicit GigeSequencer(GigeCore& core);
    // Switches it off: settings were loaded, or the device was reset.
    void stop();

  private:
    SequencerProgram& program() { return core_.settings.sequencer; }
    SequencerSet& set() { return program().sets[set_]; }
    SequencerPath& path() { return set().paths[path_]; }
    bool on() const { return sequencer_->on(); }
    void add_modes();
    void add_features();
    void add_sets();
    void add_paths();
    // Adds a register that can be written in configuration mode only.
    void configured(std::uint32_t address, GigeRegisterFile::Read read, GigeRegisterFile::Write write);
    gvcp::Status set_mode(bool on);
    gvcp::Status load();
    bool has(std::uint32_t feature) const;
    bool is_source(std::uint64_t value) const;

    GigeCore& core_;
    Sequencer* const sequencer_;  // null: the camera has none, and there are no registers
    bool configures_ = false;
    std::uint32_t feature_ = 0, set_ = 0, path_ = 0;
};

}  // namespace hilcam
