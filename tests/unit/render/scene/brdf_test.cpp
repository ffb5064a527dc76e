#include "render/scene/brdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "render/brdf/brdf_table.h"
#include "render/brdf/microfacet.h"
#include "render/scene/color_bands.h"
#include "render/scene/material_albedo.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

const SpectralGrid kGrid({0.5, 0.6, 0.7});

struct NamedMaterial {
    const char* name;
    MaterialConfig config;
    bool keeps_all;       // a white one gives back all that it gets
    double most = 1.002;  // of what it gives back
};

MaterialConfig model(std::size_t m, double reflectance, double roughness = 0.3) {
    MaterialConfig config;
    config.model = m;
    config.reflectance = Curve::constant(reflectance);
    config.roughness = roughness;
    return config;
}

// Every model that has lobes, as white as it can be.
std::vector<NamedMaterial> white_materials() {
    using namespace brdf;
    MaterialConfig phong = model(kModel<Phong>, 0.5);
    phong.specular = Curve::constant(0.5);
    phong.exponent = 20;
    MaterialConfig hapke = model(kModel<Hapke>, 1);
    hapke.slope_rad = 20 * kDegree_rad;
    hapke.surge_amplitude = 1;
    return {{"lambert", model(kModel<Lambert>, 1), true},
            {"oren_nayar 0.3", model(kModel<OrenNayar>, 1, 0.3), true},
            {"oren_nayar 1", model(kModel<OrenNayar>, 1, 1), true},
            {"metal 0.3", model(kModel<Metal>, 1, 0.3), true},
            {"metal 0.7", model(kModel<Metal>, 1, 0.7), true},
            {"metal 1", model(kModel<Metal>, 1, 1), true},
            {"dielectric 0.2", model(kModel<Dielectric>, 1, 0.2), true},
            {"dielectric 0.6", model(kModel<Dielectric>, 1, 0.6), true},
            {"phong", phong, false},
            {"lommel_seeliger", model(kModel<LommelSeeliger>, 0.25), false},
            // Hapke's multiple scattering is that of isotropic grains: 3 % too much where they are not and
            // lose nothing.
            {"hapke", model(kModel<Hapke>, 1), false, 1.03},
            {"hapke 0.9", model(kModel<Hapke>, 0.9), false},
            {"hapke rough", hapke, false, 1.03}};
}

TEST(Brdf, EveryModelIsHeldToTheseTests) {
    // Those without lobes, and the one that is as good as its data.
    std::set<std::size_t> tested = {kModel<brdf::Mirror>, kModel<brdf::Glass>, kModel<brdf::Veil>,
                                    kModel<brdf::Measured>};
    for (const NamedMaterial& named : white_materials()) tested.insert(named.config.model);
    for (std::size_t i = 0; i < BrdfModels::kCount; ++i)
        EXPECT_EQ(tested.count(i), 1u) << BrdfModels::kNames[i];
}

Bsdf bsdf(const Material& m) { return {&m, m.ggx_alpha, m.base, m.highlight}; }
// The same with one bin's spectra in all of them.
Bsdf bsdf_in(const Material& m, int bin) {
    Bsdf out = bsdf(m);
    out.base.bin.fill(m.base[bin]), out.highlight.bin.fill(m.highlight[bin]);
    return out;
}

Vec3f direction(double cosine, double azimuth) {
    const double s = std::sqrt(1 - cosine * cosine);
    return to_float(Vec3d{s * std::cos(azimuth), s * std::sin(azimuth), cosine});
}
const Vec3f kUp{0, 0, 1};

// Integral of f cos over the half sphere.
double albedo_by_directions(const Bsdf& at, Vec3f view) {
    double sum = 0;
    constexpr int kRings = 1000, kSpokes = 720;
    for (int i = 0; i < kRings; ++i)
        for (int j = 0; j < kSpokes; ++j) {
            const Vec3f light = direction((i + 0.5) / kRings, 2 * kPi * (j + 0.5) / kSpokes);
            sum += static_cast<double>(brdf_value(at, {view.z, light.z, dot(view, light)})[0] * light.z);
        }
    return sum * 2 * kPi / (kRings * kSpokes);
}

TEST(Brdf, WhiteFurnaceStaysWhiteAndNothingGains) {
    for (const NamedMaterial& named : white_materials()) {
        const Material m = make_material(named.config, kGrid);
        for (const double cosine : {0.95, 0.5, 0.2}) {
            const double albedo = albedo_by_directions(bsdf(m), direction(cosine, 0.3));
            EXPECT_LT(albedo, named.most) << named.name << " at " << cosine;
            if (named.keeps_all) {
                EXPECT_GT(albedo, 0.998) << named.name << " at " << cosine;
            }
        }
    }
}

