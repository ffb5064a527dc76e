#include "emulator/loop/latency.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hilcam {

void DurationHistogram::record(std::int64_t ns) {
    const double microseconds = std::max(1.0, static_cast<double>(ns) * 1e-3);
    const int bucket = static_cast<int>(std::log2(microseconds) * kPerOctave);
    buckets_[static_cast<std::size_t>(std::min(bucket, kPerOctave * kOctaves - 1))].fetch_add(
        1, std::memory_order_relaxed);
    count_.fetch_add(1, std::memory_order_relaxed);
    std::int64_t max_ns = max_ns_.load(std::memory_order_relaxed);
    while (ns > max_ns && !max_ns_.compare_exchange_weak(max_ns, ns, std::memory_order_relaxed)) {
    }
}

void DurationHistogram::clear() {
    for (auto& bucket : buckets_) bucket.store(0, std::memory_order_relaxed);
    count_.store(0, std::memory_order_relaxed);
    max_ns_.store(0, std::memory_order_relaxed);
}

void DurationHistogram::read(Counts& counts) const {
    for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = buckets_[i].load(std::memory_order_relaxed);
}

double DurationHistogram::quantile_ms(double q) const {
    Counts counts;
    read(counts);
    return quantile_ms(counts, q);
}

double DurationHistogram::quantile_ms(const Counts& counts, double q) {
    const std::uint64_t total = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
    if (total == 0) return 0;
    const auto wanted = static_cast<std::uint64_t>(std::ceil(q * static_cast<double>(total)));
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        seen += counts[i];
        // The bucket's middle.
        if (seen >= wanted) return std::exp2((static_cast<double>(i) + 0.5) / kPerOctave) * 1e-3;
    }
    return 0;
}

std::vector<DurationHistogram::Bucket> DurationHistogram::quarter_octaves() const {
    constexpr std::size_t kMerged = kPerOctave / 4;
    std::vector<Bucket> buckets;
    for (std::size_t i = 0; i < buckets_.size(); i += kMerged) {
        Bucket bucket{std::exp2(static_cast<double>(i) / kPerOctave) * 1e-3, 0};
        for (std::size_t k = i; k < i + kMerged; ++k)
            bucket.count += buckets_[k].load(std::memory_order_relaxed);
        if (bucket.count > 0 || !buckets.empty()) buckets.push_back(bucket);
    }
    while (!buckets.empty() && buckets.back().count == 0) buckets.pop_back();
    return buckets;
}

}  // namespace hilcam
