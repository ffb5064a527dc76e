// Any bytes are a request to the preview or a refusal; a picture request fits any frame.

#include <cmath>
#include <string_view>

#include "io/preview/preview_picture.h"
#include "io/preview/preview_request.h"
#include "render/vocabulary/check.h"

namespace {

template <class Parse>
void refuse_or(Parse&& parse) {
    try {
        parse();
    } catch (const hilcam::InputError& error) {
        HILCAM_CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    refuse_or([&] {
        const PictureRequest asked = parse_picture_request(text);
        HILCAM_CHECK(!asked.light || text.find(name_of(*asked.light)) != std::string_view::npos);
        for (const auto& [width, height] : {std::pair{1, 1}, {640, 480}, {100'000, 100'000}}) {
            const PictureRequest r = fit_to_frame(asked, width, height);
            HILCAM_CHECK(r.x >= 0 && r.y >= 0 && r.width > 0 && r.height > 0);
            HILCAM_CHECK(r.x + r.width <= width && r.y + r.height <= height && r.x % r.step == 0);
            HILCAM_CHECK(std::int64_t{(r.width - 1) / r.step + 1} * ((r.height - 1) / r.step + 1) <=
                         kMaxPictureSamples);
        }
    });
    refuse_or([&] {
        const SettingsChange c = parse_settings_change(text);
        HILCAM_CHECK(!c.exposure_s || std::isfinite(*c.exposure_s));
    });
    refuse_or([&] { parse_numbers_request(text); });
    refuse_or([&] { HILCAM_CHECK(parse_truth_request(text) > 0); });
    refuse_or([&] { parse_trigger_order(text); });
    refuse_or([&] {
        const FaultRequest r = parse_fault_request(text);
        HILCAM_CHECK(r.clear_all || refusal_of(r.order).empty());
    });
    const std::size_t half = size / 2;
    if (is_own_origin(text.substr(half), text.substr(0, half))) HILCAM_CHECK(half > 0);
    is_own_host(text, "bench");
    return 0;
}