// With alpha = 1 the distribution of normals is 1/pi and Smith's G2 / (4 no ni) is 1 / (2 (no + ni)): the
// integral of the single reflection has a closed form, 1 - no ln((1 + no) / no).
TEST(Brdf, FacetAlbedoIsTheClosedForm) {
    const LobeAlbedo albedo = ggx_albedo(1, 0);
    for (const float no : {0.25f, 0.5f, 0.75f, 1.0f})
        EXPECT_NEAR(albedo(no), 1 - no * std::log((1 + no) / no), 2e-3);
    double mean = 0;
    constexpr int kSteps = 100000;
    for (int i = 0; i < kSteps; ++i) {
        const double mu = (i + 0.5) / kSteps;
        mean += 2 * mu * (1 - mu * std::log((1 + mu) / mu)) / kSteps;
    }
    EXPECT_NEAR(albedo.average, mean, 2e-3);
}

TEST(Brdf, LightMayGoBothWays) {
    std::mt19937 engine(5);
    std::uniform_real_distribution<double> uniform(0.02, 0.98);
    for (const NamedMaterial& named : white_materials()) {
        const Material m = make_material(named.config, kGrid);
        for (int i = 0; i < 500; ++i) {
            const Vec3f a = direction(uniform(engine), 7 * uniform(engine));
            const Vec3f b = direction(uniform(engine), 7 * uniform(engine));
            const float there = brdf_value(bsdf(m), {a.z, b.z, dot(a, b)})[0];
            const float back = brdf_value(bsdf(m), {b.z, a.z, dot(a, b)})[0];
            ASSERT_TRUE(std::isfinite(there)) << named.name;
            ASSERT_NEAR(there, back, 1e-4 * (there + back) + 1e-6) << named.name;
        }
    }
}

// Samples against densities, chi-square over cells of equal solid angle in cosine and azimuth.
double chi_square_per_degree(const Material& m, double cosine, float wrong) {
    constexpr int kRings = 12, kSpokes = 16;
    constexpr int kSamples = 200000;
    const Vec3f view = direction(cosine, 0.7);
    std::vector<double> expected(kRings * kSpokes), counted(kRings * kSpokes);
    double valid_share = 0;
    constexpr int kFine = 40;
    for (int i = 0; i < kRings * kFine; ++i)
        for (int j = 0; j < kSpokes * kFine; ++j) {
            const Vec3f light =
                direction((i + 0.5) / (kRings * kFine), 2 * kPi * (j + 0.5) / (kSpokes * kFine));
            const double density =
                static_cast<double>(brdf_density(bsdf(m), {view.z, light.z, dot(view, light)}));
            const double share = density * 2 * kPi / (kRings * kFine * kSpokes * kFine);
            expected[static_cast<std::size_t>(i / kFine * kSpokes + j / kFine)] += share * kSamples;
            valid_share += share;
        }
    EXPECT_LT(valid_share, 1.02);
    std::mt19937 engine(11);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (int i = 0; i < kSamples; ++i) {
        const BrdfSample s =
            brdf_sample(bsdf(m), kUp, view, {uniform(engine), uniform(engine), uniform(engine)});
        if (!s.valid) continue;
        double azimuth = std::atan2(s.dir.y, s.dir.x);
        if (azimuth < 0) azimuth += 2 * kPi;
        const double z = std::pow(static_cast<double>(s.dir.z), static_cast<double>(wrong));
        const int ring = std::min(kRings - 1, static_cast<int>(z * kRings));
        const int spoke = std::min(kSpokes - 1, static_cast<int>(azimuth / (2 * kPi) * kSpokes));
        counted[static_cast<std::size_t>(ring * kSpokes + spoke)] += 1;
    }
    double chi = 0, pooled_expected = 0, pooled_counted = 0;
    int degrees = 0;
    for (std::size_t k = 0; k < expected.size(); ++k) {
        pooled_expected += expected[k], pooled_counted += counted[k];
        if (pooled_expected < 20) continue;
        // 1 % for the sum that makes the expectation.
        const double difference =
            std::max(0.0, std::abs(pooled_counted - pooled_expected) - 0.01 * pooled_expected);
        chi += difference * difference / pooled_expected;
        pooled_expected = pooled_counted = 0;
        ++degrees;
    }
    return chi / degrees;
}

