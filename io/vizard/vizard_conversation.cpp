#include "io/vizard/vizard_conversation.h"

#include <array>
#include <limits>
#include <string_view>

#include "io/system/bytes.h"
#include "io/system/text_number.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// Followed by "_" and a camera's number, or alone.
constexpr std::string_view kImageRequest = "REQUEST_IMAGE";
constexpr std::size_t kUpdateParts = 4;

std::span<const std::uint8_t> bytes_of(const std::string& text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

VizardParts picture_parts(std::string picture) {
    std::array<std::uint8_t, 4> length{};
    ByteWriter(length).u32(picture.size());
    return {std::string(length.begin(), length.end()), std::move(picture)};
}

}  // namespace

VizardConversation::Answer VizardConversation::answer(const VizardParts& asked) {
    if (asked.empty()) return refuse("an empty request");
    const std::string& word = asked.front();
    if (word == "PING") return {{"PONG"}};
    if (word == "SIM_UPDATE") return take_update(asked);
    if (word == "REQUEST_INPUT") return {{"VIZARD_INPUT", encode_vizard_input(world_.frame_number())}};
    if (word.starts_with(kImageRequest)) {
        const std::string_view rest = std::string_view(word).substr(kImageRequest.size());
        if (rest.empty() || rest.front() == '_') return take_picture(rest);
    }
    return refuse("a request " + in_quotes(word) +
                  "; accepted: PING, SIM_UPDATE, REQUEST_IMAGE_<cameraID>, REQUEST_IMAGE, REQUEST_INPUT");
}

VizardConversation::Answer VizardConversation::refuse(const std::string& reason) {
    world_.remark("answered ERROR to " + reason);
    return {{"ERROR"}, true};
}

VizardConversation::Answer VizardConversation::take_update(const VizardParts& asked) {
    world_.lose();
    if (asked.size() != kUpdateParts)
        return refuse("SIM_UPDATE of " + std::to_string(asked.size()) + " parts; accepted: 4");
    DecodedVizardUpdate decoded = decode_vizard_update(bytes_of(asked.back()));
    if (!decoded.refusal.empty()) return refuse("SIM_UPDATE: " + decoded.refusal);
    over_ = decoded.update.is_last;
    world_.take(std::move(decoded.update));
    return {{"OK"}};
}

// `which`: "_" and a camera's number; empty: the first camera.
VizardConversation::Answer VizardConversation::take_picture(std::string_view which) {
    Answer without{picture_parts({}), true};
    const auto id = which.empty() ? world_.first_camera() : parsed_as<std::int64_t>(which.substr(1));
    if (!id) {
        world_.remark(which.empty() ? "no picture, as no camera of a SIM_UPDATE that can be read is there"
                                    : "no picture for " + in_quotes(which.substr(1)) +
                                          ": accepted: the number of a camera");
        return without;
    }
    VizardShot shot;
    if (!world_.shot(*id, shot)) return without;
    Picture picture = photograph_(shot);
    if (picture.bytes.size() > std::numeric_limits<std::int32_t>::max())
        picture = {{}, "it has more bytes than its length field can say"};
    if (picture.bytes.empty()) {
        world_.remark("camera " + std::to_string(*id) + ": no picture: " + picture.trouble);
        return without;
    }
    return {picture_parts(std::move(picture.bytes))};
}

}  // namespace hilcam
