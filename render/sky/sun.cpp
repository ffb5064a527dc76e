#include "render/sky/sun.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// Means over [0.280, 0.285), ... [1.095, 1.100) um, then [1.10, 1.12), ... [2.48, 2.50) um.
constexpr double kFineFrom_um = 0.280, kFineStep_um = 0.005, kCoarseFrom_um = 1.10, kCoarseStep_um = 0.02;
constexpr std::size_t kFineCount = 164;
constexpr auto kSun_w_m2_um = std::to_array<double>({
    235.7,  330.7,  560.3,  512.1,  538.6,  594.0,  696.0,  698.1,  741.8,  988.1,  990.6,  926.1,  967.7,
    941.6,  1047.1, 929.8,  1022.2, 1223.6, 1078.6, 1199.5, 975.0,  1055.0, 1062.0, 1254.2, 1754.1, 1686.0,
    1727.5, 1739.8, 1739.8, 1598.9, 1526.6, 1760.3, 1892.3, 1955.5, 2025.7, 2036.6, 2046.3, 1988.7, 2009.7,
    2047.4, 2033.4, 1830.6, 1952.7, 1951.9, 1886.3, 1946.8, 1902.5, 1752.1, 1885.4, 1854.8, 1892.5, 1884.5,
    1845.8, 1863.5, 1870.2, 1822.9, 1843.1, 1829.3, 1843.8, 1825.8, 1847.4, 1770.8, 1785.6, 1782.4, 1751.3,
    1750.7, 1706.2, 1685.5, 1685.8, 1673.5, 1643.7, 1644.2, 1615.6, 1585.3, 1580.3, 1465.8, 1563.3, 1546.7,
    1516.3, 1502.3, 1480.3, 1466.2, 1458.8, 1431.9, 1413.5, 1405.1, 1381.6, 1348.4, 1353.5, 1329.0, 1325.0,
    1298.3, 1281.6, 1283.6, 1272.3, 1261.4, 1251.5, 1217.4, 1209.9, 1204.3, 1189.1, 1183.4, 1146.7, 1142.4,
    1131.1, 1114.6, 1115.0, 1093.0, 1070.3, 1070.4, 1048.3, 1050.9, 1033.0, 1006.4, 951.3,  994.3,  998.8,
    937.3,  962.1,  955.4,  939.6,  936.3,  929.6,  923.7,  907.0,  903.1,  895.5,  890.1,  863.4,  867.4,
    867.0,  854.0,  825.3,  830.1,  815.1,  804.4,  797.7,  789.6,  780.5,  774.3,  773.8,  763.0,  757.8,
    745.9,  735.4,  723.7,  722.7,  707.7,  699.2,  695.6,  685.5,  678.8,  672.4,  662.1,  658.3,  648.9,
    642.0,  627.4,  625.6,  621.3,  610.0,  606.3,  590.2,  587.5,  584.5,  564.0,  546.2,  525.4,  506.0,
    490.8,  473.3,  455.7,  441.9,  419.6,  404.3,  387.3,  374.1,  362.1,  351.4,  338.1,  327.6,  316.2,
    307.0,  298.5,  287.8,  280.1,  271.1,  261.6,  252.6,  243.9,  235.9,  225.9,  218.4,  209.1,  201.7,
    191.5,  185.7,  179.0,  172.7,  164.1,  159.3,  152.5,  143.3,  142.0,  137.3,  132.6,  125.5,  122.8,
    118.5,  114.6,  110.0,  105.8,  101.2,  97.4,   94.7,   91.9,   89.5,   84.8,   83.8,   80.9,   78.4,
    75.3,   72.9,   70.6,   68.8,   66.0,   64.0,   62.3,   60.1,   58.6,   57.0,   54.9,   53.6,   51.2,
});

// ASTM E490-00a: wavelength [um], irradiance at 1 au [W m^-2 um^-1]; powers of the wavelength between them.
struct SunAt {
    double wavelength_um, w_m2_um;
};
constexpr auto kInfraredSun = std::to_array<SunAt>({
    {2.5, 51.55},  {2.6, 44.57},  {2.7, 38.67},  {2.8, 33.85},  {2.9, 29.69},  {3.0, 26.12},  {3.1, 23.06},
    {3.2, 20.48},  {3.3, 18.02},  {3.4, 16.15},  {3.5, 14.56},  {3.6, 13.07},  {3.7, 11.62},  {3.8, 10.57},
    {3.9, 9.599},  {4.0, 8.669},  {4.5, 5.393},  {5.0, 3.504},  {5.5, 2.439},  {6.0, 1.742},  {6.5, 1.278},
    {7.0, 0.9592}, {7.5, 0.7344}, {8.0, 0.5721}, {8.5, 0.4525}, {9.0, 0.3627}, {9.5, 0.2942}, {10, 0.2412},
    {11, 0.1635},  {12, 0.1152},  {13, 0.0834},  {14, 0.0619},  {15, 0.0469},  {16, 0.0361},  {17, 0.0283},
    {18, 0.0225},  {19, 0.0181},  {20, 0.0147},
});

