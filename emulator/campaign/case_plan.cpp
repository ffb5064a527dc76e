#include "emulator/campaign/case_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "render/vocabulary/quoted.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr std::uint32_t kSplitLot = 1;

std::size_t dimensions_of_vary(const CampaignConfig& campaign) {
    std::size_t sum = 0;
    for (const VaryConfig& vary : campaign.vary) sum += vary.dimensions();
    return sum;
}

std::size_t index_at(double place, std::size_t count) {
    return std::min(static_cast<std::size_t>(place * static_cast<double>(count)), count - 1);
}

// place: returns the n-th place for the key.
template <class Place>
std::string drawn_value(const VaryConfig& vary, const Place& place) {
    if (vary.has_choice) return vary.choice[index_at(place(0), vary.choice.size())];
    if (vary.attitude) return yaml_text(attitude_at(place(0), place(1), place(2)));
    if (vary.has_sphere) {
        const double length = vary.sphere[0] + place(2) * (vary.sphere[1] - vary.sphere[0]);
        return yaml_text(length * direction_at(place(0), place(1)));
    }
    if (vary.has_whole) {
        const double count = std::floor(vary.whole[1]) - std::ceil(vary.whole[0]) + 1;
        const double value = std::ceil(vary.whole[0]) + std::min(std::floor(place(0) * count), count - 1);
        return std::to_string(static_cast<std::int64_t>(value));
    }
    return exact_number(number_at(vary.draw, place(0)));
}

}  // namespace

std::string case_name(std::uint64_t number) {
    char text[24];
    std::snprintf(text, sizeof text, "%06llu", static_cast<unsigned long long>(number));
    return text;
}

void set_override(std::vector<std::string>& overrides, const std::string& key, const std::string& value) {
    std::erase_if(overrides, [&](const std::string& o) { return o.starts_with(key + "="); });
    overrides.push_back(key + "=" + value);
}

void set_override(std::vector<std::string>& overrides, const std::string& key_and_value) {
    const std::size_t equals = std::min(key_and_value.find('='), key_and_value.size());
    set_override(overrides, key_and_value.substr(0, equals),
                 key_and_value.substr(std::min(equals + 1, key_and_value.size())));
}

Vec3d direction_at(double place_z, double place_around) {
    const double z = 2 * place_z - 1, around_rad = 2 * kPi * place_around;
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    return {r * std::cos(around_rad), r * std::sin(around_rad), z};
}

Quat attitude_at(double a, double b, double c) {
    const double r1 = std::sqrt(1 - a), r2 = std::sqrt(a);
    const double t1 = 2 * kPi * b, t2 = 2 * kPi * c;
    return {std::cos(t2) * r2, std::sin(t1) * r1, std::cos(t1) * r1, std::sin(t2) * r2};
}

std::string yaml_text(Vec3d v) {
    return "[" + exact_number(v.x) + ", " + exact_number(v.y) + ", " + exact_number(v.z) + "]";
}

std::string yaml_text(Quat q) {
    return "[" + exact_number(q.w) + ", " + exact_number(q.x) + ", " + exact_number(q.y) + ", " +
           exact_number(q.z) + "]";
}

CaseDraw::CaseDraw(const CampaignConfig& campaign)
    : campaign_(campaign),
      first_of_view_(dimensions_of_vary(campaign)),
      source_(static_cast<std::uint64_t>(campaign.seed), campaign.sequence,
              first_of_view_ + (campaign.view ? static_cast<std::size_t>(View::kCount) : 0)) {
    if (campaign.table.empty()) return;
    table_ = read_value_table(campaign.table);
    if (table_->rows.size() < static_cast<std::size_t>(campaign.count))
        throw InputError(campaign.table.string() + ": found " + std::to_string(table_->rows.size()) +
                         " rows; accepted: one for each of the " + std::to_string(campaign.count) +
                         " cases (count)");
}

CasePlan CaseDraw::plan(std::uint64_t number, std::uint32_t attempt) const {
    CasePlan plan;
    plan.number = number;
    plan.name = case_name(number);
    plan.tries = attempt + 1;
    plan.seed = source_.seed_of_case(number);
    plan.overrides = campaign_.set;
    set_override(plan.overrides, "seed", std::to_string(plan.seed));
    double left = source_.lot(number, kSplitLot);
    for (const SplitConfig& split : campaign_.splits) {
        plan.split = split.name;
        if ((left -= split.share) < 0) break;
    }
    const auto add = [&](const std::string& key, const std::string& value) {
        plan.parameters.emplace_back(key, value);
        set_override(plan.overrides, key, value);
    };
    if (table_)
        for (std::size_t c = 0; c < table_->columns.size(); ++c)
            add(table_->columns[c], table_->rows[number - 1][c]);
    std::size_t first = 0;
    for (const VaryConfig& vary : campaign_.vary) {
        add(vary.key,
            drawn_value(vary, [&](std::size_t d) { return source_.place(number, attempt, first + d); }));
        first += vary.dimensions();
    }
    return plan;
}

double CaseDraw::view_place(std::uint64_t number, std::uint32_t attempt, View dimension) const {
    return source_.place(number, attempt, first_of_view_ + static_cast<std::size_t>(dimension));
}

std::vector<std::string> CaseDraw::columns() const {
    std::vector<std::string> out;
    if (table_) out = table_->columns;
    for (const VaryConfig& vary : campaign_.vary) out.push_back(vary.key);
    return out;
}

}  // namespace hilcam
