// The receiver of commands over USB (io/commands/commands_usb.h) with a handler that checks their order.
//
//   usb_receiver VENDOR:PRODUCT COUNT SECONDS
//
// Exit status 0: poses 0 to COUNT - 1 came, none out of order. One that comes again after the cable was
// pulled is not: its acknowledgement was lost with the connection.

#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>

#include "io/commands/commands_usb.h"

namespace {

class OrderCheck : public hilcam::CommandHandler {
  public:
    hilcam::CommandStatus handle(const hilcam::Command& command,
                                 const hilcam::CommandSource& source) override {
        const std::uint32_t sequence = source.sequence;
        const auto& pose = std::get<hilcam::PoseCommand>(command);
        const auto number = static_cast<std::uint32_t>(pose.motion.pose.position_world_m.x);
        if (number != sequence || sequence > next) ++wrong;
        if (sequence < next) ++again;
        if (sequence == next) ++next;
        return hilcam::CommandStatus::kAccepted;
    }
    hilcam::TimeTai now() const override { return {}; }
    std::atomic<std::uint32_t> next{0}, wrong{0}, again{0};
};

}  // namespace

int main(int argc, char** argv) {
    if (argc != 4) return std::fprintf(stderr, "usage: %s VENDOR:PRODUCT COUNT SECONDS\n", argv[0]), 2;
    const auto count = static_cast<std::uint32_t>(std::atoi(argv[2]));
    OrderCheck check;
    hilcam::FaultBoard faults;
    hilcam::UsbCommandConfig config;
    config.device = argv[1];
    const auto receiver = hilcam::make_usb_receiver(config, check, faults);
    receiver->start();
    for (int tenth = 0; tenth < 10 * std::atoi(argv[3]) && check.next < count; ++tenth) usleep(100000);
    usleep(200000);  // the last answers
    const std::string trouble = receiver->trouble();
    receiver->stop();
    const hilcam::CommandReport r = receiver->report();
    std::printf("host: %u poses in order, %u wrong, %u again after a pull\n", check.next.load(),
                check.wrong.load(), check.again.load());
    std::printf("host: %llu received, %llu refused, %llu lost, %llu bytes skipped %s\n",
                static_cast<unsigned long long>(r.received), static_cast<unsigned long long>(r.refused),
                static_cast<unsigned long long>(r.lost), static_cast<unsigned long long>(r.skipped_bytes),
                trouble.c_str());
    return check.next == count && check.wrong == 0 ? 0 : 1;
}
