#include "io/ip42/ip42_message.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "io/ip42/ip42_stream.h"
#include "tests/support/near.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

// As 42 writes it with the prefixes "SC", "Orb" and "World".
const std::string kMessage =
    "TIME 2026-079-14:00:00.100000000\n"
    "SC[1].qn = [ 0.000000000000e+00  0.000000000000e+00  7.071067811865e-01  7.071067811865e-01]\n"
    "SC[1].wn = [ 0.000000000000e+00  0.000000000000e+00  1.000000000000e-02]\n"
    "SC[1].PosR = [ 1.200000000000e+02 -3.500000000000e+00  0.000000000000e+00]\n"
    "SC[1].VelR = [-1.000000000000e-01  0.000000000000e+00  2.500000000000e-01]\n"
    "SC[1].svb = [ 6.000000000000e-01  0.000000000000e+00  8.000000000000e-01]\n"
    "SC[1].bvb = [ 1.000000000000e-05  0.000000000000e+00  0.000000000000e+00]\n"
    "SC[1].B[2].qn = [ 1.000000000000e+00  0.000000000000e+00  0.000000000000e+00  0.000000000000e+00]\n"
    "SC[1].G[0].Ang = [ 1.000000000000e-01  0.000000000000e+00  0.000000000000e+00]\n"
    "Orb[0].PosN = [ 6.878000000000e+06  0.000000000000e+00  0.000000000000e+00]\n"
    "Orb[0].VelN = [ 0.000000000000e+00  7.612000000000e+03  0.000000000000e+00]\n"
    "World[3].PosH = [ 1.400000000000e+11  0.000000000000e+00  0.000000000000e+00]\n";

TEST(Ip42Message, HasTimePlacesAndAttitudesAndCountsWhatItDoesNotUse) {
    const DecodedIp42 decoded = decode_ip42(kMessage);
    EXPECT_EQ(decoded.refusal, "");
    const Ip42Message& m = decoded.message;
    // Day 79 of 2026 is 20 March: 31 + 28 + 20.
    EXPECT_EQ(m.time, parse_utc("2026-03-20T14:00:00.1Z"));
    ASSERT_EQ(m.spacecraft.count(1), 1u);
    const Ip42Spacecraft& craft = m.spacecraft.at(1);
    expect_near(*craft.position_r_m, {120, -3.5, 0}, 0);
    expect_near(*craft.velocity_r_m_s, {-0.1, 0, 0.25}, 0);
    expect_near(*craft.sun_body_dir, {0.6, 0, 0.8}, 0);
    // Scalar last: a quarter about z, which takes the body's x to N's y.
    expect_near(to_matrix(*craft.bodies.at(0).n_from_body) * Vec3d{1, 0, 0}, {0, 1, 0}, 1e-12);
    expect_near(*craft.bodies.at(0).rate_body_rad_s, {0, 0, 0.01}, 0);
    expect_near(to_matrix(*craft.bodies.at(2).n_from_body) * Vec3d{0, 1, 0}, {0, -1, 0}, 1e-15);
    EXPECT_FALSE(craft.bodies.at(2).rate_body_rad_s);
    expect_near(*m.orbits.at(0).position_n_m, {6.878e6, 0, 0}, 0);
    expect_near(*m.orbits.at(0).velocity_n_m_s, {0, 7612, 0}, 0);
    EXPECT_EQ(m.skipped_lines, 3u);  // bvb, the joint, the world
}

TEST(Ip42Message, TimeIsUtcByTheDayOfTheYear) {
    const auto time = [](const std::string& text) { return decode_ip42("TIME " + text + "\n").message.time; };
    EXPECT_EQ(time("2024-366-23:59:59.999999999"), parse_utc("2024-12-31T23:59:59.999999999Z"));
    EXPECT_EQ(time("2024-060-00:00:00.000000001"), parse_utc("2024-02-29T00:00:00.000000001Z"));
    // A leap second, and 42's rounding of a second to be: both are the second after that of :59.
    EXPECT_EQ(time("2016-366-23:59:60.500000000") - time("2016-366-23:59:59.500000000"), kSecond_ns);
    EXPECT_EQ(time("2026-079-14:00:60.000000000"), parse_utc("2026-03-20T14:01:00Z"));
    EXPECT_THAT(decode_ip42("TIME \n").refusal, HasSubstr("no TIME"));
    for (const char* bad : {"2026-079", "2026-000-00:00:00", "2025-366-00:00:00", "2026-079-24:00:00",
                            "2026-079-00:60:00", "2026-079-00:00:61", "2026-079-00:00:nan",
                            "2026-079-00:00:-1", "1-1-1:1", "9999-079-00:00:00", "2026-03-20T00:00:00Z"})
        EXPECT_THAT(decode_ip42("TIME " + std::string(bad) + "\n").refusal, HasSubstr("accepted: YYYY-DDD"))
            << bad;
}

