#include "render/earth/detail_tiles.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/earth/map_looks.h"
#include "render/vocabulary/check.h"

namespace hilcam {

DetailTiles::DetailTiles(const EarthDetail::Shape& shape, std::size_t most) : shape_(shape) {
    HILCAM_CHECK(most > 0 && shape.levels > 0);
    slots_.resize(most);
    texels_.resize(most * EarthDetail::kTexels);
    table_.assign(std::bit_ceil(4 * most), kFree);
}

std::size_t DetailTiles::find(std::uint64_t word) const {
    for (std::size_t at = first_of(word);; at = (at + 1) & (table_.size() - 1)) {
        if (table_[at] == kFree) return kNone;
        if (slots_[table_[at]].word == word) return table_[at];
    }
}

void DetailTiles::insert(std::size_t place) {
    std::size_t at = first_of(slots_[place].word);
    while (table_[at] != kFree) at = (at + 1) & (table_.size() - 1);
    table_[at] = static_cast<std::uint32_t>(place);
}

bool DetailTiles::choose(const DetailKey& key) {
    const std::size_t place = find(word_of(key));
    if (place == kNone) return false;
    slots_[place].seen = frame_;
    return true;
}

std::size_t DetailTiles::take_place() {
    std::size_t oldest = kNone;
    for (std::size_t i = 0; i < slots_.size(); ++i)
        if (!slots_[i].is_taken && slots_[i].seen < frame_ &&
            (oldest == kNone || slots_[i].seen < slots_[oldest].seen))
            oldest = i;
    if (oldest == kNone) return kNone;
    const bool was_there = slots_[oldest].word != 0;
    slots_[oldest].word = 0, slots_[oldest].is_taken = true;
    if (!was_there) return oldest;
    // A hash table with open addressing has to be rebuilt when an entry is removed.
    std::fill(table_.begin(), table_.end(), kFree);
    for (std::size_t i = 0; i < slots_.size(); ++i)
        if (slots_[i].word != 0) insert(i);
    return oldest;
}

void DetailTiles::put(std::size_t place, const DetailKey& key, bool is_whole) {
    slots_[place] = {word_of(key), frame_ - 1, false, is_whole};
    insert(place);
}

const EarthMap::Texel* DetailTiles::seen(int level, int column, int row) const {
    const std::size_t place = find(word_of({level, column, row}));
    if (place == kNone || slots_[place].seen != frame_ || !slots_[place].is_whole) return nullptr;
    return texels_.data() + place * EarthDetail::kTexels;
}

void DetailTiles::add_at(const EarthMap& below, float u, float v, int level, float weight,
                         EarthSample& sum) const {
    for (; level < shape_.levels; ++level) {
        const int columns = shape_.columns_at(level), rows = shape_.rows_at(level);
        // A map's size may not be a multiple of the level's; the remainder belongs to the last column.
        const float width = std::ldexp(static_cast<float>(shape_.columns), -level),
                    height = std::ldexp(static_cast<float>(shape_.rows), -level);
        float x = (u - std::floor(u)) * width - 0.5f;
        const float y = std::clamp(v, 0.0f, 1.0f) * height - 0.5f;
        if (x < 0) x += static_cast<float>(columns);
        const int left = std::min(static_cast<int>(x), columns - 1),
                  top = std::clamp(static_cast<int>(y), 0, rows - 1);
        const float right = std::min(1.0f, x - static_cast<float>(left)),
                    down = std::clamp(y - static_cast<float>(top), 0.0f, 1.0f);
        constexpr int kTile = EarthDetail::kTile;
        const EarthMap::Texel* const tile = seen(level, left / kTile, top / kTile);
        if (!tile) continue;
        const EarthMap::Texel* const first = tile + top % kTile * EarthDetail::kSide + left % kTile;
        EarthMap::mix_texels({first, first + 1, first + EarthDetail::kSide, first + EarthDetail::kSide + 1},
                             right, down, weight, sum);
        return;
    }
    below.add_at_level(u, v, static_cast<float>(level) + shape_.base_level, weight, sum);
}

void DetailTiles::add(const EarthMap& below, float u, float v, float level, float weight,
                      EarthSample& sum) const {
    if (level >= static_cast<float>(shape_.levels))
        return below.add_at_level(u, v, level + shape_.base_level, weight, sum);
    const int finer = static_cast<int>(level);
    const float share = level - static_cast<float>(finer);
    if (share < 1e-3f) return add_at(below, u, v, finer, weight, sum);
    add_at(below, u, v, finer, weight * (1 - share), sum);
    add_at(below, u, v, finer + 1, weight * share, sum);
}

EarthSample DetailTiles::sample(const EarthMap& below, float u, float v, const MapFootprint& f) const {
    EarthSample sum;
    each_look(u, v, f, {static_cast<float>(shape_.columns), static_cast<float>(shape_.rows)},
              [&](float at_u, float at_v, float level, float weight) {
                  add(below, at_u, at_v, level, weight, sum);
              });
    return sum;
}

EarthSample DetailTiles::sample(const EarthMap& below, float u, float v, float width) const {
    EarthSample sum;
    add(below, u, v, std::log2(std::max(1.0f, width * static_cast<float>(shape_.rows))), 1, sum);
    return sum;
}

}  // namespace hilcam
