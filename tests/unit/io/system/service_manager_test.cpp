// The datagram that sd_notify(3) describes, heard by a socket of our own.

#include "io/system/service_manager.h"

#include <sys/socket.h>
#include <sys/un.h>

#include <cstdlib>

#include "io/system/fd.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using ServiceManager = FilesTest;

Fd listen_at(const std::string& path) {
    Fd fd(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    sockaddr_un at{};
    at.sun_family = AF_UNIX;
    path.copy(at.sun_path, sizeof at.sun_path);
    EXPECT_EQ(bind(fd.get(), reinterpret_cast<const sockaddr*>(&at),
                   static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path.size())),
              0);
    return fd;
}

std::string heard(const Fd& fd) {
    char text[64];
    const ssize_t size = recv(fd.get(), text, sizeof text, 0);
    return size < 0 ? "" : std::string(text, static_cast<std::size_t>(size));
}

TEST_F(ServiceManager, IsToldAtAPathAndAtAnAbstractName) {
    const std::string path = (folder_ / "notify").string();
    const Fd at_path = listen_at(path);
    setenv("NOTIFY_SOCKET", path.c_str(), 1);
    EXPECT_TRUE(notify_service_manager("READY=1"));
    EXPECT_EQ(heard(at_path), "READY=1");

    const Fd abstract = listen_at(std::string(1, '\0') + path);
    setenv("NOTIFY_SOCKET", ("@" + path).c_str(), 1);
    EXPECT_TRUE(notify_service_manager("STOPPING=1"));
    EXPECT_EQ(heard(abstract), "STOPPING=1");
    EXPECT_EQ(heard(at_path), "");
    unsetenv("NOTIFY_SOCKET");
}

TEST_F(ServiceManager, NobodyThereIsNoFailure) {
    unsetenv("NOTIFY_SOCKET");
    EXPECT_FALSE(notify_service_manager("READY=1"));
    for (const std::string& bad : {std::string(), std::string("/"), std::string("relative"),
                                   "/" + std::string(200, 'a'), (folder_ / "nobody").string()}) {
        setenv("NOTIFY_SOCKET", bad.c_str(), 1);
        EXPECT_FALSE(notify_service_manager("READY=1")) << bad;
    }
    unsetenv("NOTIFY_SOCKET");
}

}  // namespace
}  // namespace hilcam