TEST(Ip42Message, AValueThatIsNoneRefusesTheMessageInOneLine) {
    const auto refusal = [](const std::string& line) {
        return decode_ip42("TIME 2026-079-14:00:00\n" + line + "\n").refusal;
    };
    EXPECT_EQ(refusal("SC[0].PosR = [1 nan 3]"),
              "line 2: PosR: found '[1 nan 3]'; accepted: [x y z], three finite numbers");
    EXPECT_THAT(refusal("SC[0].PosR = [1 inf 3]"), HasSubstr("PosR"));
    EXPECT_THAT(refusal("SC[0].PosR = [1 2]"), HasSubstr("PosR"));
    EXPECT_THAT(refusal("SC[0].PosR = [1 2 3 4]"), HasSubstr("PosR"));
    EXPECT_THAT(refusal("SC[0].PosR = 1 2 3"), HasSubstr("PosR"));
    EXPECT_THAT(refusal("Orb[0].PosN = [1 2 1e999]"), HasSubstr("PosN"));
    EXPECT_THAT(refusal("SC[0].B[1].qn = [0 0 0 0]"), HasSubstr("quaternion of length 1"));
    EXPECT_THAT(refusal("SC[0].B[1].qn = [0 0 0 1.1]"), HasSubstr("quaternion of length 1"));
    EXPECT_THAT(refusal("SC[0].svb = [x\x1b[2J y z]"), testing::Not(HasSubstr("\x1b")));
    EXPECT_EQ(decode_ip42("SC[0].PosR = [1 2 3]\n").refusal,
              "no TIME; accepted: a message that begins with it");
    // Other names are not looked at, whatever they say.
    for (const char* other : {"SC[0].Gyro[0].TrueRate = nan", "SC[-1].PosR = [x]", "SC[10000].PosR = [x]",
                              "SC[0].B[0].mass = [x]", "SC[0].G[0].qn = [x]", "sc[0].PosR = [x]", "= [1]",
                              "Orb[0].B[0].PosN = [x]", "SC[0]PosR = [x]", "PosR = [x]", "garbage"}) {
        const DecodedIp42 decoded = decode_ip42("TIME 2026-079-14:00:00\n" + std::string(other) + "\n");
        EXPECT_EQ(decoded.refusal, "") << other;
        EXPECT_EQ(decoded.message.skipped_lines, 1u) << other;
    }
}

TEST(Ip42Message, ABodysNameIsThatOf42) {
    const auto name = ip42_body_name("SC[12].B[3]");
    ASSERT_TRUE(name);
    EXPECT_EQ(name->spacecraft, 12);
    EXPECT_EQ(name->body, 3);
    for (const char* bad :
         {"", "SC[0]", "SC[0].G[0]", "SC[0].B", "SC[a].B[0]", "SC[0].B[0].qn", "SC[-1].B[0]"})
        EXPECT_FALSE(ip42_body_name(bad)) << bad;
}

TEST(Ip42Stream, FindsMessagesHoweverTheirBytesCome) {
    const std::string bytes = kMessage + "[ENDMSG]\n" + "TIME x\r\n[EOF]\r\n" + "rest";
    Ip42Stream stream;
    std::vector<std::string> found;
    for (const char byte : bytes) {
        stream.put({&byte, 1});
        while (const auto message = stream.take()) found.push_back(message->text);
    }
    EXPECT_EQ(found, (std::vector<std::string>{kMessage, "TIME x\r\n"}));
    stream.clear();
    EXPECT_EQ(stream.size(), 0u);
}

TEST(Ip42Stream, AMessageThatIsTooLongIsNotKeptAndEnds) {
    Ip42Stream stream;
    const std::string line(1000, 'x');
    for (int i = 0; i < 1000; ++i) {
        stream.put(line + (i % 2 == 0 ? "\n" : ""));
        EXPECT_FALSE(stream.take());
        EXPECT_LE(stream.size(), 2 * Ip42Stream::kMaxMessage_bytes);
    }
    stream.put(std::string(200'000, 'y'));
    EXPECT_FALSE(stream.take());
    EXPECT_EQ(stream.size(), 0u);
    stream.put("[EOF]\n");  // the end of the long line, which is no end
    EXPECT_FALSE(stream.take());
    stream.put("[EOF]\nTIME\n[EOF]\n");
    const auto first = stream.take(), second = stream.take();
    ASSERT_TRUE(first && second);
    EXPECT_TRUE(first->too_long);
    EXPECT_EQ(first->text, "");
    EXPECT_FALSE(second->too_long);
    EXPECT_EQ(second->text, "TIME\n");
}

}  // namespace
}  // namespace hilcam