// Returns the integral of the infrared spectrum between two wavelengths within one step of the table [W m^-2].
double infrared_step_w_m2(const SunAt& low, const SunAt& high, double from_um, double to_um) {
    const double power =
        std::log(high.w_m2_um / low.w_m2_um) / std::log(high.wavelength_um / low.wavelength_um);
    const auto below = [&](double um) { return std::pow(um / low.wavelength_um, power + 1); };
    return low.w_m2_um * low.wavelength_um / (power + 1) * (below(to_um) - below(from_um));
}

double infrared_w_m2(double from_um, double to_um) {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < kInfraredSun.size(); ++i) {
        const double from = std::max(from_um, kInfraredSun[i].wavelength_um),
                     to = std::min(to_um, kInfraredSun[i + 1].wavelength_um);
        if (from < to) sum += infrared_step_w_m2(kInfraredSun[i], kInfraredSun[i + 1], from, to);
    }
    return sum;
}

// Neckel & Labs 1994: wavelength [nm], A0 ... A5.
constexpr double kLimbLaw[30][7] = {
    {303.327, 0.08011, 0.70695, 0.49910, -0.31080, -0.02177, 0.04642},
    {310.843, 0.08160, 0.71609, 0.69685, -0.87703, 0.47008, -0.08760},
    {320.468, 0.08833, 0.77285, 0.65382, -1.04647, 0.72921, -0.19775},
    {329.897, 0.09188, 0.92459, 0.19604, -0.39546, 0.23599, -0.05303},
    {349.947, 0.11012, 1.02168, -0.10924, -0.00055, -0.08688, 0.06487},
    {365.875, 0.12828, 1.04969, 0.17482, -1.13371, 1.23882, -0.45990},
    {374.086, 0.12579, 0.85402, 0.54601, -1.15048, 0.88928, -0.26462},
    {390.915, 0.12995, 0.91836, -0.07566, 0.19149, -0.28712, 0.12298},
    {401.970, 0.12323, 1.08648, -0.43974, 0.45912, -0.32759, 0.09850},
    {416.319, 0.12814, 1.19947, -0.84407, 1.07201, -0.79537, 0.23982},
    {427.930, 0.14249, 1.28796, -1.19564, 1.68603, -1.36658, 0.44572},
    {443.885, 0.16220, 1.24893, -0.92165, 0.89978, -0.50148, 0.11220},
    {445.125, 0.15248, 1.38517, -1.49615, 1.99886, -1.48155, 0.44119},
    {457.345, 0.16604, 1.38544, -1.52275, 2.00232, -1.45969, 0.42864},
    {477.427, 0.19571, 1.30551, -1.25845, 1.50626, -1.05472, 0.30570},
    {492.905, 0.20924, 1.30798, -1.20411, 1.21505, -0.67196, 0.14381},
    {519.930, 0.23695, 1.29927, -1.28034, 1.37760, -0.85054, 0.21706},
    {541.760, 0.26073, 1.27428, -1.30352, 1.47085, -0.96618, 0.26384},
    {559.950, 0.26892, 1.34319, -1.58427, 1.91271, -1.31350, 0.37295},
    {579.880, 0.28392, 1.36896, -1.75998, 2.22154, -1.56074, 0.44630},
    {610.975, 0.30854, 1.36620, -1.83572, 2.33221, -1.63082, 0.45959},
    {640.970, 0.33644, 1.30590, -1.79238, 2.45040, -1.89979, 0.59943},
    {669.400, 0.34685, 1.37539, -2.04425, 2.70493, -1.94290, 0.55999},
    {700.875, 0.37885, 1.25553, -1.70908, 2.19647, -1.59554, 0.47378},
    {748.710, 0.40627, 1.22842, -1.67877, 2.05535, -1.39972, 0.38845},
    {811.760, 0.42977, 1.25182, -1.85164, 2.31949, -1.59101, 0.44155},
    {869.600, 0.45396, 1.25101, -2.02958, 2.75410, -2.02287, 0.59338},
    {948.850, 0.47855, 1.19813, -1.86296, 2.36939, -1.64367, 0.46056},
    {1046.60, 0.49870, 1.21429, -2.06976, 2.80703, -2.05247, 0.60221},
    {1098.95, 0.51149, 1.19354, -2.00174, 2.66936, -1.94981, 0.57715},
};