TEST(Brdf, SamplesFollowTheirDensity) {
    for (const NamedMaterial& named : white_materials()) {
        const Material m = make_material(named.config, kGrid);
        for (const double cosine : {0.9, 0.4})
            EXPECT_LT(chi_square_per_degree(m, cosine, 1), 1.5) << named.name << " at " << cosine;
    }
    // The test sees a wrong sampler: directions pushed towards the normal.
    EXPECT_GT(chi_square_per_degree(make_material(model(kModel<brdf::Lambert>, 1), kGrid), 0.9, 0.8f), 5);
}

// The mean of a sample's weight is the albedo, for each model.
TEST(Brdf, SampleWeightsAverageToTheAlbedo) {
    std::mt19937 engine(2);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (const NamedMaterial& named : white_materials()) {
        const Material m = make_material(named.config, kGrid);
        const Vec3f view = direction(0.5, 1);
        double sum = 0;
        constexpr int kSamples = 200000;
        for (int i = 0; i < kSamples; ++i) {
            const BrdfSample s =
                brdf_sample(bsdf(m), kUp, view, {uniform(engine), uniform(engine), uniform(engine)});
            if (s.valid) sum += static_cast<double>(s.weight[0]);
        }
        EXPECT_NEAR(sum / kSamples / albedo_by_directions(bsdf(m), view), 1, 0.01) << named.name;
    }
}

// Fresnel's formulas at normal incidence and at Brewster's angle, by hand.
TEST(Brdf, DielectricFresnelIsExact) {
    EXPECT_NEAR(fresnel_dielectric(1.5f, 1), 0.04, 1e-6);
    // At Brewster's angle only the perpendicular part is left: ((n^2-1)/(n^2+1))^2 / 2.
    const float brewster = 1 / std::sqrt(1 + 2.25f);
    EXPECT_NEAR(fresnel_dielectric(1.5f, brewster), 0.5 * std::pow(1.25 / 3.25, 2), 1e-6);
    EXPECT_NEAR(fresnel_dielectric(1.5f, 0), 1, 1e-6);
}

TEST(Brdf, GlassKeepsWhatItDoesNotAbsorb) {
    MaterialConfig glass = model(kModel<brdf::Glass>, 0);
    const Material clear = make_material(glass, kGrid);
    glass.transmittance = Curve::constant(0.5);
    const Material grey = make_material(glass, kGrid);
    for (const double cosine : {1.0, 0.5, 0.1}) {
        const Vec3f view = direction(cosine, 0);
        const BrdfSample back = brdf_exact(bsdf(clear), kUp, view, 0),
                         through = brdf_exact(bsdf(clear), kUp, view, 1);
        EXPECT_NEAR(back.weight[0] + through.weight[0], 1, 1e-5);
        EXPECT_NEAR(dot(through.dir, view), -1, 1e-6);
        EXPECT_LT(brdf_exact(bsdf(grey), kUp, view, 1).weight[0], 0.5);
    }
    // Two surfaces of 4 %, inner reflections added: T = (1-R)/(1+R).
    EXPECT_NEAR(brdf_exact(bsdf(clear), kUp, kUp, 1).weight[0], 0.96 / 1.04, 1e-5);
}

// What a veil covers scatters as Lambert's law has it; what it leaves open goes on, and that alone is drawn.
TEST(Brdf, AVeilScattersWhatItCovers) {
    MaterialConfig veil = model(kModel<brdf::Veil>, 0.8);
    veil.cover = 0.2;
    const Material net = make_material(veil, kGrid);
    const Bsdf at = bsdf(net);
    EXPECT_TRUE(at.is_glass() && at.has_lobes());
    EXPECT_NEAR(brdf_exact(at, kUp, direction(0.3, 0), 1).weight[0], 0.8, 1e-6);
    EXPECT_EQ(max_component(brdf_exact(at, kUp, direction(0.3, 0), 0).weight), 0);
    EXPECT_NEAR(brdf_value(at, {0.3f, 0.6f, 0.1f})[0], 0.8 * 0.2 / kPi, 1e-6);
    EXPECT_EQ(brdf_density(at, {0.3f, 0.6f, 0.1f}), 0);
    for (const float u : {0.0f, 0.3f, 0.9f}) {
        const BrdfSample sample = brdf_sample(at, kUp, direction(0.5, 0), {u, u, u});
        EXPECT_TRUE(sample.valid && sample.exact && sample.transmits);
        EXPECT_NEAR(sample.weight[0], 0.8, 1e-6);
    }
}

