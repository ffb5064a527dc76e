#include "io/vizard/vizard_conversation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/vizard_wire.h"

namespace hilcam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using vizard_wire::Message;

class VizardConversationTest : public testing::Test {
  protected:
    std::vector<std::string> remarks;
    VizardWorld world{{VizardTime::kMessage, 1, {}},
                      {parse_utc("2026-01-01T00:00:00Z"), {}, {}, {{{}, 0.4, 256, 192}}},
                      [this](const std::string& text) { remarks.push_back(text); }};
    VizardConversation::Picture picture{std::string(0x1234, 'p'), {}};
    std::vector<VizardShot> shots;
    VizardConversation conversation{world, [this](const VizardShot& shot) {
                                        shots.push_back(shot);
                                        return picture;
                                    }};

    static Message update(std::int64_t frame = 1) {
        Message m;
        m.message(1, vizard_wire::time_stamp(frame, 1e9));
        m.message(3, vizard_wire::spacecraft("eye", {7e6, 0, 0}, {0, 0, 0}, {0, 0, 0}));
        m.message(4, vizard_wire::camera(1, "eye", {0, 0, 0}, vizard_wire::kAsTheSpacecraft));
        m.message(8, vizard_wire::epoch());
        return m;
    }
    VizardParts tell(const std::string& message) {
        return conversation.answer({"SIM_UPDATE", "", "", message}).parts;
    }
};

// The order of vizInterface's two steps, and its answers byte by byte.
TEST_F(VizardConversationTest, AStepIsAnsweredAsVizardDoes) {
    EXPECT_THAT(conversation.answer({"PING"}).parts, ElementsAre("PONG"));
    EXPECT_THAT(tell(update(9).bytes()), ElementsAre("OK"));
    EXPECT_THAT(conversation.answer({"REQUEST_INPUT"}).parts,
                ElementsAre("VIZARD_INPUT", Message().integer(1, 9).bytes()));
    const auto answer = conversation.answer({"REQUEST_IMAGE_1"});
    EXPECT_FALSE(answer.refused);
    EXPECT_THAT(answer.parts, ElementsAre(std::string("\0\0\x12\x34", 4), picture.bytes));
    ASSERT_EQ(shots.size(), 1u);
    EXPECT_EQ(shots[0].time, parse_utc("2026-03-20T14:00:01.5Z"));
    EXPECT_FALSE(conversation.is_over());
}

// As Basilisk asks until 2.1.4, which has one camera.
TEST_F(VizardConversationTest, WithoutANumberThePictureIsTheFirstCameras) {
    const VizardParts none = {std::string(4, '\0'), ""};
    EXPECT_EQ(conversation.answer({"REQUEST_IMAGE"}).parts, none);
    EXPECT_THAT(remarks.back(), HasSubstr("no camera of a SIM_UPDATE that can be read"));
    Message m;
    m.message(1, vizard_wire::time_stamp(1, 1e9));
    m.message(3, vizard_wire::spacecraft("eye", {7e6, 0, 0}, {0, 0, 0}, {0, 0, 0}));
    m.message(4, vizard_wire::camera(7, "eye", {0, 0, 0}, vizard_wire::kAsTheSpacecraft));
    m.message(4, vizard_wire::camera(1, "eye", {0, 0, 0}, vizard_wire::kAsTheSpacecraft));
    tell(m.bytes());
    EXPECT_EQ(conversation.answer({"REQUEST_IMAGE"}).parts[1], picture.bytes);
    ASSERT_EQ(shots.size(), 1u);
    EXPECT_EQ(shots[0].camera, 1u);  // the bench's first
    EXPECT_THAT(conversation.answer({"REQUEST_IMAGES"}).parts, ElementsAre("ERROR"));
    tell("\x0A\x7F\x01");
    EXPECT_EQ(conversation.answer({"REQUEST_IMAGE"}).parts, none);
}

TEST_F(VizardConversationTest, WithoutAPictureLengthAndPictureAreEmpty) {
    const VizardParts none = {std::string(4, '\0'), ""};
    EXPECT_EQ(conversation.answer({"REQUEST_IMAGE_1"}).parts, none);
    tell(update().bytes());
    for (const char* id : {"2", "", "1x", "99999999999999999999", "-1"}) {
        const auto answer = conversation.answer({std::string("REQUEST_IMAGE_") + id});
        EXPECT_EQ(answer.parts, none) << id;
        EXPECT_TRUE(answer.refused) << id;
    }
    EXPECT_TRUE(shots.empty());
    picture = {{}, "no film"};
    EXPECT_EQ(conversation.answer({"REQUEST_IMAGE_1"}).parts, none);
    EXPECT_THAT(remarks.back(), HasSubstr("camera 1: no picture: no film"));
}

TEST_F(VizardConversationTest, WhatCannotBeReadIsAnErrorAndNoPictureIsOfAnOldWorld) {
    tell(update().bytes());
    EXPECT_THAT(tell("\x0A\x7F\x01"), ElementsAre("ERROR"));
    EXPECT_THAT(remarks.back(), HasSubstr("SIM_UPDATE: is no VizMessage (3 bytes)"));
    EXPECT_THAT(conversation.answer({"REQUEST_IMAGE_1"}).parts[1], "");
    EXPECT_TRUE(shots.empty());
    EXPECT_THAT(conversation.answer({"SIM_UPDATE", update().bytes()}).parts, ElementsAre("ERROR"));
    EXPECT_THAT(conversation.answer({}).parts, ElementsAre("ERROR"));
    EXPECT_THAT(conversation.answer({"HELLO\n"}).parts, ElementsAre("ERROR"));
    EXPECT_THAT(remarks.back(), HasSubstr("a request 'HELLO '; accepted: PING"));
    tell(update().bytes());
    EXPECT_THAT(conversation.answer({"REQUEST_IMAGE_1"}).parts[1], picture.bytes);
}

TEST_F(VizardConversationTest, TheSimulatorSaysWhenItIsOver) {
    EXPECT_THAT(tell(update().message(10, Message().integer(3, 1)).bytes()), ElementsAre("OK"));
    EXPECT_TRUE(conversation.is_over());
}

}  // namespace
}  // namespace hilcam
