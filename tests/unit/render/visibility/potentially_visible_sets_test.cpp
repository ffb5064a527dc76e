#include "render/visibility/potentially_visible_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "render/scene/coplanar_groups.h"
#include "render/visibility/visibility_buffer.h"
#include "render/vocabulary/mesh.h"
#include "render/vocabulary/units.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

constexpr int kSide_px = 128;  // a picture of as many samples as sets are for
constexpr double kFrom_radii = 100;

void add_box(Vec3f middle, Vec3f half, Mesh& mesh) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
    for (int i = 0; i < 8; ++i)
        mesh.vertices_m.push_back(
            middle + Vec3f{i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z});
    constexpr std::uint32_t kCorners[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                               {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                               {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    for (const auto& c : kCorners) mesh.triangles.push_back({first + c[0], first + c[1], first + c[2]});
}

// Boxes in a sphere of 1 m, of all sizes, in front of each other and within each other.
Mesh boxes() {
    Mesh mesh;
    add_box({}, {0.3f, 0.3f, 0.3f}, mesh);
    add_box({}, {0.29f, 0.29f, 0.29f}, mesh);
    std::mt19937 engine(1);
    std::uniform_real_distribution<float> place(-0.5f, 0.5f), size(-8.0f, -3.0f);
    for (int i = 0; i < 300; ++i)
        add_box({place(engine), place(engine), place(engine)},
                {std::exp2(size(engine)), std::exp2(size(engine)), std::exp2(size(engine))}, mesh);
    return mesh;
}

// What samples see from a direction: of the whole mesh, or of a set.
class Views {
  public:
    explicit Views(const Mesh& mesh)
        : shown_{0, {}, 1, {mesh.vertices_m, mesh.triangles}},
          buffer_(geometry(), {1, mesh.vertices_m.size(), mesh.triangles.size()}) {}

    std::vector<std::uint32_t> seen(Vec3d from, const PotentiallyVisibleSet* set) {
        shown_.visible = set;
        EXPECT_TRUE(
            buffer_.place({kFrom_radii * from, look_along(-1.0 * from, {0.3, 0.5, 0.8})}, {&shown_, 1}));
        std::vector<std::uint32_t> out(kSide_px * kSide_px * kVisibilitySamples, VisibilityTile::kNothing);
        buffer_.fill_all(tile_, [&](int x_px, int y_px) {
            const auto tile =
                static_cast<std::size_t>((y_px * kSide_px / kVisibilityTile_px + x_px) / kVisibilityTile_px);
            for (std::size_t i = 0; i < VisibilityTile::kSize; ++i)
                if (const std::uint32_t id = tile_.id[i]; id != VisibilityTile::kNothing)
                    out[tile * VisibilityTile::kSize + i] = buffer_.seen(id).triangle;
        });
        return out;
    }

  private:
    VisibilityBuffer::Shown shown_;
    VisibilityBuffer buffer_;
    VisibilityTile tile_;
    static ImageGeometry geometry() {
        ImageGeometry out;
        out.width_px = out.height_px = kSide_px, out.focal_length_px = 0.5 * kSide_px * kFrom_radii;
        return out;
    }
};

std::vector<Vec3d> directions(int count) {
    std::mt19937 engine(2);
    std::normal_distribution<double> along;
    std::vector<Vec3d> out;
    for (int i = 0; i < count; ++i)
        out.push_back(normalized(Vec3d{along(engine), along(engine), along(engine)}));
    return out;
}

TEST(PotentiallyVisibleSets, ShowWhatTheWholeMeshShows) {
    const Mesh mesh = boxes();
    const PotentiallyVisibleSets sets({mesh.vertices_m, mesh.triangles}, 1, {});
    ASSERT_TRUE(sets.serves(kFrom_radii, 2.0 / (4 * kSide_px) / kFrom_radii));
    Views views(mesh);
    double seen = 0, other = 0, triangles = 0;
    const std::vector<Vec3d> all = directions(60);
    for (const Vec3d from : all) {
        const PotentiallyVisibleSet& set = sets.from(from);
        triangles += static_cast<double>(set.triangles.size());
        const auto whole = views.seen(from, nullptr), part = views.seen(from, &set);
        for (std::size_t i = 0; i < whole.size(); ++i) {
            seen += whole[i] != VisibilityTile::kNothing;
            other += whole[i] != part[i];
            // The one within the first is never seen.
            EXPECT_FALSE(part[i] >= 12 && part[i] < 24);
        }
    }
    EXPECT_GT(seen, 1e6);
    EXPECT_LT(other, 3e-4 * seen);
    // Three of a box' six sides are turned away.
    EXPECT_LT(triangles, 0.6 * static_cast<double>(all.size() * mesh.triangles.size()));
}

// A plate's edge of 0.2 mm, a fifth of what pictures' samples are apart, is all that is seen of it along its plane. Samples in rows along
// it would be met by it all at once, or not at all.
TEST(PotentiallyVisibleSets, HaveEdgesOfPlatesThatLieBetweenTwoRowsOfSamples) {
    Mesh mesh;
    add_box({}, {0.9f, 0.3f, 0.0001f}, mesh);
    const PotentiallyVisibleSets sets({mesh.vertices_m, mesh.triangles}, 1, {});
    for (double angle_rad = 0.1; angle_rad < 2 * kPi; angle_rad += 0.2) {
        const PotentiallyVisibleSet& set = sets.from({std::cos(angle_rad), std::sin(angle_rad), 1e-5});
        // Two sides' triangles of the rim are turned to the camera.
        const auto of_rim =
            std::count_if(set.ids.begin(), set.ids.end(), [](std::uint32_t id) { return id >= 4; });
        EXPECT_GE(of_rim, 4) << angle_rad;
    }
}

TEST(PotentiallyVisibleSets, LeaveOutWhatIsNotShownAndNameWhatStandsForIt) {
    Mesh mesh;
    add_box({}, {0.5f, 0.5f, 0.5f}, mesh);
    std::vector<std::uint32_t> coplanar_groups(mesh.triangles.size());
    for (std::uint32_t i = 0; i < coplanar_groups.size(); ++i) coplanar_groups[i] = i / 2 * 2;
    coplanar_groups[2] = coplanar_groups[3] = kNotShown;
    const PotentiallyVisibleSets sets({mesh.vertices_m, mesh.triangles}, 1, coplanar_groups);
    for (const Vec3d from : directions(20)) {
        const PotentiallyVisibleSet& set = sets.from(from);
        ASSERT_EQ(set.ids.size(), set.triangles.size());
        for (std::size_t i = 0; i < set.ids.size(); ++i) {
            EXPECT_NE(set.ids[i], kNotShown);
            EXPECT_EQ(set.ids[i] % 2, 0u);
            EXPECT_NE(set.ids[i], 2u);
        }
    }
    // The side of triangles 2 and 3 is open: what lies behind is seen through it.
    const PotentiallyVisibleSet& set = sets.from({0.1, 0.2, 1});
    EXPECT_NE(std::count(set.ids.begin(), set.ids.end(), 0u), 0);
}

TEST(PotentiallyVisibleSets, AreForCamerasFarAwayAndPicturesCoarserThanTheirs) {
    Mesh mesh;
    add_box({}, {0.5f, 0.5f, 0.5f}, mesh);
    const PotentiallyVisibleSets sets({mesh.vertices_m, mesh.triangles}, 2, {});
    EXPECT_TRUE(sets.serves(1000, 4.0 / 500 / 1000));
    EXPECT_FALSE(sets.serves(1000, 4.0 / 600 / 1000));
    EXPECT_TRUE(sets.serves(81, 1));
    EXPECT_FALSE(sets.serves(79, 1));
}

// Cubes in rows, each turned otherwise, of one make or each of its own.
RadianceImage picture_of_cubes(bool alike) {
    Stage s;
    s.quality.visibility = "buffer";
    s.quality.max_depth = 1;
    s.quality.rays_across = 0;
    s.camera(128, 0.08);
    s.sun({0.3, 0.2, -1});
    for (int i = 0; i < 16; ++i) {
        SceneObject object = cube(lambert(0.5), s.grid);
        if (alike && i > 0) object.like = 0;
        s.add(std::move(object), {2.0 * (i % 4) - 3, 2.0 * (i / 4) - 3, 60}, {0.4 * i, 0.3 * i, 0.2 * i});
    }
    s.render();
    return std::move(s.radiance);
}

TEST(PotentiallyVisibleSets, ManyInstancesAreSeenAsEachByItself) {
    const RadianceImage alike = picture_of_cubes(true), each = picture_of_cubes(false);
    double light = 0;
    for (std::size_t i = 0; i < each.all().size(); ++i) {
        ASSERT_EQ(alike.all()[i], each.all()[i]) << i;
        light += static_cast<double>(each.all()[i]);
    }
    EXPECT_GT(light, 0);
}

}  // namespace
}  // namespace hilcam
