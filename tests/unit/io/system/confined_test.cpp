#include "io/system/confined.h"

#include <gmock/gmock.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "io/system/child_watch.h"
#include "render/vocabulary/check.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr std::uint64_t kMiB = 1u << 20;

class Confined : public FilesTest {
  protected:
    ConfinedLimits limits_{64 * kMiB, 10, 5};
    std::string error_after(const std::function<void()>& work) {
        return error_of([&] { run_confined("f", limits_, {}, [&](ConfinedOutput&) { work(); }); });
    }
};

TEST_F(Confined, BringsBackWhatWasFound) {
    ConfinedResult result = run_confined("f", limits_, {}, [](ConfinedOutput& out) {
        out.value(7);
        out.text("seven");
        out.list(std::span<const float>(std::array{1.0f, 2.0f}));
    });
    EXPECT_EQ(result.value<int>(), 7);
    EXPECT_EQ(result.text(), "seven");
    EXPECT_THAT(result.list<float>(), testing::ElementsAre(1.0f, 2.0f));
    EXPECT_THAT(error_of([&] { result.value<int>(); }), StartsWith("f: does not parse"));
}

TEST_F(Confined, AListLongerThanTheResultIsNotBelieved) {
    ConfinedResult result =
        run_confined("f", limits_, {}, [](ConfinedOutput& out) { out.value(~std::uint64_t{0}); });
    EXPECT_THAT(error_of([&] { result.list<double>(); }), HasSubstr("confuses its reader"));
}

TEST_F(Confined, MessagesOfTheWorkAreThrownOn) {
    EXPECT_EQ(error_after([] { throw InputError("f: is odd"); }), "f: is odd");
    EXPECT_THROW(run_confined("f", limits_, {}, [](ConfinedOutput&) { throw DeviceError("full"); }),
                 DeviceError);
}

TEST_F(Confined, ADeathIsAMessage) {
    EXPECT_THAT(error_after([] { std::abort(); }), HasSubstr("broken in a way that ends its reader"));
    EXPECT_THAT(error_after([] { throw 3; }), HasSubstr("broken in a way that ends its reader"));
}

TEST_F(Confined, MemoryIsBoundedUntilThereIsReasonForMore) {
    const auto take = [](std::uint64_t bytes) {
        const std::unique_ptr<char[]> block(new char[bytes]);
        asm volatile("" : : "r"(block.get()) : "memory");
    };
#if !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)  // these end the program where memory ends
    EXPECT_THAT(error_after([&] { take(256 * kMiB); }), HasSubstr("asks for more memory"));
#endif
    EXPECT_EQ(error_after([&] {
                  allow_more(512 * kMiB, 1);
                  take(256 * kMiB);
              }),
              "no error");
}

TEST_F(Confined, WorkWithoutEndAndWaitingWithoutEndAreEnded) {
    limits_.cpu_s = limits_.waiting_s = 1;
    EXPECT_THAT(error_after([] {
                    for (;;) asm volatile("");
                }),
                HasSubstr("found no end"));
    EXPECT_THAT(error_after([] { pause(); }), HasSubstr("waits for something that does not come"));
}

TEST_F(Confined, TheChildDiesWithItsParent) {
    ASSERT_EQ(prctl(PR_SET_CHILD_SUBREAPER, 1), 0);  // the child's child becomes ours
    const pid_t middle = fork();
    if (middle == 0) {
        run_confined("f", limits_, {}, [&](ConfinedOutput&) { pause(); });
        _exit(0);
    }
    const std::string children =
        "/proc/" + std::to_string(middle) + "/task/" + std::to_string(middle) + "/children";
    pid_t last = 0;
    while (!(std::ifstream(children) >> last)) std::this_thread::yield();
    kill(middle, SIGKILL);
    int status = 0;
    EXPECT_EQ(waitpid(middle, &status, 0), middle);
    EXPECT_EQ(waitpid(last, &status, 0), last);
    // Where the parent was gone before the child could ask for the signal, it ends by itself.
    EXPECT_TRUE((WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) ||
                (WIFEXITED(status) && WEXITSTATUS(status) == static_cast<int>(ChildStatus::kBroken)));
    prctl(PR_SET_CHILD_SUBREAPER, 0);
}

}  // namespace
}  // namespace hilcam
