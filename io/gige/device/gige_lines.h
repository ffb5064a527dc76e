#pragma once
// Lines, user outputs, counters and timers as clients see them (SFNC DigitalIOControl and
// CounterAndTimerControl). io/lines does the work.
//
// LineSelector has Line0, the further names of that input in the identity, and the lines of the scenario.

#include "io/gige/device/gige_core.h"

namespace hilcam {

class GigeLines {
  public:
    explicit GigeLines(GigeCore& core);

    // Values of LineSelector and TriggerSource for lines other than Line0: those of the scenario, by number.
    static constexpr std::uint32_t kFirstOwn = 64;

  private:
    void add_lines();
    void add_user_outputs();
    void add_counters();
    void add_timers();
    std::size_t line() const { return selector_ > kFirstOwn ? selector_ - kFirstOwn : 0; }
    // Adds a register of the line settings. `place` returns a reference into them.
    template <class Place>
    void setting(std::uint32_t address, const Place& place, std::uint64_t most);
    template <class Change>
    gvcp::Status change(const Change& change);
    bool is_event(std::uint64_t value) const;

    GigeCore& core_;
    std::uint32_t selector_ = 0, user_output_ = 0, counter_ = 0, timer_ = 0;
};

}  // namespace hilcam
