// The description, the feature table and the registers say the same.

#include <gmock/gmock.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <regex>
#include <set>

#include "gige_bench.h"
#include "io/gige/device/genicam_xml.h"
#include "io/gige/device/gige_lines.h"

namespace hilcam {
namespace {

std::vector<std::uint8_t> read_all(GigeBench& b, std::uint32_t address, std::size_t size) {
    std::vector<std::uint8_t> out;
    while (out.size() < size) {
        const auto piece = b.read_memory(address + static_cast<std::uint32_t>(out.size()), 512);
        EXPECT_EQ(piece.status, gvcp::kSuccess);
        if (piece.payload.size() != 516) break;
        out.insert(out.end(), piece.payload.begin() + 4, piece.payload.end());
    }
    out.resize(size);
    return out;
}
struct Url {
    std::string name;
    std::uint32_t address = 0;
    std::size_t size = 0;
};
Url url_at(GigeBench& b, std::uint32_t address) {
    const auto r = b.read_memory(address, 512);
    const std::string text = reinterpret_cast<const char*>(r.payload.data() + 4);
    std::smatch m;
    EXPECT_TRUE(std::regex_match(text, m, std::regex("Local:///([a-z.]+);([0-9A-F]+);([0-9A-F]+)"))) << text;
    return {m[1], static_cast<std::uint32_t>(std::stoul(m[2], nullptr, 16)), std::stoul(m[3], nullptr, 16)};
}

TEST(Genicam, TheDescriptionIsThereTwice) {
    GigeBench b;
    const std::string xml = b.device.xml();
    const Url plain = url_at(b, bootstrap::kSecondXmlUrl), zipped = url_at(b, bootstrap::kXmlUrl);
    EXPECT_EQ(plain.name, "hilcam.xml");
    ASSERT_EQ(plain.size, xml.size());
    const auto read = read_all(b, plain.address, plain.size);
    EXPECT_EQ(std::string(read.begin(), read.end()), xml);

    EXPECT_EQ(zipped.name, "hilcam.zip");
    EXPECT_LT(zipped.size, xml.size() / 4);
    const auto zip = read_all(b, zipped.address, zipped.size);
    ASSERT_GE(zip.size(), 40u);
    EXPECT_EQ(zip[0], 'P');
    // A local header of 30 bytes and the name, then the deflated file.
    std::string unzipped(xml.size(), '\0');
    z_stream stream{};
    ASSERT_EQ(inflateInit2(&stream, -MAX_WBITS), Z_OK);
    std::vector<std::uint8_t> data(zip.begin() + 40, zip.end());
    stream.next_in = data.data();
    stream.avail_in = static_cast<uInt>(data.size());
    stream.next_out = reinterpret_cast<Bytef*>(unzipped.data());
    stream.avail_out = static_cast<uInt>(unzipped.size());
    EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
    inflateEnd(&stream);
    EXPECT_EQ(unzipped, xml);
    EXPECT_EQ(b.write(plain.address, 0), gvcp::kAccessDenied);
    b.take_control();
    EXPECT_EQ(b.write(plain.address, 0), gvcp::kWriteProtect);
}

class GenicamOf : public testing::TestWithParam<const char*> {
  public:
    static CameraLimits limits() {
        CameraLimits l = PlainCamera().l;
        l.color_pattern = GetParam();
        return l;
    }
};
INSTANTIATE_TEST_SUITE_P(Cameras, GenicamOf, testing::Values("", "RGGB"));

TEST_P(GenicamOf, EveryNodeIsThereOnceAndEveryReferenceHasItsNode) {
    const std::string xml = genicam_xml(gige_features(limits(), true), "1 camera");
    std::set<std::string> names;
    const std::regex node("<([A-Z][A-Za-z]*) Name=\"([^\"]*)\"");
    for (std::sregex_iterator i(xml.begin(), xml.end(), node), end; i != end; ++i) {
        if ((*i)[1] == "EnumEntry") continue;
        EXPECT_TRUE(std::regex_match((*i)[2].str(), std::regex("[A-Za-z][0-9A-Za-z_]*"))) << (*i)[2];
        EXPECT_TRUE(names.insert((*i)[2]).second) << (*i)[2] << " twice";
    }
    EXPECT_GT(names.size(), 200u);
    const std::regex reference("<(p[A-Z][A-Za-z]*)[^>]*>([^<]*)</");
    int references = 0;
    for (std::sregex_iterator i(xml.begin(), xml.end(), reference), end; i != end; ++i, ++references)
        EXPECT_TRUE(names.count((*i)[2])) << (*i)[1] << " " << (*i)[2];
    EXPECT_GT(references, 400);
    EXPECT_THAT(xml, testing::HasSubstr("ModelName=\"M1_camera\""));
}

TEST_P(GenicamOf, ElementsAreClosedInTheirOrder) {
    const std::string xml = genicam_xml(gige_features(limits(), true), "a");
    std::vector<std::string> open;
    const std::regex tag("<(/?)([A-Za-z]+)[^>]*>");
    for (std::sregex_iterator i(xml.begin() + 2, xml.end(), tag), end; i != end; ++i) {
        if ((*i)[1] == "") {
            open.push_back((*i)[2]);
        } else {
            ASSERT_FALSE(open.empty());
            ASSERT_EQ(open.back(), (*i)[2].str());
            open.pop_back();
        }
    }
    EXPECT_TRUE(open.empty());
}

// The sequencer's sets are written in its configuration mode.
void unlock(GigeBench& b, const Feature& f) {
    const bool configures = f.lock == "SequencerIsNotConfigured";
    EXPECT_EQ(b.write(feature_register::kSequencerConfigurationMode, configures), gvcp::kSuccess);
}

TEST_P(GenicamOf, RegistersAreWhatTheFeaturesSay) {
    const CameraLimits l = limits();
    GigeBench b(&l);
    b.take_control();
    for (const Feature& f : gige_features(l, true).features) {
        if (f.is_constant || f.port != "Device") continue;
        SCOPED_TRACE(f.name);
        unlock(b, f);
        const auto now = b.read_memory(f.address, static_cast<std::uint16_t>(f.bytes));
        ASSERT_EQ(now.status, gvcp::kSuccess);
        if (f.kind == Feature::Kind::kCommand || f.access == Feature::Access::kWrite) continue;
        // Of a masked register other features may be writable.
        if (f.access == Feature::Access::kRead && f.high_bit < 0) {
            EXPECT_EQ(b.send(gvcp::kWriteMemory, now.payload).status, gvcp::kWriteProtect);
        }
        // What is there can be written again, but for what is switched off now.
        if (f.access == Feature::Access::kReadWrite && f.name != "DeviceUserID") {
            EXPECT_EQ(b.send(gvcp::kWriteMemory, now.payload).status, gvcp::kSuccess);
        }
        if (!f.limited || f.kind != Feature::Kind::kInteger || f.bytes != 4 || f.high_bit >= 0) continue;
        const double value = ByteReader(std::span(now.payload).subspan(4)).u32();
        EXPECT_TRUE(!f.least.feature.empty() || value >= f.least.number) << value;
        EXPECT_TRUE(!f.most.feature.empty() || value <= f.most.number) << value;
    }
}

// Writes a part of a register as clients do: what is beside it as it is read, or zeros where it cannot be.
std::uint32_t with_part(GigeBench& b, const Feature& f, std::uint32_t value) {
    const std::uint32_t mask = f.high_bit < 0 ? 0xFFFFFFFF : (2u << (f.high_bit - f.low_bit)) - 1u;
    const int shift = std::max(0, f.low_bit);
    const std::uint32_t beside = f.access == Feature::Access::kWrite ? 0 : b.read(f.address);
    return (beside & ~(mask << shift)) | (value & mask) << shift;
}

TEST_P(GenicamOf, EveryCommandCanBeExecutedAsClientsDo) {
    const CameraLimits l = limits();
    int commands = 0;
    for (const Feature& f : gige_features(l, true).features) {
        if (f.kind != Feature::Kind::kCommand) continue;
        SCOPED_TRACE(f.name);
        GigeBench b(&l);
        b.take_control();
        b.open_stream();
        if (f.name == "UserSetSave")
            b.write(feature_register::kUserSetSelector, 1);  // the default is read only
        unlock(b, f);
        EXPECT_EQ(b.write(f.address, with_part(b, f, 1)), gvcp::kSuccess);
        // "Done" is when the command's own value is not there any more.
        EXPECT_NE(b.read(f.address) >> std::max(0, f.low_bit) & 1, 1u);
        if (f.name == "GevSCPSFireTestPacket") {
            EXPECT_THAT(b.tests, testing::SizeIs(1));
        }
        ++commands;
    }
    EXPECT_GT(commands, 10);
}

TEST_P(GenicamOf, PartsOfARegisterCanBeWrittenAlone) {
    const CameraLimits l = limits();
    const FeatureTable table = gige_features(l, true);
    for (const Feature& f : table.features) {
        if (f.high_bit < 0 || f.access == Feature::Access::kRead || f.kind == Feature::Kind::kCommand ||
            f.is_constant || f.port != "Device")
            continue;
        SCOPED_TRACE(f.name);
        GigeBench b(&l);
        b.take_control();
        std::vector<std::uint32_t> values = {0, 1};
        if (f.kind == Feature::Kind::kInteger)
            values = {static_cast<std::uint32_t>(f.least.number), static_cast<std::uint32_t>(f.most.number)};
        for (const std::uint32_t value : values)
            EXPECT_EQ(b.write(f.address, with_part(b, f, value)), gvcp::kSuccess) << value;
    }
}

TEST_P(GenicamOf, NumbersOutsideTheirBoundsAreRefused) {
    const CameraLimits l = limits();
    int bounds = 0;
    for (const Feature& f : gige_features(l, true).features) {
        if (!f.limited || f.access == Feature::Access::kRead || f.is_constant || f.high_bit >= 0 ||
            f.port != "Device")
            continue;
        SCOPED_TRACE(f.name);
        GigeBench b(&l);
        b.take_control();
        unlock(b, f);
        const auto write = [&](double value) {
            return f.kind == Feature::Kind::kFloat ? b.write_real(f.address, value)
                   : f.bytes == 8                  ? b.write64(f.address, static_cast<std::uint64_t>(value))
                                                   : b.write(f.address, static_cast<std::uint32_t>(value));
        };
        const bool real = f.kind == Feature::Kind::kFloat;
        const double room = real ? 1e300 : f.bytes == 8 ? 1.8e19 : 4294967295.0;
        const double beyond = f.most.number * (1 + 1e-9) + (real ? 1e-9 : 1);
        if (f.most.feature.empty() && beyond <= room) {
            EXPECT_NE(write(std::max(beyond, f.bytes == 8 && !real ? 9.3e18 : 0)), gvcp::kSuccess);
            ++bounds;
        }
        if (f.least.feature.empty() && (real || f.least.number >= 1)) {
            EXPECT_NE(write(f.least.number - (real ? 1e-9 + 1e-9 * std::abs(f.least.number) : 1)),
                      gvcp::kSuccess);
            ++bounds;
        }
    }
    EXPECT_GT(bounds, 20);
}

TEST_P(GenicamOf, EnumerationsAcceptTheirEntriesAndNothingElse) {
    const CameraLimits l = limits();
    for (const Feature& f : gige_features(l, true).features) {
        if (f.kind != Feature::Kind::kEnumeration || f.is_constant || f.high_bit >= 0 || f.port != "Device" ||
            f.access != Feature::Access::kReadWrite || f.name == "GevCCP")
            continue;
        SCOPED_TRACE(f.name);
        LinePlan plan;
        plan.is_there[1] = plan.is_output[1] = true;
        GigeBench b(&l, {}, ClockSource::kTai, false, plan);
        b.take_control();
        unlock(b, f);
        // Signals are for outputs, and the wiring says what a line is.
        EXPECT_EQ(b.write(feature_register::kLineSelector, GigeLines::kFirstOwn + 1), gvcp::kSuccess);
        for (const EnumEntry& entry : f.entries) {
            const bool refused = f.name == "LineMode" && entry.name == "Input";
            EXPECT_EQ(b.write(f.address, static_cast<std::uint32_t>(entry.value)),
                      refused ? gvcp::kInvalidParameter : gvcp::kSuccess)
                << entry.name;
            EXPECT_EQ(b.read(f.address), refused ? 1 : entry.value);
        }
        EXPECT_EQ(b.write(f.address, 0x7FFFFFF0), gvcp::kInvalidParameter);
    }
}

}  // namespace
}  // namespace hilcam
