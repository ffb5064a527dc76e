// Real sockets on loopback: several clients, pieces, garbage, clients that do not read, strangers.

#include <gmock/gmock.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "io/commands/command_sender.h"
#include "io/commands/commands_tcp.h"
#include "io/commands/commands_udp.h"
#include "io/commands/commands_unix.h"
#include "io/commands/udp_peers.h"
#include "io/system/allow_list.h"
#include "render/vocabulary/check.h"
#include "tests/support/commands.h"

namespace hilcam {
namespace {

using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;
constexpr const char* kAddress = "127.0.25.1";
constexpr int kPatience_ms = 10000;  // for answers that must come; no test waits it out

// A client with blocking calls.
class Client {
  public:
    static Client tcp(std::uint16_t port) {
        Client c{Fd(socket(AF_INET, SOCK_STREAM, 0))};
        const sockaddr_in to = socket_address(parse_ipv4(kAddress, ""), port);
        EXPECT_EQ(connect(c.fd.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
        return c;
    }
    static Client unix_path(const std::string& path, int type) {
        Client c{Fd(socket(AF_UNIX, type, 0))};
        const sockaddr_un to = unix_address(path);
        EXPECT_EQ(connect(c.fd.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
        return c;
    }
    void send(const Bytes& bytes) const {
        EXPECT_EQ(::send(fd.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL),
                  static_cast<ssize_t>(bytes.size()));
    }
    // The next packet; false when the connection ends first.
    bool receive(Bytes& packet) {
        while (true) {
            const auto item = stream.next();
            if (item.kind == PacketStream::Item::Kind::kPacket) {
                packet.assign(item.bytes.begin(), item.bytes.end());
                return true;
            }
            EXPECT_EQ(item.kind, PacketStream::Item::Kind::kNothing);
            pollfd watched{fd.get(), POLLIN, 0};
            if (poll(&watched, 1, kPatience_ms) <= 0) return false;
            const auto room = stream.room();
            const ssize_t got = recv(fd.get(), room.data(), room.size(), 0);
            if (got <= 0) return false;
            stream.filled(static_cast<std::size_t>(got));
        }
    }
    Acknowledgement answer() {
        Bytes packet;
        Acknowledgement a;
        EXPECT_TRUE(receive(packet) && decode_acknowledgement(packet, a));
        return a;
    }
    bool ended() {
        Bytes packet;
        return !receive(packet);
    }

    Fd fd;
    PacketStream stream{answer_rule({})};
};

TcpCommandConfig tcp_config(std::int64_t port) {
    TcpCommandConfig c;
    c.address = kAddress;
    c.port = port;
    return c;
}
std::string error_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const std::exception& error) {
        return error.what();
    }
    return "no error";
}

TEST(CommandsTcp, SeveralClientsPiecesAndGarbage) {
    CommandRecorder recorder;
    const auto receiver = make_tcp_receiver(tcp_config(15250), recorder);
    EXPECT_EQ(receiver->name(), "tcp 127.0.25.1:15250");
    receiver->start();
    Client a = Client::tcp(15250), b = Client::tcp(15250), c = Client::tcp(15250);
    // One packet in two pieces, another client's in between, and two in one.
    const Bytes pose = encoded(some_pose(), 0);
    a.send(Bytes(pose.begin(), pose.begin() + 60));
    b.send(encoded(PingCommand{5}, 0) + encoded(PingCommand{6}, 1));
    EXPECT_EQ(b.answer().token, 5u);
    EXPECT_EQ(b.answer().token, 6u);
    a.send(Bytes(pose.begin() + 60, pose.end()));
    EXPECT_EQ(a.answer().status, CommandStatus::kAccepted);
    c.send(Bytes{1, 2, 3, 4, 5, 6, 7, 8} + encoded(PingCommand{7}, 0));
    EXPECT_NE(c.answer().status, CommandStatus::kAccepted);
    EXPECT_EQ(c.answer().token, 7u);
    EXPECT_EQ(receiver->report().clients, 3u);
    EXPECT_EQ(receiver->report().skipped_bytes, 8u);
    EXPECT_EQ(recorder.commands().size(), 4u);
    receiver->stop();
    EXPECT_TRUE(a.ended());
    // The port is free at once.
    receiver->start();
    Client again = Client::tcp(15250);
    again.send(encoded(PingCommand{8}, 0));
    EXPECT_EQ(again.answer().token, 8u);
}

// A client that asks and does not read is cut off; another's answers never wait for it.
TEST(CommandsTcp, AClientThatDoesNotReadIsCutOffAndHoldsNobodyUp) {
    CommandRecorder recorder;
    const auto receiver = make_tcp_receiver(tcp_config(15251), recorder);
    receiver->start();
    const Client deaf = Client::tcp(15251);
    Client other = Client::tcp(15251);
    Bytes burst;
    for (std::uint32_t i = 0; i < 500; ++i) burst = burst + encoded(PingCommand{i}, i);
    std::uint64_t round = 0;
    // Ends when the station has hung up: its kernel buffers and its queue are full.
    while (receiver->report().cut_off == 0 && round < 20000) {
        ::send(deaf.fd.get(), burst.data(), burst.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        other.send(encoded(PingCommand{round}, static_cast<std::uint32_t>(round)));
        ASSERT_EQ(other.answer().token, round);
        ++round;
    }
    EXPECT_EQ(receiver->report().cut_off, 1u);
    EXPECT_EQ(receiver->report().clients, 1u);
}

TEST(CommandsTcp, StrangersAndOneClientTooManyAreClosedUnheard) {
    CommandRecorder recorder;
    TcpCommandConfig config = tcp_config(15252);
    config.allow = {"10.0.0.0/8"};
    {
        const auto receiver = make_tcp_receiver(config, recorder);
        receiver->start();
        Client stranger = Client::tcp(15252);
        EXPECT_TRUE(stranger.ended());
        EXPECT_EQ(receiver->report().strangers, 1u);
    }
    config.allow = {"127.0.0.0/8"};
    config.clients = 1;
    const auto receiver = make_tcp_receiver(config, recorder);
    receiver->start();
    Client first = Client::tcp(15252);
    first.send(encoded(PingCommand{1}, 0));
    EXPECT_EQ(first.answer().token, 1u);
    Client second = Client::tcp(15252);
    EXPECT_TRUE(second.ended());
    EXPECT_EQ(recorder.commands().size(), 1u);
}

TEST(CommandsTcp, TelemetryGoesToSubscribersAndToTheReadOnlyPort) {
    CommandRecorder recorder;
    const auto commands = make_tcp_receiver(tcp_config(15253), recorder);
    const auto port = make_telemetry_port(tcp_config(15254), "telemetry");
    commands->start();
    port->start();
    Client silent = Client::tcp(15253), subscriber = Client::tcp(15253), listener = Client::tcp(15254);
    subscriber.send(encoded(SubscribeCommand{true, false}, 0));
    subscriber.answer();
    silent.send(encoded(PingCommand{1}, 0));
    silent.answer();
    listener.send(encoded(StopCommand{}, 0));  // is not listened to
    while (port->report().clients == 0) poll(nullptr, 0, 1);
    FrameReport report;
    report.frame = 12;
    HousekeepingFigures figures;
    figures.frames = 34;
    for (CommandReceiver* r : {commands.get(), port.get()}) r->notify(report), r->notify(figures);
    Bytes packet;
    Telemetry telemetry;
    ASSERT_TRUE(listener.receive(packet) && decode_telemetry(packet, telemetry));
    EXPECT_EQ(std::get<FrameReport>(telemetry).frame, 12u);
    ASSERT_TRUE(listener.receive(packet) && decode_telemetry(packet, telemetry));
    EXPECT_EQ(std::get<HousekeepingFigures>(telemetry).frames, 34u);
    ASSERT_TRUE(subscriber.receive(packet) && decode_telemetry(packet, telemetry));
    EXPECT_EQ(std::get<FrameReport>(telemetry).frame, 12u);
    subscriber.send(encoded(PingCommand{2}, 1));
    EXPECT_EQ(subscriber.answer().token, 2u);  // and nothing of housekeeping before it
    silent.send(encoded(PingCommand{3}, 1));
    EXPECT_EQ(silent.answer().token, 3u);
    EXPECT_EQ(recorder.commands().size(), 4u);
    EXPECT_EQ(port->report().received, 0u);
}

TEST(CommandsTcp, BusyPortSaysWhichAndWhatToDo) {
    const Fd taken = listen_tcp(parse_ipv4(kAddress, ""), 15255);
    CommandRecorder recorder;
    const auto receiver = make_tcp_receiver(tcp_config(15255), recorder);
    EXPECT_THAT(error_of([&] { receiver->start(); }),
                HasSubstr("TCP 127.0.25.1:15255 is taken by another program; stop it (ss -tlpn"));
}

class CommandsUnix : public testing::TestWithParam<UnixCommandConfig::Type> {
  protected:
    std::string path = "commands_test_" + std::to_string(getpid()) + ".sock";
    int type = GetParam() == UnixCommandConfig::Type::kStream ? SOCK_STREAM : SOCK_SEQPACKET;
    CommandRecorder recorder;
    std::unique_ptr<CommandReceiver> make() {
        UnixCommandConfig config;
        config.path = path;
        config.type = GetParam();
        return make_unix_receiver(config, recorder);
    }
    ~CommandsUnix() override { unlink(path.c_str()); }
};

TEST_P(CommandsUnix, AnswersAndTakesItsFileAway) {
    const auto receiver = make();
    receiver->start();
    Client a = Client::unix_path(path, type), b = Client::unix_path(path, type);
    a.send(encoded(PingCommand{1}, 0) + encoded(PingCommand{2}, 1));
    b.send(encoded(PingCommand{3}, 0));
    EXPECT_EQ(a.answer().token, 1u);
    EXPECT_EQ(a.answer().token, 2u);
    EXPECT_EQ(b.answer().token, 3u);
    EXPECT_THAT(receiver->senders().at(0).name, HasSubstr("process " + std::to_string(getpid())));
    receiver->stop();
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_P(CommandsUnix, AStaleFileIsReplacedALiveOneAndAnotherKindAreNot) {
    {
        const Fd dead(socket(AF_UNIX, type, 0));
        const sockaddr_un where = unix_address(path);
        ASSERT_EQ(bind(dead.get(), reinterpret_cast<const sockaddr*>(&where), sizeof where), 0);
    }
    ASSERT_TRUE(std::filesystem::exists(path));
    const auto receiver = make(), second = make();
    receiver->start();
    EXPECT_THAT(error_of([&] { second->start(); }), HasSubstr("is taken by another program"));
    Client a = Client::unix_path(path, type);
    a.send(encoded(PingCommand{1}, 0));
    EXPECT_EQ(a.answer().token, 1u);
    receiver->stop();
    std::ofstream(path) << "a letter";
    EXPECT_THAT(error_of([&] { second->start(); }), HasSubstr("or is some other file"));
    EXPECT_TRUE(std::filesystem::exists(path));
}

// Whatever the mask of the shell that started it: nobody but its owner and group may write, to send.
TEST_P(CommandsUnix, ItsFileIsForOwnerAndGroup) {
    for (const mode_t mask : {0077u, 0u}) {
        const mode_t before = umask(mask);
        const auto receiver = make();
        receiver->start();
        struct stat file {};
        EXPECT_EQ(lstat(path.c_str(), &file), 0);
        EXPECT_TRUE(S_ISSOCK(file.st_mode));
        EXPECT_EQ(file.st_mode & 0777u, 0660u) << "mask " << mask;
        umask(before);
    }
}

// The kernel holds what a client of a Unix socket has not read, and says how much. All that waits beyond it
// is in hilcam's own queue.
TEST_P(CommandsUnix, TelemetryEndsAtHalfOfAQueueAndAnswersAtAll) {
    constexpr std::size_t kTelemetryBytes = 128 * 1024, kAllBytes = 256 * 1024, kReportBytes = 88,
                          kAnswerBytes = 34;
    const auto receiver = make();
    receiver->start();
    Client deaf = Client::unix_path(path, type), other = Client::unix_path(path, type);
    for (Client* client : {&deaf, &other}) {
        client->send(encoded(SubscribeCommand{true, false}, 0));
        client->answer();
    }
    // The other reads each report, so that the station has dealt with it.
    const auto told = [&](std::uint64_t first, std::uint64_t count) {
        for (std::uint64_t id = first; id < first + count; ++id) {
            FrameReport report;
            report.frame = id;
            receiver->notify(report);
            Bytes packet;
            Telemetry telemetry;
            if (!other.receive(packet) || !decode_telemetry(packet, telemetry) ||
                std::get<FrameReport>(telemetry).frame != id)
                return false;
        }
        return true;
    };
    constexpr std::uint64_t kReports = 6000;  // half a megabyte
    ASSERT_TRUE(told(1, kReports));
    EXPECT_EQ(receiver->report().clients, 2u) << "who only misses telemetry stays";
    std::uint64_t pings = 0;
    const auto ping = [&](std::size_t count) {
        const std::uint64_t received = receiver->report().received;
        for (std::size_t i = 0; i < count; ++i, ++pings) {
            const Bytes packet = encoded(PingCommand{pings}, static_cast<std::uint32_t>(pings + 1));
            ::send(deaf.fd.get(), packet.data(), packet.size(), MSG_NOSIGNAL);  // may be cut off meanwhile
        }
        while (receiver->report().received < received + count && receiver->report().cut_off == 0)
            poll(nullptr, 0, 1);
    };
    // Answers have the other half.
    ping((kAllBytes - kTelemetryBytes - kReportBytes) / kAnswerBytes - 1);
    EXPECT_EQ(receiver->report().clients, 2u);
    // What the kernel holds: of a stream FIONREAD says it; of messages it says the size of the next one.
    int in_kernel = 0;
    ASSERT_EQ(ioctl(deaf.fd.get(), FIONREAD, &in_kernel), 0);
    std::uint64_t reports = 0, answers = 0;
    Bytes packet;
    while (answers < pings && deaf.receive(packet)) {
        Telemetry telemetry;
        decode_telemetry(packet, telemetry) ? ++reports : ++answers;
    }
    EXPECT_EQ(answers, pings);
    EXPECT_LT(reports, kReports);
    if (type == SOCK_STREAM) {
        const std::size_t queued = reports * kReportBytes - static_cast<std::size_t>(in_kernel);
        EXPECT_GE(queued, kTelemetryBytes);
        EXPECT_LT(queued, kTelemetryBytes + kReportBytes);
    }
    // And they come again once it reads.
    ASSERT_TRUE(told(kReports + 1, 1));
    Telemetry telemetry;
    ASSERT_TRUE(deaf.receive(packet) && decode_telemetry(packet, telemetry));
    EXPECT_EQ(std::get<FrameReport>(telemetry).frame, kReports + 1);
    // Without a reader again: half of the queue for telemetry and more than the rest for answers.
    ASSERT_TRUE(told(kReports + 2, kReports));
    ping((kAllBytes - kTelemetryBytes) / kAnswerBytes + 1);
    EXPECT_EQ(receiver->report().cut_off, 1u);
}

INSTANTIATE_TEST_SUITE_P(Types, CommandsUnix,
                         testing::Values(UnixCommandConfig::Type::kStream,
                                         UnixCommandConfig::Type::kSeqpacket));

TEST(CommandsUdp, StrangersGetNoAnswerAndAreCounted) {
    CommandRecorder recorder;
    UdpCommandConfig config;
    config.address = kAddress;
    config.port = 15256;
    config.allow = {"127.0.25.7"};
    UdpCommandReceiver receiver(config, recorder);
    receiver.start();
    const Fd stranger = open_udp(parse_ipv4("127.0.25.6", ""), 0),
             friendly = open_udp(parse_ipv4("127.0.25.7", ""), 0);
    const sockaddr_in to = socket_address(parse_ipv4(kAddress, ""), 15256);
    const Bytes ping = encoded(PingCommand{4}, 0);
    for (const Fd* fd : {&stranger, &friendly})
        sendto(fd->get(), ping.data(), ping.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
    std::array<std::uint8_t, 256> answer;
    ASSERT_GT(recv(friendly.get(), answer.data(), answer.size(), 0), 0);
    // The stranger's came first: had it been answered, the answer would be there.
    EXPECT_LT(recv(stranger.get(), answer.data(), answer.size(), MSG_DONTWAIT), 0);
    EXPECT_EQ(receiver.report().strangers, 1u);
    EXPECT_EQ(recorder.commands().size(), 1u);
}

TEST(CommandsUdp, TelemetryGoesToASubscriber) {
    CommandRecorder recorder;
    UdpCommandConfig config;
    config.address = kAddress;
    config.port = 15257;
    UdpCommandReceiver receiver(config, recorder);
    receiver.start();
    const Fd fd = open_udp(parse_ipv4(kAddress, ""), 0);
    const sockaddr_in to = socket_address(parse_ipv4(kAddress, ""), 15257);
    const Bytes subscribe = encoded(SubscribeCommand{false, true}, 0);
    sendto(fd.get(), subscribe.data(), subscribe.size(), 0, reinterpret_cast<const sockaddr*>(&to),
           sizeof to);
    std::array<std::uint8_t, 256> bytes;
    ASSERT_GT(recv(fd.get(), bytes.data(), bytes.size(), 0), 0);
    receiver.notify(FrameReport{});
    HousekeepingFigures figures;
    figures.frames = 99;
    receiver.notify(figures);
    const ssize_t got = recv(fd.get(), bytes.data(), bytes.size(), 0);
    Telemetry telemetry;
    ASSERT_TRUE(decode_telemetry(std::span(bytes).first(static_cast<std::size_t>(got)), telemetry));
    EXPECT_EQ(std::get<HousekeepingFigures>(telemetry).frames, 99u);
}

// --- senders by UDP are known by their addresses

struct UdpPeersTest : testing::Test {
    static constexpr std::int64_t kSecond_ns = 1'000'000'000;
    CommandRecorder recorder;
    CommandStation station{recorder, {}};
    UdpPeers peers{station};

    static sockaddr_in sender(std::uint16_t port) { return socket_address(parse_ipv4(kAddress, ""), port); }
    std::vector<std::string> names() const {
        std::vector<std::string> out;
        for (const SenderReport& report : station.senders()) out.push_back(report.name);
        return out;
    }
};

TEST_F(UdpPeersTest, EachIsForgottenAMinuteAfterItsLastPacket) {
    peers.at(sender(1), 0);
    peers.at(sender(2), 0);
    peers.at(sender(2), 30 * kSecond_ns);
    peers.forget_silent(60 * kSecond_ns);
    EXPECT_THAT(names(), testing::ElementsAre("127.0.25.1:1", "127.0.25.1:2"));
    peers.forget_silent(60 * kSecond_ns + 1);
    EXPECT_THAT(names(), testing::ElementsAre("127.0.25.1:2"));
    peers.forget_silent(90 * kSecond_ns);
    EXPECT_THAT(names(), testing::ElementsAre("127.0.25.1:2"));
    // Another's packet is an occasion to forget, too.
    CommandStation::Sender& third = peers.at(sender(3), 90 * kSecond_ns + 1);
    EXPECT_THAT(names(), testing::ElementsAre("127.0.25.1:3"));
    ASSERT_NE(peers.address_of(third), nullptr);
    EXPECT_EQ(ntohs(peers.address_of(third)->sin_port), 3);
}

TEST_F(UdpPeersTest, ASeventeenthTakesThePlaceOfTheOneThatWasSilentForLongest) {
    for (std::uint16_t port = 1; port <= 16; ++port) peers.at(sender(port), port);
    EXPECT_EQ(names().size(), 16u);
    const CommandStation::Sender* const first = &peers.at(sender(1), 17);  // speaks again
    peers.at(sender(17), 18);
    EXPECT_EQ(names().size(), 16u);
    EXPECT_THAT(names(), testing::Contains("127.0.25.1:1"));
    EXPECT_THAT(names(), testing::Not(testing::Contains("127.0.25.1:2")));
    EXPECT_EQ(&peers.at(sender(1), 19), first);
}

TEST_F(UdpPeersTest, WhoIsForgottenHasNoSubscription) {
    station.subscribe(peers.at(sender(1), 0), {true, true});
    int told = 0;
    const CommandStation::Notify notify = [&](CommandStation::Sender&, std::span<const std::uint8_t>) {
        ++told;
    };
    station.notify(FrameReport{}, notify);
    EXPECT_EQ(told, 1);
    peers.at(sender(1), 61 * kSecond_ns);  // is another sender now
    station.notify(FrameReport{}, notify);
    EXPECT_EQ(told, 1);
}

// What `hilcam send` does over each of them; a telemetry packet before an answer is kept.
TEST(CommandSender, TalksOverEveryTransportAndDialect) {
    const std::string path = "command_sender_" + std::to_string(getpid()) + ".sock";
    for (const Dialect dialect : {Dialect::kHilcam, Dialect::kCfs}) {
        CommandRecorder recorder;
        UdpCommandConfig udp;
        udp.address = kAddress, udp.port = 15258, udp.dialect.dialect = dialect;
        TcpCommandConfig tcp = tcp_config(15258);
        tcp.dialect.dialect = dialect;
        UnixCommandConfig unix_socket;
        unix_socket.path = path, unix_socket.dialect.dialect = dialect;
        unix_socket.type = UnixCommandConfig::Type::kSeqpacket;
        UdpCommandReceiver udp_receiver(udp, recorder);
        const auto tcp_receiver = make_tcp_receiver(tcp, recorder),
                   unix_receiver = make_unix_receiver(unix_socket, recorder);
        const std::pair<CommandReceiver*, std::string> transports[] = {
            {&udp_receiver, "udp:127.0.25.1:15258"},
            {&udp_receiver, "127.0.25.1:15258"},
            {tcp_receiver.get(), "tcp:127.0.25.1:15258"},
            {unix_receiver.get(), "unix:" + path}};
        for (CommandReceiver* r :
             {static_cast<CommandReceiver*>(&udp_receiver), tcp_receiver.get(), unix_receiver.get()})
            r->start();
        for (const auto& [receiver, endpoint] : transports) {
            CommandSender sender(endpoint, {dialect});
            EXPECT_EQ(sender.send(SubscribeCommand{true, true}, kPatience_ms).status,
                      CommandStatus::kAccepted);
            FrameReport report;
            report.frame = 5;
            receiver->notify(report);
            EXPECT_EQ(sender.send(PingCommand{77}, kPatience_ms).token, 77u) << endpoint;
            Telemetry telemetry;
            ASSERT_TRUE(sender.receive(telemetry, kPatience_ms)) << endpoint;
            EXPECT_EQ(std::get<FrameReport>(telemetry).frame, 5u);
            sender.send(SubscribeCommand{}, kPatience_ms);
        }
    }
    EXPECT_THAT(error_of([] { CommandSender("tcp:127.0.25.1:15259"); }), HasSubstr("is 'hilcam run' up"));
    EXPECT_THAT(error_of([&] { CommandSender("unix:" + path); }), HasSubstr("is 'hilcam run' up"));
    EXPECT_THROW(CommandSender("usb:nonsense"), InputError);
}

TEST(AllowList, NetworksAnyAndWhatIsRefused) {
    const auto ip = [](const char* text) { return parse_ipv4(text, ""); };
    const AllowList list({"10.0.0.0/8", "192.168.1.7"}, "0.0.0.0", "commands.udp");
    EXPECT_TRUE(list.allows(ip("10.255.3.4")));
    EXPECT_TRUE(list.allows(ip("192.168.1.7")));
    EXPECT_FALSE(list.allows(ip("192.168.1.8")));
    EXPECT_FALSE(list.allows(ip("127.0.0.1")));
    EXPECT_TRUE(AllowList({"any"}, "0.0.0.0", "k").allows(ip("8.8.8.8")));
    EXPECT_TRUE(AllowList({}, "127.0.0.1", "k").allows(ip("127.0.0.1")));
    EXPECT_TRUE(AllowList({"0.0.0.0/0"}, "0.0.0.0", "k").allows(ip("8.8.8.8")));
    const auto refused = [](std::vector<std::string> entries, const std::string& address) {
        return error_of([&] { AllowList(entries, address, "commands.udp"); });
    };
    EXPECT_THAT(refused({}, "0.0.0.0"),
                HasSubstr("commands.udp.address: found '0.0.0.0', which others can reach"));
    EXPECT_THAT(refused({"10.0.0.1/8"}, "0.0.0.0"), HasSubstr("its network is 10.0.0.0/8"));
    EXPECT_THAT(refused({"10.0.0.0/33"}, "0.0.0.0"), HasSubstr("accepted: an IPv4 address, a network"));
    EXPECT_THAT(refused({"all"}, "0.0.0.0"), HasSubstr("commands.udp.allow: found 'all'"));
}

}  // namespace
}  // namespace hilcam
