#include "emulator/scenario/fault_config.h"

#include <algorithm>
#include <string>
#include <vector>

#include "render/vocabulary/check.h"

namespace hilcam {

Fields fields(FaultConfig& f) {
    std::vector<std::string> words;
    words.reserve(std::size(kAllFaults));
    for (const FaultKind kind : kAllFaults) words.emplace_back(name_of(kind));
    const auto present = [&f] {
        return static_cast<std::size_t>(std::find(kAllFaults.begin(), kAllFaults.end(), f.kind) -
                                        kAllFaults.begin());
    };
    return {
        required(choice_field("kind",
                              {std::move(words), [&f](std::size_t i) { f.kind = kAllFaults[i]; }, present},
                              "kind of fault (docs/faults.md)")),
        number("rate", f.order.rate, 1, {0, 1},
               "share of packets, messages, frames or pixels that the fault strikes"),
        number("value", f.order.value, 1, {-1e9, 1e9}, "value of the fault; its meaning depends on the kind"),
        number("at_s", f.at_s, 1, {0, 1e7}, "time from the start at which the fault is injected"),
        integer("from_frame", f.from_frame, {0, 9e15},
                "first frame that the fault strikes; 0: it acts at once, or with 'frames' from the next "
                "frame to start"),
        integer("frames", f.frames, {0, 9e15}, "number of frames that the fault lasts; 0: no end"),
        number("duration_s", f.order.duration_s, 1, {0, 1e7}, "time that the fault lasts; 0: no end"),
    };
}

FaultOrder order_of(const FaultConfig& f) {
    FaultOrder order = f.order;
    order.kind = f.kind;
    order.from_frame = static_cast<std::uint64_t>(f.from_frame);
    order.frames = static_cast<std::uint64_t>(f.frames);
    return order;
}

void validate(const FaultConfig& f) {
    if (const std::string_view reason = refusal_of(order_of(f)); !reason.empty())
        throw InputError(std::string(name_of(f.kind)) + ": " + std::string(reason) + "; it " +
                         std::string(meaning_of(f.kind)));
}

}  // namespace hilcam