// Chandrasekhar's H (Radiative Transfer, 1960, chapter V), worked out anew from its integral equation by 200 Gaussian points:
// without loss 2.0128 at 0.5 and 2.9078 at 1, for w = 0.9 1.5560 and 1.8501.
TEST(Brdf, HapkesHIsWithinTwoPercentOfChandrasekhars) {
    EXPECT_NEAR(hapke_h(0.9f, 0.5f) / 1.5560, 1, 0.02);
    EXPECT_NEAR(hapke_h(0.9f, 1) / 1.8501, 1, 0.02);
    EXPECT_NEAR(hapke_h(1, 0.5f) / 2.0128, 1, 0.02);
    EXPECT_NEAR(hapke_h(1, 1) / 2.9078, 1, 0.02);
}

// A table filled from a model gives the model back, between its points too.
TEST(BrdfTable, GivesBackTheModelItWasFilledFrom) {
    const Material m = make_material(model(kModel<brdf::Dielectric>, 0.6, 0.6), kGrid);
    std::array<std::vector<float>, 3> axes;
    for (int i = 0; i <= 90; i += 2)
        axes[0].push_back(static_cast<float>(i * kDegree_rad)), axes[2] = axes[0];
    for (int i = 0; i <= 180; i += 4) axes[1].push_back(static_cast<float>(i * kDegree_rad));
    std::vector<Spectrum> values;
    for (const float ti : axes[0])
        for (const float phi : axes[1])
            for (const float to : axes[2]) {
                const float io = std::sin(ti) * std::sin(to) * std::cos(phi) + std::cos(ti) * std::cos(to);
                values.push_back(
                    brdf_value(bsdf(m), {std::max(std::cos(to), 1e-3f), std::max(std::cos(ti), 1e-3f), io}));
            }
    MaterialConfig config = model(kModel<brdf::Measured>, 1);
    config.table = "a.csv";
    const Material table =
        make_material(config, kGrid,
                      std::make_shared<const BrdfTable>(BrdfTable(BrdfTable::Layout::kAngles, axes, values)));
    std::mt19937 engine(9);
    std::uniform_real_distribution<double> uniform(0.3, 0.98);
    for (int i = 0; i < 300; ++i) {
        const Vec3f a = direction(uniform(engine), 7 * uniform(engine)),
                    b = direction(uniform(engine), 7 * uniform(engine));
        const Cosines c{a.z, b.z, dot(a, b)};
        ASSERT_NEAR(brdf_value(bsdf(table), c)[0] / brdf_value(bsdf(m), c)[0], 1, 0.02);
    }
    EXPECT_LT(chi_square_per_degree(table, 0.8, 1), 1.5);
}

TEST(Material, RefusesWhatWouldCreateLight) {
    MaterialConfig phong = model(kModel<brdf::Phong>, 0.7);
    phong.specular = Curve::constant(0.5);
    EXPECT_THROW(validate(phong), InputError);
    EXPECT_THROW(validate(model(kModel<brdf::LommelSeeliger>, 0.3)), InputError);
    EXPECT_THROW(validate(model(kModel<brdf::Measured>, 1)), InputError);
    EXPECT_NO_THROW(validate(model(kModel<brdf::Lambert>, 1)));
}

TEST(Material, EmissionIsPlancksTimesOneMinusReflectance) {
    MaterialConfig hot = model(kModel<brdf::Lambert>, 0.25);
    hot.temperature_k = 1500;
    const Material m = make_material(hot, SpectralGrid({0.899, 0.901}));
    // 2 h c^2 / lambda^5 / (exp(h c / lambda k T) - 1) at 0.9 um, 1500 K: 4744.4 W m^-2 sr^-1 um^-1.
    EXPECT_NEAR(m.emission.mean()[0] / (0.75 * 4744.4), 1, 2e-3);
}

const SpectralGrid kThermalGrid({1, 2.5, 8, 10, 12, 14});

std::vector<NamedMaterial> materials_with_emissivity(double emissivity) {
    std::vector<NamedMaterial> all = white_materials();
    for (NamedMaterial& named : all) {
        named.config.infrared_emissivity = Curve::constant(emissivity);
        named.config.has_infrared_emissivity = true;
    }
    return all;
}

