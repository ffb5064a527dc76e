// What of a scenario's objects becomes models of a BOP data set; the files themselves are read by
// tests/protocol/campaign_test.py.

#include "emulator/campaign/bop_models.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "io/system/input_file.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

class BopModels : public FilesTest {
  protected:
    std::vector<ObjectConfig> objects_;
    CampaignConfig campaign_;

    void SetUp() override {
        FilesTest::SetUp();
        // A tetrahedron of four corners, and a vertex that no triangle has.
        const auto mesh = write(
            "shape.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 1 0 3\nv 9 9 9\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
        objects_.resize(3);
        for (ObjectConfig& object : objects_) object.mesh = mesh, object.has_mesh = true;
        objects_[1].scale = 0.5;
    }

    static std::string text_of(const std::filesystem::path& file) {
        return read_input_file(file, {1u << 20, "a model"});
    }
    nlohmann::json written() {
        write_bop_models(folder_ / "models", campaign_, objects_);
        return nlohmann::json::parse(text_of(folder_ / "models/models_info.json"));
    }
    bool has_model(int number) const {
        return std::filesystem::exists(folder_ / "models" / ("obj_00000" + std::to_string(number) + ".ply"));
    }
};

TEST_F(BopModels, HaveTheCornersOfTrianglesInMillimetres) {
    const nlohmann::json infos = written();
    ASSERT_EQ(infos.size(), 3u);
    // From (0, 2, 0) to (1, 0, 3): the square root of 14.
    EXPECT_NEAR(infos["1"]["diameter"], 1000 * std::sqrt(14.0), 1e-9);
    EXPECT_EQ(infos["1"]["size_z"], 3000);
    EXPECT_EQ(infos["2"]["size_z"], 1500);
    EXPECT_EQ(infos["3"], infos["1"]);
    const std::string first = text_of(folder_ / "models/obj_000001.ply");
    EXPECT_EQ(first, text_of(folder_ / "models/obj_000003.ply"));
    EXPECT_EQ(first.find("9000"), std::string::npos);
}

TEST_F(BopModels, AreLeftOutWhereACampaignVariesTheShape) {
    for (const char* key : {"objects.1.mesh", "objects.1.scale", "objects.1.generate.seed", "objects.1"}) {
        std::filesystem::remove_all(folder_ / "models");
        campaign_.vary = {{}};
        campaign_.vary[0].key = key;
        EXPECT_EQ(written().size(), 2u) << key;
        EXPECT_TRUE(has_model(1) && !has_model(2) && has_model(3)) << key;
    }
    for (const char* key : {"objects.1.pose.position_m", "objects.1.materials", "objects.10.scale"}) {
        campaign_.vary[0].key = key;
        EXPECT_EQ(written().size(), 3u) << key;
    }
}

}  // namespace
}  // namespace hilcam
