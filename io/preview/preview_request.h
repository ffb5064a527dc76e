#pragma once
// Decodes what the preview's page asks for from the text of a request: a part of the picture, new settings, a
// trigger, a fault. Pure functions over outside bytes; an impossible request throws InputError with one line
// that names the key, what was found and what is accepted.

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

// "a=1&b=two" in its order. Keys and values are letters, digits and "_.+-"; nothing is percent-encoded.
using FormFields = std::vector<std::pair<std::string_view, std::string_view>>;
FormFields parse_form(std::string_view text);

// A part of the frame, every step x step pixels as their mean. width or height 0: up to the frame's edge.
struct PictureRequest {
    std::uint64_t viewer = 0;  // made up by the page, so that viewers can be counted
    std::uint64_t after = 0;   // wait for a frame with another id than this; 0: the newest there is
    int x = 0, y = 0, width = 0, height = 0;
    int step = 1;
    bool hold = false;                 // keep the frame, so that its numbers can be saved later
    bool truth = false;                // one whose truth is told, if it comes in time
    std::optional<LightPart> light{};  // one part of the frame's light alone; none: the picture
};
PictureRequest parse_picture_request(std::string_view query);

// A frame's numbers as a file.
struct NumbersRequest {
    std::uint64_t viewer = 0;
    std::uint64_t frame = 0;  // one that is held, or the newest; 0: the newest
    bool tiff = false;        // true: TIFF, false: PNG
};
NumbersRequest parse_numbers_request(std::string_view query);
// frame=ID.
std::uint64_t parse_truth_request(std::string_view query);

// Keys are the names of visit_settings().
SettingsChange parse_settings_change(std::string_view body);
TriggerOrder parse_trigger_order(std::string_view body);
// kind=NAME, rate, value, from_frame, frames, duration_s; or clear_all=1.
struct FaultRequest {
    bool clear_all = false;
    FaultOrder order;
};
FaultRequest parse_fault_request(std::string_view body);

std::string_view name_of(TriggerSource source);
std::string_view name_of(TestPattern pattern);

// May a request with this Host header be answered? A web site can have its own name resolve to this machine
// (DNS rebinding), but not a numeric address or "localhost": only those and the machine's own name are ours.
bool is_own_host(std::string_view host, std::string_view machine_name);
// May it change something? Browsers name the page that sends a POST in Origin; it has to be ours.
bool is_own_origin(std::string_view origin, std::string_view host);

}  // namespace hilcam
