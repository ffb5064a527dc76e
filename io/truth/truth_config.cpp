#include "io/truth/truth_config.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "io/system/allow_list.h"
#include "io/system/fd.h"
#include "io/truth/truth_files.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

struct LayerName {
    std::string_view word;
    bool TruthRequest::*member;
};
constexpr std::array kLayers = {
    LayerName{"object", &TruthRequest::object}, LayerName{"range", &TruthRequest::range},
    LayerName{"depth", &TruthRequest::depth}, LayerName{"normal", &TruthRequest::normal},
    LayerName{"position", &TruthRequest::position}};

const LayerName* layer_named(std::string_view word) {
    const auto found = std::find_if(kLayers.begin(), kLayers.end(),
                                    [word](const LayerName& layer) { return layer.word == word; });
    return found == kLayers.end() ? nullptr : &*found;
}

}  // namespace

Fields fields(TruthConfig& c) {
    return {
        text("address", c.address, "IPv4 address of this machine to listen on"),
        integer("port", c.port, {0, 65535},
                "TCP port on which clients receive one line of JSON per frame; 0: none"),
        allow_field(c.allow),
        integer("clients", c.clients, {1, 1000},
                "largest number of connections at a time; further ones are closed at once"),
        texts("udp_to", c.udp_to, "receivers of the lines as datagrams, each ADDRESS:PORT"),
        path("folder", c.folder,
             "folder of truth.jsonl and of the layers' pictures, created if missing; left out: no files"),
        texts("layers", c.layers,
              "layers of values for each pixel, in files like truth_00000001.exr: object, range, depth, "
              "normal, position"),
        flag("visibility", c.visibility,
             "true: pixels, boxes and visible share of each thing are computed, with one ray per pixel"),
        flag("stars", c.stars, "true: the stars in view are listed"),
        number("faintest_magnitude", c.faintest_magnitude, 1, {-2, 30},
               "magnitude of the faintest stars listed"),
        number("ground_px", c.ground_px, 1, {0, 1e4},
               "smallest diameter in the frame of listed craters and boulders of terrain.globe [px]; 0: none "
               "are listed"),
        integer("every_nth", c.every_nth, {1, 1e9}, "number n of which every n-th frame has truth"),
        flag("overwrite", c.overwrite,
             "treatment of a folder with truth of another run. false: it is refused; true: the truth is "
             "removed first"),
        when_slow(c.when_slow),
    };
}

void validate(const TruthConfig& c) {
    if (c.port == 0 && c.udp_to.empty() && c.folder.empty())
        throw InputError("outputs.truth goes nowhere; accepted: one of port, udp_to and folder, or several");
    if (c.port != 0) AllowList(c.allow, c.address, "outputs.truth");
    for (const std::string& to : c.udp_to) parse_endpoint(to);
    for (const std::string& word : c.layers)
        if (!layer_named(word))
            throw refused("layers", in_quotes(word), "object, range, depth, normal, position");
    if (!c.layers.empty() && c.folder.empty())
        throw InputError("'layers' are written as pictures: they need 'folder'");
}

RunFolder run_folder(const TruthConfig& c) {
    return {.key = "outputs.truth",
            .folder = c.folder,
            .is_own = [](std::string_view name) { return name == kTruthLines || is_numbered(name, "truth"); },
            .overwrite = c.overwrite};
}

TruthRequest request_of(const TruthConfig& c) {
    TruthRequest request;
    request.visibility = c.visibility;
    request.stars = c.stars;
    request.faintest_magnitude = c.faintest_magnitude;
    for (const std::string& word : c.layers)
        if (const LayerName* layer = layer_named(word)) request.*(layer->member) = true;
    return request;
}

std::vector<ListeningPort> listening(const TruthConfig& c) {
    return {{"outputs.truth.port", c.address, c.port}};
}

}  // namespace hilcam
