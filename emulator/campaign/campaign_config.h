#pragma once
// The campaign file: a scenario, what varies from case to case, and what is kept of each case
// (docs/campaigns.md).

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "emulator/campaign/draw_source.h"
#include "emulator/campaign/number_draw.h"
#include "render/sky/bodies.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

// A key of the scenario that gets another value in each case.
struct VaryConfig {
    std::string key;
    NumberDraw draw;
    std::vector<std::string> choice;  // values, written as in the scenario file
    std::vector<double> whole;        // smallest and largest whole number
    std::vector<double> sphere;       // smallest and largest radius, in the key's unit
    bool attitude = false;
    bool has_choice = false, has_whole = false, has_sphere = false;

    // Returns how many dimensions of the draw the value uses.
    std::size_t dimensions() const;
};
Fields fields(VaryConfig& vary);
void validate(const VaryConfig& vary);

// The body in front of which the target stands.
struct BeforeConfig {
    BodyId body = BodyId::kEarth;
    double share = 1;
};
Fields fields(BeforeConfig& before);

// The camera's position relative to its target.
struct ViewConfig {
    std::optional<NumberDraw> size_px, range_m, phase_deg, offset_share, roll_deg, signal_dn;
    std::optional<BeforeConfig> before;
};
Fields fields(ViewConfig& view);
void validate(const ViewConfig& view);

// Conditions that a case must meet; a case is drawn again until it does.
struct RequireConfig {
    enum class InField { kAny, kCenter, kWhole } in_field = InField::kAny;
    double margin_px = 0;
    double lit_share = 0, visible_fraction = 0, sunlit_fraction = 0;
    std::int64_t visible_px = 0;
    std::int64_t tries = 1000;

    bool needs_rays() const {
        return lit_share > 0 || visible_fraction > 0 || visible_px > 0 || in_field == InField::kWhole;
    }
    bool any() const { return needs_rays() || sunlit_fraction > 0 || in_field != InField::kAny; }
};
Fields fields(RequireConfig& require);

struct SplitConfig {
    std::string name;
    double share = 0;
};
Fields fields(SplitConfig& split);
void validate(const SplitConfig& split);

struct KeypointsConfig {
    std::int64_t object = 1;
    std::filesystem::path file;
    double tolerance_m = 0.01;
};
Fields fields(KeypointsConfig& keypoints);

struct PicturesConfig {
    enum class Kind { kPng, kTiff, kFits, kRaw } kind = Kind::kPng;
    bool view = true;
    std::vector<std::string> layers;  // words of outputs.truth.layers
    std::int64_t count = 1;           // pictures of a case, in sequence
    double interval_s = 0.1;
    bool flow = false, variance = false;
};
Fields fields(PicturesConfig& pictures);
void validate(const PicturesConfig& pictures);

// A case that is a run of `hilcam run`, with the user's program beside it.
struct RunConfig {
    std::vector<std::string> program;  // command line, the program first; empty: no program
    std::vector<std::string> set;      // KEY=VALUE for each run
    std::int64_t frames = 0;
    double duration_s = 0;
};
Fields fields(RunConfig& run);
void validate(const RunConfig& run);

struct CampaignConfig {
    std::string name;
    std::string scenario_name;  // scenario as the campaign file names it
    std::filesystem::path scenario;
    std::vector<std::string> set;
    std::int64_t camera = 1, target = 1;
    std::int64_t count = 1, seed = 1;
    DrawSequence sequence = DrawSequence::kRandom;
    std::filesystem::path table;
    std::vector<VaryConfig> vary;
    std::optional<ViewConfig> view;
    RequireConfig require;
    std::vector<SplitConfig> splits;
    PicturesConfig pictures;
    std::vector<std::string> labels;  // coco, bop, yolo, speed
    std::vector<KeypointsConfig> keypoints;
    std::int64_t shard_samples = 0;  // 0: no shards
    std::optional<RunConfig> run;
    double time_limit_s = 600;
};
Fields fields(CampaignConfig& campaign);
void validate(const CampaignConfig& campaign);

// Reads and checks a campaign file; `scenario` becomes a path. Throws InputError.
CampaignConfig load_campaign(const std::filesystem::path& file, std::span<const std::string> overrides = {});

}  // namespace hilcam
