// A USB device that sends poses, as a dynamics simulator would: FunctionFS on this machine's (or a dummy)
// controller. Transfers are cut at random, without regard to packets; every pose must be acknowledged.
//
//   usb_pose_gadget FUNCTIONFS_MOUNT COUNT
//
// Prints "ready" once it can be bound and "acknowledged N" on its way. When the cable is pulled it waits for
// the next host and goes on behind the last pose that was acknowledged. Exit status 0: all COUNT poses were
// accepted.

#include <fcntl.h>
#include <linux/usb/functionfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "io/commands/command_dialect.h"
#include "io/commands/functionfs_descriptors.h"
#include "io/system/fd.h"

namespace hilcam {
namespace {

constexpr std::uint32_t kWindow = 64;     // poses sent and not acknowledged
constexpr std::uint32_t kProgress = 200;  // poses between two lines that say how many were acknowledged

[[noreturn]] void give_up(const char* what) {
    std::perror(what);
    std::exit(1);
}

class Gadget {
  public:
    explicit Gadget(const std::string& mount) : control_(open((mount + "/ep0").c_str(), O_RDWR)) {
        for (const auto& bytes : {functionfs_descriptors(), functionfs_strings("poses")})
            if (write(control_.get(), bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
                give_up("ep0");
        // Seen from the host: ep1 is OUT, ep2 is IN. Without O_NONBLOCK a write without a host would wait for
        // the next one, and give it the middle of what was meant for the last.
        from_host_ = Fd(open((mount + "/ep1").c_str(), O_RDWR | O_NONBLOCK));
        to_host_ = Fd(open((mount + "/ep2").c_str(), O_RDWR | O_NONBLOCK));
        if (!from_host_ || !to_host_) give_up("endpoints");
        std::thread([this] { take_events(); }).detach();
        std::thread([this] { take_answers(); }).detach();
    }

    bool send_poses(std::uint32_t count) {
        std::mt19937 random(1);
        std::uint32_t next = 0, told = 0;
        std::uint64_t pulls = pulls_;
        std::vector<std::uint8_t> bytes;
        while (acknowledged_ < count && refused_ == 0) {
            if (pulls != pulls_) {
                pulls = pulls_;
                next = acknowledged_;
                bytes.clear();
            }
            if (acknowledged_ >= told + kProgress) {
                told = acknowledged_;
                std::printf("acknowledged %u\n", told);
                std::fflush(stdout);
            }
            while (next < count && next < acknowledged_ + kWindow && bytes.size() < 4096)
                add_pose(next++, bytes);
            if (bytes.empty()) {
                usleep(100);
                continue;
            }
            const std::size_t piece = std::min<std::size_t>(bytes.size(), 1 + random() % 1500);
            if (write(to_host_.get(), bytes.data(), piece) < 0) {
                pulls_.fetch_add(1);
                usleep(50000);
            } else {
                bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(piece));
            }
        }
        std::printf("gadget: %u poses acknowledged, %u refused\n", acknowledged_.load(), refused_.load());
        return acknowledged_ >= count && refused_ == 0;
    }

  private:
    static void add_pose(std::uint32_t number, std::vector<std::uint8_t>& bytes) {
        std::array<std::uint8_t, kMaxPacketBytes> packet;
        PoseCommand pose;
        pose.motion.pose.position_world_m = {static_cast<double>(number), 0, 0};
        const std::size_t size = encode_command(pose, number, packet);
        bytes.insert(bytes.end(), packet.begin(), packet.begin() + static_cast<std::ptrdiff_t>(size));
    }
    void take_events() {
        usb_functionfs_event event;
        while (read(control_.get(), &event, sizeof event) > 0)
            if (event.type == FUNCTIONFS_DISABLE || event.type == FUNCTIONFS_UNBIND) pulls_.fetch_add(1);
    }
    void take_answers() {
        PacketStream stream(answer_rule({}));
        while (true) {
            const auto room = stream.room();
            const ssize_t got = read(from_host_.get(), room.data(), PacketStream::kReadBytes);
            if (got < 0) {
                stream.end();
                usleep(10000);
                continue;
            }
            stream.filled(static_cast<std::size_t>(got));
            for (auto item = stream.next(); item.kind != PacketStream::Item::Kind::kNothing;
                 item = stream.next()) {
                Acknowledgement a;
                if (!decode_acknowledgement(item.bytes, a)) continue;
                if (a.status != CommandStatus::kAccepted) refused_.fetch_add(1);
                acknowledged_ = std::max(acknowledged_.load(), a.sequence + 1);
            }
        }
    }

    Fd control_, from_host_, to_host_;
    std::atomic<std::uint32_t> acknowledged_{0}, refused_{0};
    std::atomic<std::uint64_t> pulls_{0};
};

}  // namespace
}  // namespace hilcam

int main(int argc, char** argv) {
    if (argc != 3) return std::fprintf(stderr, "usage: %s FUNCTIONFS_MOUNT COUNT\n", argv[0]), 2;
    hilcam::Gadget gadget(argv[1]);
    std::puts("ready");
    std::fflush(stdout);
    const bool good = gadget.send_poses(static_cast<std::uint32_t>(std::atoi(argv[2])));
    std::fflush(stdout);
    _exit(good ? 0 : 1);  // threads wait in the kernel
}
