#include "emulator/run/probe_report.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/plate.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

// Two plates of 10 cm that face each other, 10 cm apart, as one object.
class ProbeReport : public PlateTest {
  protected:
    ScenarioConfig plates(const std::string& path_model) {
        const auto file = scenario("", "quality: {path_model: " + path_model + ", probes: 2000}\n");
        write("plate.obj",
              "v -0.05 -0.05 0\nv 0.05 -0.05 0\nv 0.05 0.05 0\nv -0.05 0.05 0\n"
              "v -0.05 -0.05 -0.1\nv 0.05 -0.05 -0.1\nv 0.05 0.05 -0.1\nv -0.05 0.05 -0.1\n"
              "f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\n");
        return load_scenario(file, {});
    }
};

TEST_F(ProbeReport, SaysWhatEachDirectionMeets) {
    const ScenarioConfig s = plates("cached");
    const auto first = nlohmann::json::parse(probe_report(s, {"plate", 0}));
    const auto probes = first["probes"].get<std::uint32_t>();
    ASSERT_GT(probes, 100u);
    std::size_t met = 0, free = 0;
    for (std::uint32_t n = 0; n < probes; n += probes / 8) {
        const auto report = nlohmann::json::parse(probe_report(s, {"plate", n}));
        EXPECT_EQ(report["object"], "plate");
        EXPECT_EQ(report["probe"], n);
        EXPECT_EQ(report["points"].size(), 4u);
        EXPECT_NEAR(std::abs(report["normal"][2].get<double>()), 1, 0.01);
        ASSERT_EQ(report["directions"].size(), 60u);
        const double z_m = report["points"][0]["position_m"][2].get<double>();
        for (const auto& ray : report["directions"]) {
            free += ray["meets"] == "nothing";
            if (ray["meets"] != "probe") continue;
            ++met;
            EXPECT_LT(ray["probe"].get<std::uint32_t>(), probes);
            EXPECT_NEAR(std::abs(ray["position_m"][2].get<double>() - z_m), 0.1, 0.001);
        }
    }
    EXPECT_GT(met, 20u);
    EXPECT_GT(free, 20u);
}

TEST_F(ProbeReport, RefusesWhatThereIsNot) {
    const auto refusal = [this](const ScenarioConfig& s, const ProbeChoice& choice) {
        return error_of([&] { (void)probe_report(s, choice); });
    };
    const ScenarioConfig s = plates("cached");
    EXPECT_THAT(refusal(s, {"plat", 0}),
                HasSubstr("--probe plat: the scenario has no such object; accepted: plate"));
    EXPECT_THAT(refusal(s, {"plate", 1'000'000}),
                HasSubstr("--probe plate 1000000: it has no such probe; accepted: 0 to "));
    EXPECT_THAT(refusal(plates("direct"), {"plate", 0}),
                HasSubstr("--probe plate: no light is cached on it with quality.path_model 'direct'"));
}

}  // namespace
}  // namespace hilcam
