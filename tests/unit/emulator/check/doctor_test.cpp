// From given facts of a machine: what `hilcam doctor` finds and advises.

#include "emulator/check/doctor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace hilcam {
namespace {

using testing::HasSubstr;

MachineFacts good_machine() {
    MachineFacts m;
    m.cores = 8;
    m.kernel = "6.1.0";
    m.confinement = {7, true};
    m.realtime_priority = 80;
    m.receive_buffer_bytes = 64'000'000;
    m.interfaces = {{"", "eth1", 9000, true, ""}};
    m.port_faults = {""};
    m.aravis_tools = true;
    m.loopback = {true, LoopbackVersion{0, 15, 0}};
    m.video = {{"/dev/video42", "hilcam", true, true, true, true, 0}};
    m.controllers = {"fe980000.usb"};
    m.configfs = m.root = true;
    m.cache = "/home/a/.cache/hilcam";
    m.clock_synchronised = true;
    m.tai_offset_s = 37;
    return m;
}

BenchNeeds all_needs() {
    BenchNeeds n;
    n.gige = {{"eth1", 8192, 2e6}};
    n.v4l2 = {{"/dev/video42", false}};
    n.uvc = {{""}};
    n.ports = {{"commands.udp.port", "127.0.0.1:5010", false}};
    return n;
}

// What it says about a topic; empty when that is good.
std::string about(const std::string& topic, const BenchNeeds& needs, const MachineFacts& facts,
                  Finding::Level level) {
    for (const Finding& f : diagnose(needs, facts))
        if (f.topic == topic && f.level == level) return f.found + " -> " + f.advice;
    return "";
}
constexpr auto kProblem = Finding::Level::kProblem;
constexpr auto kNote = Finding::Level::kNote;

TEST(Doctor, AGoodMachineHasNothingToDo) {
    for (const Finding& f : diagnose(all_needs(), good_machine())) {
        EXPECT_EQ(f.level, Finding::Level::kGood) << f.topic << ": " << f.found;
        EXPECT_EQ(f.advice, "");
    }
}

TEST(Doctor, WhatKeepsReadersOfFilesIsToldAndMissed) {
    const auto found = [](int landlock, bool seccomp) {
        MachineFacts m = good_machine();
        m.confinement = {landlock, seccomp};
        return about("confinement", all_needs(), m, kNote);
    };
    EXPECT_EQ(found(1, true), "");
    EXPECT_THAT(found(0, true), HasSubstr("no Landlock, seccomp -> "));
    EXPECT_THAT(found(3, false), HasSubstr("Landlock 3, no seccomp -> "));
    EXPECT_THAT(found(0, false), HasSubstr("5.13"));
}

TEST(Doctor, TheCacheHasASizeABoundAndSomebodyToTrust) {
    MachineFacts m = good_machine();
    m.cache_files = 12;
    m.cache_bytes = 116'000'000, m.cache_bound_bytes = 4'096'000'000;
    EXPECT_THAT(about("cache", {}, m, Finding::Level::kGood),
                HasSubstr("/home/a/.cache/hilcam: 12 files, 116 MB of at most 4096 MB (HILCAM_CACHE_MB)"));
    m.cache_fault = "cache folder /x: belongs to user 7";
    EXPECT_THAT(about("cache", {}, m, kProblem), HasSubstr("belongs to user 7"));
    m.cache = m.cache_fault = "";
    EXPECT_THAT(about("cache", {}, m, kNote), HasSubstr("a folder in HILCAM_CACHE, or HOME"));
}

TEST(Doctor, WithoutAScenarioNothingIsAProblem) {
    const std::vector<Finding> findings = diagnose({}, MachineFacts{});
    EXPECT_TRUE(all_there(findings));
    EXPECT_THAT(findings_text(findings), HasSubstr("apt install v4l2loopback-dkms"));
}

TEST(Doctor, PtpIsAProblemWhereAClockNeedsItAndItsPortsCannotBeOpened) {
    MachineFacts m = good_machine();
    m.interfaces[0].ptp_fault = "PTP on eth1: UDP port 319: Permission denied";
    EXPECT_EQ(about("ptp", all_needs(), m, kProblem), "");  // no clock follows a master
    BenchNeeds n = all_needs();
    n.gige[0].ptp = PtpTransport::kUdp;
    EXPECT_THAT(about("ptp", n, m, kProblem), HasSubstr("port 319: Permission denied -> "));
    m.interfaces[0].ptp_fault.clear();
    EXPECT_THAT(about("ptp", n, m, Finding::Level::kGood),
                HasSubstr("UDP 319 and 320 on eth1 can be opened"));
    n.gige[0].ptp = PtpTransport::kEthernet;
    EXPECT_THAT(about("ptp", n, m, Finding::Level::kGood), HasSubstr("Ethernet messages on eth1"));
}

TEST(Doctor, PinsAndPulsesThatAScenarioNamesAreLookedFor) {
    BenchNeeds n = all_needs();
    n.wires = {{"lines.inputs.0", {.gpio = "/dev/gpiochip0", .pin = 17}, ""},
               {"lines.inputs.1", {}, "/dev/pps0"}};
    MachineFacts m = good_machine();
    m.wire_faults = {"", "/dev/pps0: No such file or directory"};
    EXPECT_EQ(about("line", n, m, Finding::Level::kGood), "/dev/gpiochip0 pin 17 -> ");
    EXPECT_EQ(about("line", n, m, kProblem),
              "/dev/pps0: No such file or directory -> set lines.inputs.1 to one that is there");
}

TEST(Doctor, Loopback) {
    MachineFacts m = good_machine();
    m.loopback = {};
    EXPECT_THAT(about("v4l2loopback", all_needs(), m, kProblem), HasSubstr("not installed"));
    m.loopback_installed = true;
    EXPECT_THAT(about("v4l2loopback", all_needs(), m, kProblem), HasSubstr("-> modprobe v4l2loopback"));
    EXPECT_FALSE(all_there(diagnose(all_needs(), m)));
    m.loopback = {true, {}};
    EXPECT_THAT(about("v4l2loopback", all_needs(), m, kNote), HasSubstr("before 0.13"));
    BenchNeeds n = all_needs();
    n.v4l2[0].wide_bayer = true;
    EXPECT_THAT(about("v4l2loopback", n, m, kProblem), HasSubstr("BAYER8 or Y16"));
}

TEST(Doctor, LoopbackDevices) {
    MachineFacts m = good_machine();
    m.video[0].path = "/dev/video7";
    EXPECT_THAT(
        about("v4l2 device", all_needs(), m, kProblem),
        HasSubstr(
            "/dev/video42 is not there; v4l2loopback has /dev/video7 -> modprobe v4l2loopback video_nr=42 "));
    m = good_machine();
    m.video[0].openable = false;
    EXPECT_THAT(about("v4l2 device", all_needs(), m, kProblem), HasSubstr("usermod -aG video"));
    m = good_machine();
    m.video[0].takes_frames = false;
    EXPECT_THAT(about("v4l2 device", all_needs(), m, kProblem), HasSubstr("another program feeds it"));
    m = good_machine();
    m.video[0].exclusive_caps = false;
    EXPECT_THAT(about("v4l2 device", all_needs(), m, kNote), HasSubstr("exclusive_caps=1"));
    m.video[0].exclusive_caps = true;
    m.video[0].buffers = 2;
    EXPECT_THAT(about("v4l2 device", all_needs(), m, kNote), HasSubstr("max_buffers=4"));
}

TEST(Doctor, Network) {
    MachineFacts m = good_machine();
    m.interfaces[0].mtu_bytes = 1500;
    EXPECT_THAT(about("gige interface", all_needs(), m, kProblem), HasSubstr("ip link set eth1 mtu 9000"));
    m.interfaces[0].fault = "no such interface";
    EXPECT_THAT(about("gige interface", all_needs(), m, kProblem), HasSubstr("no such interface"));
    m = good_machine();
    m.interfaces[0].port_fault = "UDP 3956 is taken";
    EXPECT_THAT(about("gige port", all_needs(), m, kProblem), HasSubstr("is taken"));
    m.port_faults = {"UDP 127.0.0.1:5010 is taken"};
    EXPECT_THAT(about("port", all_needs(), m, kProblem),
                HasSubstr("is taken -> stop that program, or set commands.udp.port"));
    m.receive_buffer_bytes = 212992;
    EXPECT_THAT(about("socket buffers", all_needs(), m, kNote), HasSubstr("rmem_max=33554432"));
}

TEST(Doctor, Usb) {
    MachineFacts m = good_machine();
    m.controllers.clear();
    EXPECT_THAT(about("usb device side", all_needs(), m, kProblem), HasSubstr("Raspberry Pi"));
    EXPECT_THAT(about("usb device side", {}, m, kNote), HasSubstr("only needed for"));
    m = good_machine();
    m.root = false;
    EXPECT_THAT(about("usb device side", all_needs(), m, kProblem), HasSubstr("root"));
    BenchNeeds n = all_needs();
    n.uvc[0].udc = "dwc3";
    EXPECT_THAT(about("usb device side", n, good_machine(), kProblem),
                HasSubstr("no controller 'dwc3'; there is fe98"));
}

TEST(Doctor, ProcessorAndTime) {
    MachineFacts m = good_machine();
    m.cores = 2;
    m.governor = "powersave";
    m.root = false;
    m.realtime_priority = 0;
    m.clock_synchronised = false;
    m.tai_offset_s = 0;
    EXPECT_THAT(about("processor", {}, m, kNote), HasSubstr("four or more"));
    EXPECT_THAT(about("governor", {}, m, kNote), HasSubstr("performance"));
    EXPECT_THAT(about("real-time rights", {}, m, kNote), HasSubstr("rtprio 80"));
    BenchNeeds needs;
    needs.loop_priority = 40;
    EXPECT_THAT(about("real-time rights", needs, m, kProblem), HasSubstr("rtprio 80"));
    EXPECT_THAT(about("clock", {}, m, kNote), HasSubstr("chrony"));
    EXPECT_THAT(about("tai", {}, m, kNote), HasSubstr("ptp4l"));
}

TEST(Doctor, JsonSaysTheSame) {
    MachineFacts m = good_machine();
    m.loopback = {};
    const auto json = nlohmann::json::parse(findings_json(diagnose(all_needs(), m)));
    EXPECT_FALSE(json["ok"].get<bool>());
    int problems = 0;
    for (const auto& finding : json["findings"]) problems += finding["level"] == "problem";
    EXPECT_EQ(problems, 1);
}

}  // namespace
}  // namespace hilcam
