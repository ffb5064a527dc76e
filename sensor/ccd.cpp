#include "sensor/ccd.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace hilcam {

Fields fields(CcdConfig& c) {
    return {
        flag("blooming", c.blooming,
             "treatment of charge above the full well. true: it spills along the column; false: it drains"),
        number("parallel_inefficiency", c.parallel_inefficiency, 1, {0, 1e-2},
               "share of the charge left behind in each row transfer"),
        number("serial_inefficiency", c.serial_inefficiency, 1, {0, 1e-2},
               "share of the charge left behind in each column transfer"),
    };
}

namespace {

// Number of columns processed together, so that their carries stay in the first-level cache.
constexpr int kColumns = 256;

void bloom_columns(ElectronImage& charge_e, float full_well_e, std::size_t first, std::size_t count) {
    std::array<float, kColumns> carry{};
    const int height = charge_e.height();
    // Down: a full pixel passes on half of its excess and keeps the other half for the way up.
    for (int y = 0; y < height; ++y) {
        float* q = charge_e.row(y).data() + first;
        for (std::size_t x = 0; x < count; ++x) {
            const float excess = std::max(0.0f, q[x] - full_well_e);
            const float taken = std::min(carry[x], std::max(0.0f, full_well_e - q[x]));
            q[x] += taken - 0.5f * excess;
            carry[x] += 0.5f * excess - taken;
        }
    }
    carry.fill(0);
    for (int y = height - 1; y >= 0; --y) {
        float* q = charge_e.row(y).data() + first;
        for (std::size_t x = 0; x < count; ++x) {
            const float excess = std::max(0.0f, q[x] - full_well_e);
            const float taken = std::min(carry[x], std::max(0.0f, full_well_e - q[x]));
            q[x] += taken - excess;
            carry[x] += excess - taken;
        }
    }
}

}  // namespace

void bloom(ElectronImage& charge_e, float full_well_e) {
    tbb::parallel_for(tbb::blocked_range<int>(0, (charge_e.width() + kColumns - 1) / kColumns),
                      [&](const tbb::blocked_range<int>& range) {
                          for (int block = range.begin(); block < range.end(); ++block) {
                              const int first = block * kColumns;
                              const int count = std::min(kColumns, charge_e.width() - first);
                              bloom_columns(charge_e, full_well_e, static_cast<std::size_t>(first),
                                            static_cast<std::size_t>(count));
                          }
                      });
}

ChargeTransfer::ChargeTransfer(const CcdConfig& config, int width, int height, int first_column,
                               int first_row)
    : parallel_(shares(config.parallel_inefficiency, first_row, height)),
      serial_(shares(config.serial_inefficiency, first_column, width)) {}

std::vector<ChargeTransfer::Shares> ChargeTransfer::shares(double c, int first, int count) {
    std::vector<Shares> out;
    if (c <= 0) return out;
    for (int n = first + 1; n <= first + count; ++n) {
        Shares share{};
        // Negative binomial: P(k) = P(k-1) c (n + k - 1) / k.
        double p = std::pow(1 - c, n), left = 1;
        for (int k = 0; k < kLate - 1; ++k) {
            share[static_cast<std::size_t>(k)] = static_cast<float>(p);
            left -= p;
            p *= c * (n + k) / (k + 1);
        }
        share[kLate - 1] = static_cast<float>(std::max(0.0, left));
        out.push_back(share);
    }
    return out;
}

void ChargeTransfer::apply(ElectronImage& q) const {
    if (!parallel_.empty())
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, static_cast<std::size_t>(q.width()), kColumns),
            [&](const tbb::blocked_range<std::size_t>& range) {
                for (int y = q.height() - 1; y >= 0; --y)
                    for (std::size_t x = range.begin(); x < range.end(); ++x) {
                        float sum = 0;
                        for (int k = 0; k < kLate && k <= y; ++k)
                            sum += q.row(y - k)[x] *
                                   parallel_[static_cast<std::size_t>(y - k)][static_cast<std::size_t>(k)];
                        q.row(y)[x] = sum;
                    }
            });
    if (!serial_.empty())
        tbb::parallel_for(
            tbb::blocked_range<int>(0, q.height(), 16), [&](const tbb::blocked_range<int>& range) {
                for (int y = range.begin(); y < range.end(); ++y) {
                    float* row = q.row(y).data();
                    for (int x = q.width() - 1; x >= 0; --x) {
                        float sum = 0;
                        for (int k = 0; k < kLate && k <= x; ++k)
                            sum += row[x - k] *
                                   serial_[static_cast<std::size_t>(x - k)][static_cast<std::size_t>(k)];
                        row[x] = sum;
                    }
                }
            });
}

}  // namespace hilcam