// Whatever a model's reflectance means, its emissivity is the one that is given, down to what it can reflect at
// most: 0.8 of all light with rough regolith. Phong's two parts change their shares of the samples with their
// reflectance, by whole samples.
TEST(Material, EveryModelHasTheEmissivityThatIsGiven) {
    for (const double emissivity : {0.2, 0.5, 0.85})
        for (const NamedMaterial& named : materials_with_emissivity(emissivity)) {
            const Material m = make_material(named.config, kThermalGrid);
            const MaterialAlbedo albedo(m, MaterialAlbedo::kExact);
            const double limit = named.config.model == kModel<brdf::Phong> ? 0.015 : 2e-3;
            for (int b = 1; b < kThermalGrid.size(); ++b)
                EXPECT_NEAR(albedo.white_base()[b] + albedo.white_lobe()[b], 1 - emissivity, limit)
                    << named.name << " " << emissivity;
        }
}

// Kirchhoff: what a surface emits and what it reflects of surroundings at its own temperature add up to a black
// body, in each direction.
TEST(Material, EmissionAndReflectionMakeABlackBody) {
    const Spectrum black = planck_w_m2_sr_um(kThermalGrid, 300);
    for (NamedMaterial& named : materials_with_emissivity(0.6)) {
        named.config.temperature_k = 300;
        const Material m = make_material(named.config, kThermalGrid);
        for (const float cosine : {0.15f, 0.5f, 0.9f}) {
            const double reflected = albedo_by_directions(bsdf_in(m, 2), direction(cosine, 0.3));
            EXPECT_NEAR((m.emission.towards(cosine)[2] / black[2]) + reflected, 1, 0.012)
                << named.name << " at " << cosine;
        }
    }
}

TEST(Material, ThermalBinsNeedAnEmissivity) {
    MaterialConfig grey = model(kModel<brdf::Lambert>, 0.3);
    EXPECT_THROW(make_material(grey, kThermalGrid), InputError);
    // A curve that reaches as far says it.
    grey.reflectance = {{0.9, 2.5, 14}, {0.3, 0.3, 0.1}, {}};
    EXPECT_NEAR(make_material(grey, kThermalGrid).base[4], 0.1174, 1e-3);
    // Else the solar bins alone need it.
    grey.reflectance = {{0.9, 2.6}, {0.3, 0.3}, {}};
    EXPECT_THROW(make_material(grey, kThermalGrid), InputError);
    grey.infrared_emissivity = {{8, 14}, {0.9, 0.8}, {}}, grey.has_infrared_emissivity = true;
    const Material m = make_material(grey, kThermalGrid);
    EXPECT_NEAR(m.base[0], 0.3, 1e-6);
    EXPECT_NEAR(m.base[2], 1 - 0.8833, 1e-3);
}

// Colours of a picture say nothing of the thermal infrared.
TEST(Material, TexturesEndWhereThermalBinsBegin) {
    const ColorBands bands(kThermalGrid);
    const Spectrum color = bands.spectrum({0.2f, 0.3f, 0.4f});
    EXPECT_NEAR(color[0], 0.2, 1e-6);
    for (int b = 1; b < kThermalGrid.size(); ++b) EXPECT_EQ(color[b], 1);
    MeshSurface painted;
    painted.base_color = {0.1f, 0.2f, 0.3f};
    painted.roughness = 0.5f;
    const MaterialAlbedo albedo(make_material(painted, kThermalGrid), MaterialAlbedo::kExact);
    EXPECT_NEAR(albedo.white_base()[2] + albedo.white_lobe()[2], 1 - kUnknownEmissivity, 2e-3);
}

// A place's parameters of Hapke's law stand for the material's: the same values as of a material that has them.
TEST(Brdf, APlacesHapkeParametersCount) {
    MaterialConfig there = model(kModel<brdf::Hapke>, 0.4);
    there.lobe_width = 0.4, there.lobe_backward = -0.2, there.surge_amplitude = 0.7, there.surge_width = 0.1;
    there.slope_rad = 12 * kDegree_rad;
    const Material own = make_material(model(kModel<brdf::Hapke>, 0.4), kGrid),
                   other = make_material(there, kGrid);
    Bsdf placed = bsdf(own);
    placed.hapke = std::get<brdf::Hapke>(other.brdf).parameters;
    for (const Cosines c : {Cosines{0.9f, 0.8f, 0.7f}, {0.3f, 0.6f, 0.1f}, {0.5f, 0.5f, 1}}) {
        EXPECT_EQ(brdf_value(placed, c)[0], brdf_value(bsdf(other), c)[0]);
        EXPECT_NE(brdf_value(placed, c)[0], brdf_value(bsdf(own), c)[0]);
    }
}

}  // namespace
}  // namespace hilcam
