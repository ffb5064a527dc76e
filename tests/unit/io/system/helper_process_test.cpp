#include "io/system/helper_process.h"

#include <gmock/gmock.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <csignal>

#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

class HelperProcessTest : public FilesTest {
  protected:
    std::filesystem::path program(const std::string& text) {
        const std::filesystem::path file = write("helper", text);
        chmod(file.c_str(), 0700);
        return file;
    }
    static std::filesystem::path python() { return "/usr/bin/python3"; }
    std::filesystem::path script(const std::string& text) {
        return program(
            "#!" + python().string() +
            "\nimport mmap, os, signal, socket, time\ns = socket.socket(fileno=3)\nm = mmap.mmap(4, 0)\n" +
            text);
    }
    // Asks with the byte 'q'.
    static std::string ask(HelperProcess& helper, std::uint8_t& answer,
                           HelperProcess::Limits limits = {10, 5}) {
        const std::uint8_t request = 'q';
        return helper.ask({&request, 1}, {&answer, 1}, limits);
    }
};

TEST_F(HelperProcessTest, AnswersComeByTheSocketAndByTheMemory) {
    HelperProcess helper(script("while q := s.recv(1):\n  m[5:6] = q\n  s.send(b'a')\n"), 4096);
    std::uint8_t answer = 0;
    for (int i = 0; i < 3; ++i) {
        helper.memory()[5] = 0;
        EXPECT_EQ(ask(helper, answer), "");
        EXPECT_EQ(answer, 'a');
        EXPECT_EQ(helper.memory()[5], 'q');
    }
}

// A helper that shrinks the memory would end whoever looks into it.
TEST_F(HelperProcessTest, TheMemoryKeepsItsSize) {
    HelperProcess helper(script("s.recv(1)\ntry:\n  os.ftruncate(4, 1)\n  s.send(b'y')\nexcept OSError:\n  "
                                "s.send(b'n')\ns.recv(1)\n"),
                         4096);
    std::uint8_t answer = 0;
    EXPECT_EQ(ask(helper, answer), "");
    EXPECT_EQ(answer, 'n');
    EXPECT_EQ(helper.memory()[4095], 0);
}

TEST_F(HelperProcessTest, ItHasItsTwoDescriptorsAndNoTerminal) {
    HelperProcess helper(
        script("q = s.recv(1)\nopen_ones = sorted(int(n) for n in os.listdir('/proc/self/fd'))\n"
               "good = open_ones[:5] == [0, 1, 2, 3, 4] and all(os.readlink(f'/proc/self/fd/{n}') == "
               "'/dev/null' for n in (0, 1, 2))\n"
               "s.send(b'y' if good else b'n')\n"),
        4096);
    std::uint8_t answer = 0;
    EXPECT_EQ(ask(helper, answer), "");
    EXPECT_EQ(answer, 'y');
}

TEST_F(HelperProcessTest, AnEndAMutteringAndALongAnswerAreReasons) {
    std::uint8_t answer = 0;
    HelperProcess dead(script("s.recv(1)\nos.kill(os.getpid(), signal.SIGSEGV)\n"), 4096);
    EXPECT_THAT(ask(dead, answer), HasSubstr("ends its reader"));
    HelperProcess hungry(script("s.recv(1)\nos._exit(101)\n"), 4096);
    EXPECT_THAT(ask(hungry, answer), HasSubstr("asks for more memory"));
    HelperProcess muttering(script("s.recv(1)\ns.send(b'')\ntime.sleep(60)\n"), 4096);
    EXPECT_THAT(ask(muttering, answer), HasSubstr("ends its reader"));
    HelperProcess talkative(script("s.recv(1)\ns.send(b'abc')\ntime.sleep(60)\n"), 4096);
    EXPECT_THAT(ask(talkative, answer), HasSubstr("ends its reader"));
}

TEST_F(HelperProcessTest, WorkWithoutEndAndWaitingWithoutEndAreEnded) {
    std::uint8_t answer = 0;
    HelperProcess busy(script("s.recv(1)\nwhile True: pass\n"), 4096);
    EXPECT_THAT(ask(busy, answer, {1, 30}), HasSubstr("found no end"));
    HelperProcess idle(script("s.recv(1)\ntime.sleep(600)\n"), 4096);
    EXPECT_THAT(ask(idle, answer, {10, 1}), HasSubstr("waits for something that does not come"));
}

TEST_F(HelperProcessTest, WhatCannotBeStartedIsSaid) {
    EXPECT_THROW(HelperProcess(folder_ / "nothing", 4096), DeviceError);
}

}  // namespace
}  // namespace hilcam
