#pragma once
// Decodes requests of the preview's page: a part of the picture, new settings, a trigger, a fault. Pure
// functions over untrusted bytes. An impossible request throws InputError, one line with the key, what was
// found and what is accepted.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/contract/camera_control.h"
#include "io/contract/fault.h"
#include "render/vocabulary/light_part.h"

namespace hilcam {

// The fields of "a=1&b=two", in order. Keys and values have letters, digits and "_.+-"; percent encoding is
// not used.
using FormFields = std::vector<std::pair<std::string_view, std::string_view>>;
FormFields parse_form(std::string_view text);

// A part of the frame, reduced to means of step x step pixels. width or height 0: up to the frame's edge.
struct PictureRequest {
    std::uint64_t viewer = 0;  // chosen by the page, for counting viewers
    std::uint64_t after = 0;   // wait for a frame with another id; 0: the newest
    int x = 0, y = 0, width = 0, height = 0;
    int step = 1;
    bool hold = false;                 // keep the frame, so that its numbers can be saved later
    bool truth = false;                // prefer a frame with truth, if it comes in time
    std::optional<LightPart> light{};  // one part of the frame's light only; none: the whole picture
};
PictureRequest parse_picture_request(std::string_view query);

// A request for a frame's numbers as a file.
struct NumbersRequest {
    std::uint64_t viewer = 0;
    std::uint64_t frame = 0;  // a kept frame or the newest; 0: the newest
    bool tiff = false;        // true: TIFF, false: PNG
};
NumbersRequest parse_numbers_request(std::string_view query);
// Parses frame=ID.
std::uint64_t parse_truth_request(std::string_view query);

// Parses settings; keys are the names of visit_settings().
SettingsChange parse_settings_change(std::string_view body);
TriggerOrder parse_trigger_order(std::string_view body);
// A fault: kind=NAME, rate, value, from_frame, frames, duration_s; or clear_all=1.
struct FaultRequest {
    bool clear_all = false;
    FaultOrder order;
};
FaultRequest parse_fault_request(std::string_view body);

std::string_view name_of(TriggerSource source);
std::string_view name_of(TriggerActivation activation);
std::string_view name_of(TriggerOverlap overlap);
std::string_view name_of(ExposureMode mode);
std::string_view name_of(TestPattern pattern);

// True when a request with this Host header may be answered. A web site can make its own name resolve to this
// machine (DNS rebinding), but not a numeric address or "localhost". So only these and the machine's own name
// are accepted.
bool is_own_host(std::string_view host, std::string_view machine_name);
// True when a request may change something. Browsers name the page that sends a POST in Origin; it must be
// ours.
bool is_own_origin(std::string_view origin, std::string_view host);

}  // namespace hilcam
