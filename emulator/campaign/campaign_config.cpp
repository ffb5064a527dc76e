#include "emulator/campaign/campaign_config.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "io/config/config_yaml.h"
#include "io/system/shipped_parts.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

constexpr std::array kLabelWords = {"coco", "bop", "yolo", "speed"};
constexpr std::array kLayerWords = {"object", "range", "depth", "normal", "position"};

template <std::size_t N>
void require_words(const std::string& key, const std::vector<std::string>& found,
                   const std::array<const char*, N>& known) {
    std::string accepted_words;
    for (const char* word : known) accepted_words += (accepted_words.empty() ? "" : ", ") + std::string(word);
    for (const std::string& word : found)
        if (std::find(known.begin(), known.end(), word) == known.end())
            throw refused_key(key, in_quotes(word), "a list of " + accepted_words);
}

// Names of splits become file names.
bool is_file_word(const std::string& word) {
    return !word.empty() && word.size() <= 40 && std::all_of(word.begin(), word.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
               c == '-';
    });
}

// Two parts of a campaign must not set the same key, because one of the two values would be lost.
void check_keys(const CampaignConfig& c) {
    std::set<std::string> keys;
    for (std::size_t i = 0; i < c.vary.size(); ++i) {
        const std::string& key = c.vary[i].key;
        const std::string at = "vary." + std::to_string(i) + ".key";
        if (!keys.insert(key).second) throw refused_key(at, in_quotes(key) + " twice", "each key once");
        if (key == "seed") throw refused_key(at, "'seed'", "another key; each case has a seed of its own");
        if (c.view && (key.starts_with("camera_pose") || key.starts_with("camera_motion")))
            throw refused_key(at, in_quotes(key), "a key that 'view' does not give");
        if (c.view && c.view->signal_dn && key == "camera.exposure_ms")
            throw refused_key(at, in_quotes(key), "a key that view.signal_dn does not give");
    }
}

// Finds the scenario: a file beside the campaign file, or a shipped scenario, as on the command line.
std::filesystem::path scenario_file(const std::string& word, const std::filesystem::path& folder) {
    std::error_code error;
    const std::filesystem::path beside = folder / word;
    return std::filesystem::exists(beside, error) ? beside : named_config(word);
}

}  // namespace

std::size_t VaryConfig::dimensions() const { return attitude || has_sphere ? 3 : 1; }

Fields fields(VaryConfig& v) {
    Fields list = {
        required(text("key", v.key, "key of the scenario as for --set: camera.exposure_ms")),
        optional(texts("choice", v.choice, "values of equal probability; null: without the key"),
                 v.has_choice),
        optional(numbers("whole", v.whole, 1, {-9e15, 9e15}, {2, 2},
                         "limits of a uniformly distributed whole number"),
                 v.has_whole),
        optional(numbers("sphere", v.sphere, 1, {0, 1e13}, {2, 2},
                         "limits of a vector's length, in the key's unit; its direction is uniform"),
                 v.has_sphere),
        flag("attitude", v.attitude,
             "true: a quaternion [w, x, y, z], uniform over all attitudes (Shoemake, Graphics Gems III, "
             "1992)"),
    };
    for (Field& field : fields(v.draw))
        if (field.key != "choice") list.push_back(std::move(field));
    return list;
}

void validate(const VaryConfig& v) {
    const int kinds = v.has_choice + v.has_whole + v.has_sphere + v.attitude + (v.draw ? 1 : 0);
    if (kinds != 1)
        throw KeyError("key", "found " + std::to_string(kinds) + " distributions for " + in_quotes(v.key) +
                                  "; accepted: one of value, uniform, log_uniform, normal, choice, whole, "
                                  "sphere, attitude");
    if (v.draw) validate(v.draw);
    if (v.has_choice && v.choice.empty()) throw refused_key("choice", "an empty list", "one value or more");
    const auto rising = [](const char* key, const std::vector<double>& ends) {
        if (!(ends[0] <= ends[1]))
            throw refused_key(key, exact_number(ends[0]) + " before " + exact_number(ends[1]),
                              "the least, then the most");
    };
    if (v.has_whole) rising("whole", v.whole);
    if (v.has_sphere) rising("sphere", v.sphere);
}

