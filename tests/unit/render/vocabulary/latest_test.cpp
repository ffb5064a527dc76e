#include <gtest/gtest.h>

#include <thread>

#include "render/vocabulary/latest.h"

namespace hilcam {
namespace {

TEST(Latest, ReaderSeesWholeValuesThatNeverGoBack) {
    struct Pair {
        std::uint64_t a = 0, b = 0;
    };
    Latest<Pair> latest;
    constexpr std::uint64_t kLast = 200000;
    std::thread writer([&] {
        for (std::uint64_t i = 1; i <= kLast; ++i) latest.write({i, ~i});
    });
    std::uint64_t before = 0;
    while (before < kLast) {
        const Pair seen = latest.read();
        ASSERT_TRUE(seen.b == ~seen.a || seen.a == 0);
        ASSERT_GE(seen.a, before);
        before = seen.a;
    }
    writer.join();
}

}  // namespace
}  // namespace hilcam
