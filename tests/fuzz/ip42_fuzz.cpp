// Any bytes are 42's messages or refusals in one line, the same in pieces as at once; what follows from them
// are possible poses and angles.

#include <algorithm>
#include <string>
#include <vector>

#include "io/ip42/ip42_stream.h"
#include "io/ip42/ip42_world.h"
#include "render/sky/motion_bounds.h"
#include "render/vocabulary/check.h"

namespace {

using namespace hilcam;

void check_one_line(const std::string& text) { HILCAM_CHECK(text.find('\n') == std::string::npos); }

std::vector<Ip42BodyConfig> bodies() {
    std::vector<Ip42BodyConfig> list(4);
    list[0].body = "SC[0].B[0]";
    for (std::size_t i = 1; i < list.size(); ++i) {
        list[i].body = "SC[1].B[" + std::to_string(i - 1) + "]";
        list[i].moves = "target";
        list[i].joint = static_cast<std::int64_t>(i) - 1;
    }
    list[1].place_m = {1, 2, 3};
    return list;
}

// In pieces of `size` bytes, as a socket gives them.
std::vector<Ip42Stream::Found> messages_in(std::string_view bytes, std::size_t size) {
    Ip42Stream stream;
    std::vector<Ip42Stream::Found> out;
    while (!bytes.empty()) {
        stream.put(bytes.substr(0, size));
        bytes.remove_prefix(std::min(size, bytes.size()));
        while (auto found = stream.take()) out.push_back(std::move(*found));
        HILCAM_CHECK(stream.size() <= 2 * Ip42Stream::kMaxMessage_bytes);
    }
    return out;
}

void check(const Command& command) {
    if (const auto* pose = std::get_if<PoseCommand>(&command))
        HILCAM_CHECK(pose->object <= 1 && is_possible(pose->motion));
    else if (const auto* joint = std::get_if<JointCommand>(&command))
        HILCAM_CHECK(is_possible_turn_of_joint(joint->angle_rad, joint->rate_rad_s));
    else
        HILCAM_CHECK(false);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    const std::vector<Ip42Stream::Found> found = messages_in(bytes, 16384), again = messages_in(bytes, 7);
    HILCAM_CHECK(found.size() == again.size());
    FirstRemarks remarks(check_one_line);
    OriginConfig origin;
    origin.kind = OriginConfig::Kind::kEarthFixed;
    Ip42World world({bodies(), {}, 1e-3, true}, {origin, {{"target", {{0, 1, 0}, {1, 1, 0}}}}}, remarks);
    for (std::size_t i = 0; i < found.size(); ++i) {
        HILCAM_CHECK(found[i].text == again[i].text && found[i].too_long == again[i].too_long);
        const DecodedIp42 decoded = decode_ip42(found[i].text);
        check_one_line(decoded.refusal);
        if (!decoded.refusal.empty()) continue;
        for (const Command& command : world.commands_of(decoded.message)) check(command);
    }
    return 0;
}
