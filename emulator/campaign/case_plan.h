#pragma once
// The plan of one case of a campaign: its draws as values of the scenario's keys. A case comes again alone by
// those: `hilcam render SCENARIO --set KEY=VALUE ...`.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "emulator/campaign/campaign_config.h"
#include "io/files/value_table_file.h"

namespace hilcam {

struct CasePlan {
    std::uint64_t number = 1;  // from 1
    std::string name;          // "000001"
    std::string split;         // empty: there are none
    std::int64_t seed = 1;
    std::uint32_t tries = 1;             // number of times that it was drawn
    std::vector<std::string> overrides;  // "KEY=VALUE", of the campaign and of the case
    std::vector<std::pair<std::string, std::string>> parameters;  // columns of the index
};

// Says which of a campaign's dimensions are whose, and draws what does not need a world.
class CaseDraw {
  public:
    // Throws InputError: too many dimensions for the sequence, a table that is too short.
    explicit CaseDraw(const CampaignConfig& campaign);

    // The case with its first part: seed, split, table and `vary`.
    CasePlan plan(std::uint64_t number, std::uint32_t attempt) const;
    // A place in (0, 1) of one of the view's dimensions.
    enum class View {
        kSize,
        kPhase,
        kAround,
        kOffsetX,
        kOffsetY,
        kRoll,
        kSignal,
        kBefore,
        kDiskX,
        kDiskY,
        kCount
    };
    double view_place(std::uint64_t number, std::uint32_t attempt, View dimension) const;

    // The columns that plan() gives, in their order.
    std::vector<std::string> columns() const;

  private:
    const CampaignConfig& campaign_;
    std::optional<ValueTable> table_;
    std::size_t first_of_view_ = 0;
    DrawSource source_;
};

std::string case_name(std::uint64_t number);
// Adds "KEY=VALUE", in the place of what the list has of that key.
void set_override(std::vector<std::string>& overrides, const std::string& key, const std::string& value);
void set_override(std::vector<std::string>& overrides, const std::string& key_and_value);

// A unit vector, even over all directions, by two places (Archimedes' hat-box theorem), and an attitude, even
// over all, by three (Shoemake, "Uniform random rotations", Graphics Gems III, 1992).
Vec3d direction_at(double place_z, double place_around);
Quat attitude_at(double a, double b, double c);
// "[1, 2, 3]", as a file takes it.
std::string yaml_text(Vec3d v);
std::string yaml_text(Quat q);

}  // namespace hilcam
