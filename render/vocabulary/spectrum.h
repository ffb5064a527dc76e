#pragma once
// Spectra: curves over wavelength as the user gives them, and their averages over the program's spectral
// bins.

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace hilcam {

// Eight floats are half a cache line; a loop over all of them is two vector instructions.
inline constexpr int kMaxBins = 8;

// A value per bin; entries past the grid's size are zero.
struct Spectrum {
    alignas(32) std::array<float, kMaxBins> bin{};
    float& operator[](int i) { return bin[static_cast<std::size_t>(i)]; }
    float operator[](int i) const { return bin[static_cast<std::size_t>(i)]; }
};

// Bin by bin, over all kMaxBins: shorter loops would be slower.
inline Spectrum operator*(const Spectrum& a, const Spectrum& b) {
    Spectrum out;
    for (int i = 0; i < kMaxBins; ++i) out[i] = a[i] * b[i];
    return out;
}
inline Spectrum operator*(float a, const Spectrum& b) {
    Spectrum out;
    for (int i = 0; i < kMaxBins; ++i) out[i] = a * b[i];
    return out;
}
inline Spectrum& operator+=(Spectrum& a, const Spectrum& b) {
    for (int i = 0; i < kMaxBins; ++i) a[i] += b[i];
    return a;
}
inline Spectrum operator+(Spectrum a, const Spectrum& b) { return a += b; }
inline float sum_of_products(const Spectrum& a, const Spectrum& b) {
    float sum = 0;
    for (int i = 0; i < kMaxBins; ++i) sum += a[i] * b[i];
    return sum;
}
inline float max_component(const Spectrum& s) {
    float most = s[0];
    for (int i = 1; i < kMaxBins; ++i) most = s[i] > most ? s[i] : most;
    return most;
}

// A function of wavelength, given by samples and linear between them. Wavelengths [um] strictly increase.
// Outside its range a curve keeps its end value, so `reflectance: 0.3` is one sample.
struct Curve {
    std::vector<double> wavelength_um;
    std::vector<double> value;
    std::string where;  // file and line that gave it, for messages

    static Curve constant(double value) { return {{0.55}, {value}, {}}; }
    double at(double wavelength_um) const;
    // Returns the exact mean of this curve over [from, to] [um].
    double mean(double from_um, double to_um) const;
};

// Bins beyond this wavelength are thermal: what a surface emits there is as bright as what it reflects, and
// its reflectance follows from its emissivity. A bin is on one side of it.
inline constexpr double kThermalFrom_um = 2.5;
inline constexpr double kShortest_um = 0.2, kLongest_um = 20;

// The bins of a run: [edge_0, edge_1), [edge_1, edge_2), ... in um.
class SpectralGrid {
  public:
    // edges_um: 2 to kMaxBins + 1 strictly increasing values within kShortest_um to kLongest_um, one of which
    // is kThermalFrom_um if some are below and others above; InputError otherwise.
    explicit SpectralGrid(std::vector<double> edges_um);

    int size() const { return static_cast<int>(edges_um_.size()) - 1; }
    double from_um(int bin) const { return edges_um_[static_cast<std::size_t>(bin)]; }
    double to_um(int bin) const { return edges_um_[static_cast<std::size_t>(bin) + 1]; }
    double center_um(int bin) const { return 0.5 * (from_um(bin) + to_um(bin)); }
    double width_um(int bin) const { return to_um(bin) - from_um(bin); }
    std::span<const double> edges_um() const { return edges_um_; }
    bool is_thermal(int bin) const { return from_um(bin) >= kThermalFrom_um; }
    bool has_thermal() const { return is_thermal(size() - 1); }
    // Returns the number of bins below kThermalFrom_um, which come first.
    int solar_bins() const;
    // Returns the averages of a curve over the bins.
    Spectrum average(const Curve& curve) const;

  private:
    std::vector<double> edges_um_;
};

// Throws InputError if a curve of two samples or more does not reach from the first to the last bin: nothing
// is extrapolated silently. A constant covers all bins. `what` begins the message.
void require_cover(const Curve& curve, const SpectralGrid& grid, const std::string& what);

// The same for the bins below kThermalFrom_um alone: thermal ones have an emissivity.
void require_solar_cover(const Curve& curve, const SpectralGrid& grid, const std::string& what);

// Planck's law: spectral radiance of a black body [W m^-2 sr^-1 um^-1] (Planck 1901; CODATA 2018 constants).
double planck_w_m2_sr_um(double wavelength_um, double temperature_k);
// Returns its mean over each bin, to single precision, by the series of Chang & Rhee (Int. Comm. Heat Mass
// Transfer 11, 1984). Zero at 0 K.
Spectrum planck_w_m2_sr_um(const SpectralGrid& grid, double temperature_k);
}  // namespace hilcam