Fields fields(BeforeConfig& b) {
    return {choice("body", b.body, std::vector<std::string>(kBodyNames.begin(), kBodyNames.end()),
                   "body whose disk is behind the target"),
            number("share", b.share, 1, {0, 1},
                   "share of cases with the body behind the target; in the others it is not")};
}

Fields fields(ViewConfig& v) {
    return {
        section("size_px", v.size_px,
                "apparent diameter of the target's bounding sphere, which sets the range [px]"),
        section("range_m", v.range_m, "distance to the target's origin, instead of size_px [m]"),
        section("phase_deg", v.phase_deg, "angle Sun - target - camera; left out: uniform direction [deg]"),
        section("offset_share", v.offset_share,
                "distance of the target from the frame's centre along each axis, as a share of the distance "
                "to the edge; left out: 0, at the centre"),
        section("roll_deg", v.roll_deg, "rotation about the line of sight; left out: random [deg]"),
        section("signal_dn", v.signal_dn,
                "DN of the lit part of a grey sphere with the target's reflectance, which sets the exposure"),
        section("before", v.before, "body in the background"),
    };
}

void validate(const ViewConfig& v) {
    if (v.size_px.has_value() == v.range_m.has_value())
        throw KeyError("size_px", std::string("found ") + (v.size_px ? "both" : "neither") +
                                      " of size_px and range_m; accepted: one of them");
    if (v.before && v.phase_deg && v.before->share > 0)
        throw KeyError("phase_deg",
                       "has no effect where 'before' says where the camera stands; accepted: one of them");
}

Fields fields(RequireConfig& r) {
    return {
        choice("in_field", r.in_field, {"any", "center", "whole"},
               "part of the target that must be in the frame: any part, its origin, or the whole target"),
        number("margin_px", r.margin_px, 1, {0, 1e5},
               "distance from the frame's edges that in_field requires"),
        number("lit_share", r.lit_share, 1, {0, 1},
               "smallest share of the target's visible pixels that face the Sun, times the share of the Sun "
               "that no body hides"),
        number("visible_fraction", r.visible_fraction, 1, {0, 1},
               "least visible share of the target's silhouette (docs/truth.md)"),
        number("sunlit_fraction", r.sunlit_fraction, 1, {0, 1},
               "smallest share of sunlight at the target that no body hides"),
        integer("visible_px", r.visible_px, {0, 1e9}, "smallest number of the target's visible pixels"),
        integer("tries", r.tries, {1, DrawSource::kMaxTries - 1.0},
                "largest number of draws of a case; after them it has failed"),
    };
}

Fields fields(SplitConfig& s) {
    return {required(text("name", s.name, "name of the part: train, val, test")),
            required(number("share", s.share, 1, {0, 1}, "share of the cases in this part"))};
}
void validate(const SplitConfig& s) {
    if (!is_file_word(s.name))
        throw refused_key("name", in_quotes(s.name), "letters, digits, _ and -, 40 at most");
}

Fields fields(KeypointsConfig& k) {
    return {integer("object", k.object, {1, 1e6}, "number of the object, from 1"),
            required(path("file", k.file,
                          "CSV with the columns name, x_m, y_m, z_m, in the object's axes, and optionally "
                          "part: the joint's node with which the point turns")),
            number("tolerance_m", k.tolerance_m, 1, {0, 1e6},
                   "distance by which a surface must be nearer than a point to hide it")};
}

Fields fields(PicturesConfig& p) {
    return {
        choice("kind", p.kind, {"png", "tiff", "fits", "raw"}, "picture format of the frames"),
        flag("view", p.view, "true: an 8-bit PNG to look at beside each frame (docs/pictures.md)"),
        texts("layers", p.layers,
              "layers of truth written as OpenEXR: object, range, depth, normal, position (docs/truth.md)"),
        integer("count", p.count, {1, 1000}, "number of successive pictures of a case"),
        number("interval_s", p.interval_s, 1, {1e-6, 1e7}, "simulated time between successive pictures [s]"),
        flag("flow", p.flow, "true: optical flow to the next picture is written as OpenEXR"),
        flag("variance", p.variance,
             "true: variance of each pixel's DN by sensor and rendering noise [DN^2] is written as OpenEXR"),
    };
}
void validate(const PicturesConfig& p) {
    require_words("layers", p.layers, kLayerWords);
    if (p.flow && p.count < 2)
        throw refused_key("flow", "true with one picture a case", "count: 2 or more with it");
}

