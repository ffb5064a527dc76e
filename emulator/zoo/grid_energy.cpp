#include "emulator/zoo/grid_energy.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "render/vocabulary/check.h"
#include "render/vocabulary/median.h"
#include "sensor/convolution/convolve.h"
#include "sensor/convolution/fourier.h"

namespace hilcam {
namespace {

constexpr int kLongest_px = kGridPeriods_px.back();
// Limits steps: a few pixels of a reference are off by far more than the others, and would have all the
// energy.
constexpr double kMostOfMedian = 4;

// Returns the side of a square that contains the picture: a multiple of the longest period, so that each
// period has its own frequency.
int side_for(int width, int height) {
    int side = std::max(2, (std::max(width, height) + kLongest_px - 1) / kLongest_px) * kLongest_px;
    while (fft_size(side) != side) side += kLongest_px;
    return side;
}

// Returns absolute steps from each pixel to the next one along x (or y), minus their mean; 0 where there is
// no step.
std::vector<std::complex<float>> steps_of(const MaskedValues& error, bool along_x, std::size_t side) {
    std::vector<std::complex<float>> steps(side * side);
    std::vector<std::size_t> places;
    std::vector<double> sizes;
    const auto width = static_cast<std::size_t>(error.width), height = static_cast<std::size_t>(error.height);
    const std::size_t next = along_x ? 1 : width;
    for (std::size_t y = 0; y + (along_x ? 0 : 1) < height; ++y)
        for (std::size_t x = 0; x + (along_x ? 1 : 0) < width; ++x) {
            const std::size_t i = y * width + x;
            if (error.counts[i] == 0 || error.counts[i + next] == 0) continue;
            sizes.push_back(
                std::abs(static_cast<double>(error.values[i + next]) - static_cast<double>(error.values[i])));
            places.push_back(y * side + x);
        }
    if (places.empty()) return steps;
    const double most = kMostOfMedian * median(sizes);
    double sum = 0;
    for (double& step : sizes) step = std::min(step, most), sum += step;
    const double mean = sum / static_cast<double>(places.size());
    for (std::size_t k = 0; k < places.size(); ++k) steps[places[k]] = static_cast<float>(sizes[k] - mean);
    return steps;
}

// Adds the powers of the frequencies along x that are constant down y, or the reverse.
void add_powers(std::span<const std::complex<float>> spectrum, bool along_x, int side, GridEnergy& energy) {
    const int grid = side / kLongest_px;  // frequency of the longest period in the spectrum
    const auto power = [&](int k) {
        const auto i = static_cast<std::size_t>(k) * (along_x ? 1 : static_cast<std::size_t>(side));
        return static_cast<double>(std::norm(spectrum[i]));
    };
    for (std::size_t p = 0; p < kGridPeriods_px.size(); ++p) {
        const int at = side / kGridPeriods_px[p];
        double beside = 0;
        int count = 0;
        for (const int away : {-5, -4, -3, -2, 2, 3, 4, 5}) {
            const int k = at + away;
            if (k < 1 || k > side / 2 || k % grid == 0) continue;
            beside += power(k), ++count;
        }
        energy.at[p] += power(at);
        if (count > 0) energy.beside[p] += beside / count;
    }
}

}  // namespace

GridEnergy& GridEnergy::operator+=(const GridEnergy& other) {
    for (std::size_t p = 0; p < at.size(); ++p) at[p] += other.at[p], beside[p] += other.beside[p];
    return *this;
}

double GridEnergy::ratio() const {
    double all_at = 0, all_beside = 0;
    for (std::size_t p = 0; p < at.size(); ++p) all_at += at[p], all_beside += beside[p];
    return all_beside > 0 ? all_at / all_beside : 0;
}

double GridEnergy::ratio(std::size_t period) const {
    return beside[period] > 0 ? at[period] / beside[period] : 0;
}

GridEnergy grid_energy(const MaskedValues& error) {
    HILCAM_CHECK(error.values.size() == error.counts.size() &&
                 error.values.size() ==
                     static_cast<std::size_t>(error.width) * static_cast<std::size_t>(error.height));
    const int side = side_for(error.width, error.height);
    GridEnergy energy;
    for (const bool along_x : {true, false}) {
        std::vector<std::complex<float>> steps = steps_of(error, along_x, static_cast<std::size_t>(side));
        fourier_forward(steps, static_cast<std::size_t>(side));
        add_powers(steps, along_x, side, energy);
    }
    return energy;
}

}  // namespace hilcam
