#include "emulator/run/render_command.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>

#include <cmath>

#include "tests/support/plate.h"

namespace hilcam {
namespace {

// A picture as OpenEXR's readers have it.
struct Picture {
    Imath::Box2i display, data;
    std::vector<float> values;

    // The mean place of the pixels above half of the brightest one, in the file's own coordinates [px].
    Vec2d centre() const {
        const float most = *std::max_element(values.begin(), values.end());
        const int width = data.max.x - data.min.x + 1;
        Vec2d sum;
        double count = 0;
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (!(values[i] > most / 2)) continue;
            sum.x += data.min.x + static_cast<int>(i) % width + 0.5;
            sum.y += data.min.y + static_cast<int>(i) / width + 0.5;
            ++count;
        }
        return {sum.x / count, sum.y / count};
    }
};

class RenderToFile : public PlateTest {
  protected:
    static Picture read(const std::filesystem::path& file, const char* channel) {
        Imf::InputFile in(file.c_str());
        Picture out{in.header().displayWindow(), in.header().dataWindow(), {}};
        const Imath::V2i size = out.data.size() + Imath::V2i(1, 1);
        out.values.resize(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
        Imf::FrameBuffer buffer;
        buffer.insert(channel, Imf::Slice::Make(Imf::FLOAT, out.values.data(), out.data));
        in.setFrameBuffer(buffer);
        in.readPixels(out.data.min.y, out.data.max.y);
        return out;
    }
};

// Black columns are left of what is exposed, black rows above it; the guard band is about that.
TEST_F(RenderToFile, EveryStageAndTheTruthPutTheFrameAtTheSamePlace) {
    const auto file = scenario(", black_columns: 3, black_rows: 2");
    for (const int oversampling : {1, 2}) {
        const std::vector<std::string> overrides = {"quality.guard_px=16",
                                                    "objects.0.pose.position_m=[0.05, -0.03, 4]",
                                                    "quality.oversampling=" + std::to_string(oversampling)};
        const ScenarioConfig s = load_scenario(file, overrides);
        render_to_files(s, RenderStage::kRadiance, 0,
                        {.out = folder_ / "radiance.exr", .view = {}, .truth = folder_ / "truth"});
        render_to_files(s, RenderStage::kElectrons, 0,
                        {.out = folder_ / "electrons.exr", .view = {}, .truth = {}});
        const Picture radiance = read(folder_ / "radiance.exr", "Y"),
                      electrons = read(folder_ / "electrons.exr", "Y"),
                      object = read(folder_ / "truth" / "truth_00000001.exr", "object.ID");
        const Imath::Box2i frame({0, 0}, {66, 65});
        for (const Imath::Box2i& window : {electrons.display, electrons.data, object.display, object.data})
            EXPECT_EQ(window, frame);
        const int m = oversampling;
        EXPECT_EQ(radiance.display, Imath::Box2i({0, 0}, {67 * m - 1, 66 * m - 1}));
        EXPECT_EQ(radiance.data, Imath::Box2i({(3 - 16) * m, (2 - 16) * m}, {83 * m - 1, 82 * m - 1}));
        const Vec2d truth = object.centre(), charge = electrons.centre(), wide = radiance.centre();
        const Vec2d light{wide.x / m, wide.y / m};
        EXPECT_NEAR(truth.x, 3 + 32 + 8, 0.51);
        for (const Vec2d& centre : {light, charge}) {
            EXPECT_NEAR(centre.x, truth.x, 0.3);
            EXPECT_NEAR(centre.y, truth.y, 0.3);
        }
    }
}

}  // namespace
}  // namespace hilcam