Fields fields(RunConfig& r) {
    return {
        texts("program", r.program,
              "program started beside each run, with its arguments. {case}, {seed}, {slot}, {case_folder}, "
              "{udp_port} and {tcp_port} stand for values of the case; left out: none"),
        texts("set", r.set, "KEY=VALUE for each run, with the same placeholders as program"),
        integer("frames", r.frames, {0, 1e9}, "largest number of frames of a run; 0: no limit"),
        number("duration_s", r.duration_s, 1, {0, 1e7}, "longest duration of a run [s]; 0: no limit"),
    };
}
void validate(const RunConfig& r) {
    if (r.program.empty() && r.frames == 0 && !(r.duration_s > 0))
        throw KeyError("frames",
                       "a run without a program needs an end; accepted: frames or duration_s above 0");
}

Fields fields(CampaignConfig& c) {
    return {
        required(text("name", c.name, "name of the campaign")),
        required(text("scenario", c.scenario_name,
                      "file relative to this one's folder, or name of a shipped scenario")),
        texts("set", c.set, "KEY=VALUE as for --set, for every case"),
        integer("camera", c.camera, {1, 16}, "number of the scenario's camera, from 1"),
        integer("target", c.target, {1, 1e6}, "number of the target object of view and require, from 1"),
        integer("count", c.count, {1, 1e9}, "number of cases"),
        integer("seed", c.seed, {0, 9e15}, "seed of all random draws"),
        choice("sequence", c.sequence, {"random", "halton", "r_sequence"},
               "sequence of the draws. random: independent; halton, r_sequence: evenly spread over all keys "
               "that vary"),
        path("table", c.table, "CSV with a column for each key of the scenario and a row for each case"),
        sections("vary", c.vary, "keys of the scenario that vary from case to case"),
        section("view", c.view,
                "placement of the camera relative to the target; replaces camera_pose and camera_motion"),
        section("require", c.require, "requirements on a case, which is drawn again until it meets them"),
        sections("splits", c.splits, "random parts of the cases; left out: a single part"),
        section("pictures", c.pictures, "pictures of each case"),
        texts("labels", c.labels, "label formats to write: coco, bop, yolo, speed"),
        sections("keypoints", c.keypoints, "key points of objects"),
        integer("shard_samples", c.shard_samples, {0, 1e7},
                "pictures in each tar file for WebDataset; 0: no tar files"),
        section("run", c.run, "runs of the bench in place of pictures"),
        number("time_limit_s", c.time_limit_s, 1, {0.1, 1e7},
               "longest time of a case; then it is ended and has failed [s]"),
    };
}

void validate(const CampaignConfig& c) {
    require_words("labels", c.labels, kLabelWords);
    double sum = 0;
    std::set<std::string> names;
    for (const SplitConfig& split : c.splits) {
        sum += split.share;
        if (!names.insert(split.name).second)
            throw refused_key("splits", in_quotes(split.name) + " twice", "each once");
    }
    if (!c.splits.empty() && std::abs(sum - 1) > 1e-9)
        throw refused_key("splits", "shares of " + exact_number(sum) + " in all", "shares of 1 in all");
    check_keys(c);
    if (c.view && c.camera != 1)
        throw refused_key("camera", std::to_string(c.camera),
                          "1 with 'view', which places the body that all cameras ride on by the first");
    if (c.run && c.view)
        throw KeyError("view",
                       "has no effect with 'run', whose program moves the camera; accepted: one of them");
    if (c.run && (!c.labels.empty() || !c.keypoints.empty() || c.shard_samples > 0))
        throw KeyError("run",
                       "runs have no labels; accepted: labels, keypoints and shard_samples without 'run'");
    if (c.run && c.require.any()) throw KeyError("require", "applies to pictures; accepted: without 'run'");
}

CampaignConfig load_campaign(const std::filesystem::path& file, std::span<const std::string> overrides) {
    if (has_top_level_key(file, "time_utc"))
        throw InputError(file.string() +
                         ": is a scenario; accepted: a campaign, which has it as 'scenario: " +
                         file.filename().string() + "'");
    CampaignConfig campaign;
    read_config(file, section_of(campaign), overrides);
    campaign.scenario = scenario_file(campaign.scenario_name, file.parent_path());
    return campaign;
}

}  // namespace hilcam