std::array<double, 6> limb_polynomial(double wavelength_nm) {
    std::size_t above = 0;
    while (above < 30 && kLimbLaw[above][0] < wavelength_nm) ++above;
    const std::size_t hi = std::min<std::size_t>(above, 29),
                      lo = above == 0 ? 0 : std::min<std::size_t>(above - 1, 29);
    const double step = kLimbLaw[hi][0] - kLimbLaw[lo][0];
    const double share = step > 0 ? (wavelength_nm - kLimbLaw[lo][0]) / step : 0;
    std::array<double, 6> out{};
    double mean = 0;  // over the disk: 2 int P(mu) mu dmu
    for (std::size_t k = 0; k < 6; ++k) {
        out[k] = kLimbLaw[lo][k + 1] + share * (kLimbLaw[hi][k + 1] - kLimbLaw[lo][k + 1]);
        mean += 2 * out[k] / static_cast<double>(k + 2);
    }
    for (double& a : out) a /= mean;
    return out;
}

}  // namespace

Spectrum solar_irradiance_1au_w_m2_um(const SpectralGrid& grid) {
    if (grid.from_um(0) < kFineFrom_um)
        throw InputError("spectrum_edges_um: the solar spectrum begins at 0.28 um; found " +
                         std::to_string(grid.from_um(0)) + "; give sun.spectrum for shorter ones");
    Spectrum out;
    for (int b = 0; b < grid.size(); ++b) {
        // The overlap of the bin with each bin of the table.
        double sum = infrared_w_m2(grid.from_um(b), grid.to_um(b));
        for (std::size_t i = 0; i < kSun_w_m2_um.size(); ++i) {
            const bool fine = i < kFineCount;
            const double step = fine ? kFineStep_um : kCoarseStep_um;
            const double from = fine ? kFineFrom_um + static_cast<double>(i) * step
                                     : kCoarseFrom_um + static_cast<double>(i - kFineCount) * step;
            sum += kSun_w_m2_um[i] *
                   std::max(0.0, std::min(from + step, grid.to_um(b)) - std::max(from, grid.from_um(b)));
        }
        out[b] = static_cast<float>(sum / grid.width_um(b));
    }
    return out;
}

Fields fields(SunConfig& c) {
    return {
        optional(curve("spectrum", c.spectrum, {0, 1e5},
                       "irradiance at 1 au in W m^-2 um^-1; left out: ASTM G173-03"),
                 c.has_spectrum),
        flag("limb_darkening", c.limb_darkening, "true: the Sun's disk is darker at its edge"),
        optional(vector3("direction", c.direction, 1, {-1e13, 1e13},
                         "direction of the Sun in world axes, of any length; used with origin.kind: free"),
                 c.has_direction),
        optional(number("distance_au", c.distance_m, kAstronomicalUnit_m, {0.01, 1e3},
                        "distance of the Sun from the world's origin; sunlight falls with its square. Used "
                        "with origin.kind: free"),
                 c.has_distance),
        optional(number("phase_deg", c.phase_rad, kDegree_rad, {0, 180},
                        "phase angle of a target at the centre of the picture that camera_pose gives; 0: the "
                        "Sun is behind the camera. Used with origin.kind: free; replaces direction"),
                 c.has_phase),
        optional(number("azimuth_deg", c.azimuth_rad, kDegree_rad, {-360, 360},
                        "direction in that picture from which sunlight comes, clockwise; 0: from the top, "
                        "90: from the right. Used with phase_deg"),
                 c.has_azimuth),
    };
}

SunDisk::SunDisk(const SpectralGrid& grid, bool limb_darkening) {
    for (int b = 0; b < grid.size(); ++b) {
        const std::array<double, 6> p = limb_polynomial(1000 * grid.center_um(b));
        for (std::size_t k = 0; k < 6; ++k)
            power_[k][b] = limb_darkening ? static_cast<float>(p[k]) : (k == 0 ? 1.0f : 0.0f);
    }
}

}  // namespace hilcam
