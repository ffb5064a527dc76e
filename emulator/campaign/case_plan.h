#pragma once
// The plan of one case of a campaign: its drawn values, as values of scenario keys. With these a case can be
// made again alone: `hilcam render SCENARIO --set KEY=VALUE ...`.

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
    std::string split;         // empty: the campaign has no splits
    std::int64_t seed = 1;
    std::uint32_t tries = 1;             // number of attempts at drawing it
    std::vector<std::string> overrides;  // "KEY=VALUE", from the campaign and from the case
    std::vector<std::pair<std::string, std::string>> parameters;  // columns of the index
};

// Assigns a campaign's dimensions to its keys, and draws what does not need a world.
class CaseDraw {
  public:
    // Throws InputError for more dimensions than the sequence has, or a table that is too short.
    explicit CaseDraw(const CampaignConfig& campaign);

    // Returns the case with its first part filled: seed, split, table and `vary`.
    CasePlan plan(std::uint64_t number, std::uint32_t attempt) const;
    // The view's dimensions. view_place() returns the place of one of them, in (0, 1).
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

    // Returns the columns that plan() fills, in order.
    std::vector<std::string> columns() const;

  private:
    const CampaignConfig& campaign_;
    std::optional<ValueTable> table_;
    std::size_t first_of_view_ = 0;
    DrawSource source_;
};

std::string case_name(std::uint64_t number);
// Sets "KEY=VALUE", replacing an earlier value of the same key.
void set_override(std::vector<std::string>& overrides, const std::string& key, const std::string& value);
void set_override(std::vector<std::string>& overrides, const std::string& key_and_value);

// direction_at() returns a unit vector from two places in (0, 1), uniform over the sphere (Archimedes'
// hat-box theorem). attitude_at() returns an attitude from three, uniform over all attitudes (Shoemake,
// "Uniform random rotations", Graphics Gems III, 1992).
Vec3d direction_at(double place_z, double place_around);
Quat attitude_at(double a, double b, double c);
// Returns "[1, 2, 3]", as a scenario file has it.
std::string yaml_text(Vec3d v);
std::string yaml_text(Quat q);

}  // namespace hilcam
