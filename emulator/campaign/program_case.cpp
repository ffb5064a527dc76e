#include "emulator/campaign/program_case.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <map>

#include "emulator/campaign/case_camera.h"
#include "emulator/campaign/end_request.h"
#include "emulator/scenario/app_config.h"
#include "io/system/fd.h"
#include "io/system/input_file.h"
#include "io/system/plain_words.h"
#include "io/system/program_files.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/stopwatch.h"

namespace hilcam {
namespace {

using Words = std::map<std::string, std::string>;

std::uint16_t free_port(int kind) {
    const Fd probe(socket(AF_INET, kind | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    if (!probe || bind(probe.get(), any, sizeof address) != 0 || getsockname(probe.get(), any, &size) != 0)
        throw DeviceError(std::string("no free port of 127.0.0.1: ") + std::strerror(errno));
    return ntohs(address.sin_port);
}

std::string with_words(std::string text, const Words& words) {
    for (const auto& [word, value] : words)
        for (std::size_t at = 0; (at = text.find("{" + word + "}", at)) != std::string::npos;
             at += value.size())
            text.replace(at, word.size() + 2, value);
    return text;
}

std::string environment_name(const std::string& word) {
    std::string name = "HILCAM_" + word;
    std::transform(name.begin(), name.end(), name.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    return name;
}

// A program with its children, in a process group that this object ends.
class Started {
  public:
    Started(const std::vector<std::string>& arguments, const std::filesystem::path& log, const Words& words) {
        const pid_t parent = getpid();
        process_ = fork();
        if (process_ < 0) throw DeviceError(std::string("no process can be made: ") + std::strerror(errno));
        if (process_ == 0) be_program(arguments, log, words, parent);
        setpgid(process_, process_);
    }
    ~Started() {
        kill(-process_, SIGKILL);
        if (!ended_) wait_for(true);
    }
    Started(const Started&) = delete;
    Started& operator=(const Started&) = delete;

    // True once the program has ended and its status is known.
    bool has_ended() { return ended_ || wait_for(false); }
    void ask_to_end() const { kill(process_, SIGTERM); }
    // True when a signal from outside ended it, perhaps for lack of memory.
    bool was_ended() const {
        return WIFSIGNALED(status_) && (WTERMSIG(status_) == SIGKILL || WTERMSIG(status_) == SIGTERM ||
                                        WTERMSIG(status_) == SIGINT || WTERMSIG(status_) == SIGHUP);
    }
    bool has_status(int status) const { return WIFEXITED(status_) && WEXITSTATUS(status_) == status; }
    // Returns what went wrong; empty: nothing.
    std::string problem(const std::string& name) const {
        if (WIFSIGNALED(status_))
            return name + " was ended by signal " + std::to_string(WTERMSIG(status_)) + " (" +
                   strsignal(WTERMSIG(status_)) + ")";
        if (WEXITSTATUS(status_) == kNotStarted) return name + " cannot be started (see its log)";
        return WEXITSTATUS(status_) == 0
                   ? std::string()
                   : name + " ended with status " + std::to_string(WEXITSTATUS(status_));
    }

  private:
    static constexpr int kNotStarted = 127;
    pid_t process_ = -1;
    int status_ = 0;
    bool ended_ = false;

    bool wait_for(bool block) {
        pid_t found = 0;
        while ((found = waitpid(process_, &status_, block ? 0 : WNOHANG)) < 0 && errno == EINTR) {
        }
        return ended_ = found == process_;
    }
    [[noreturn]] static void be_program(const std::vector<std::string>& arguments,
                                        const std::filesystem::path& log, const Words& words, pid_t parent) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (getppid() != parent) _exit(kNotStarted);
        setpgid(0, 0);
        const int out = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
        const int nothing = open("/dev/null", O_RDONLY);
        dup2(nothing, STDIN_FILENO), dup2(out, STDOUT_FILENO), dup2(out, STDERR_FILENO);
        for (const auto& [word, value] : words) setenv(environment_name(word).c_str(), value.c_str(), 1);
        std::vector<char*> argv;
        argv.reserve(arguments.size() + 1);
        for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
        argv.push_back(nullptr);
        execvp(argv[0], argv.data());
        std::fprintf(stderr, "%s: %s\n", argv[0], std::strerror(errno));
        _exit(kNotStarted);
    }
};

void pause_shortly() {
    const timespec pause{0, 10'000'000};
    nanosleep(&pause, nullptr);
}

std::string text_of_log(const std::filesystem::path& file) {
    try {
        return read_input_file(file, {64u << 20, "a log"});
    } catch (const InputError&) {
        return {};
    }
}

// Returns the last line of a log that gives a reason.
std::string last_error(const std::filesystem::path& log) {
    std::string last;
    const std::string text = text_of_log(log);
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        if (end > at) last = text.substr(at, end - at);
        at = end + 1;
    }
    return last.empty() ? "" : ": " + shortened(last);
}

void read_results(const std::filesystem::path& file, CaseRecord& record) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return;
    try {
        const auto json =
            nlohmann::ordered_json::parse(read_input_file(file, {1u << 20, "a result: numbers by name"}));
        if (!json.is_object()) throw InputError("no object");
        for (const auto& [name, value] : json.items()) {
            if (!value.is_number() && !value.is_boolean())
                throw InputError(name + ": found " + value.dump() + "; accepted: a number");
            record.figures["result." + name] = value;
        }
    } catch (const std::exception& problem) {
        throw InputError("result.json: " + plain_words(problem));
    }
}

class BenchRun {
  public:
    BenchRun(const CampaignConfig& campaign, const CasePlan& plan, const std::filesystem::path& folder,
             std::size_t slot)
        : campaign_(campaign), folder_(folder) {
        words_ = {{"case", plan.name},
                  {"seed", std::to_string(plan.seed)},
                  {"slot", std::to_string(slot + 1)},
                  {"case_folder", folder.string()}};
        // Results for shapes that no other case has are not cached.
        if (draws_own_shapes(campaign)) words_["cache_mb"] = "0";
        std::vector<std::string> overrides = plan.overrides;
        for (const std::string& own : campaign.run->set) set_override(overrides, with_words(own, words_));
        const ScenarioConfig scenario = load_scenario(campaign.scenario, overrides);
        const auto listen = [&](bool is_there, const char* word, const char* key, int kind) {
            words_[word] = is_there ? std::to_string(free_port(kind)) : "";
            if (is_there) set_override(overrides, key, words_[word]);
        };
        listen(scenario.commands.has_udp, "udp_port", "commands.udp.port", SOCK_DGRAM);
        listen(scenario.commands.has_tcp, "tcp_port", "commands.tcp.port", SOCK_STREAM);
        arguments_ = {own_program().string(), "run", campaign.scenario.string(), "--report",
                      (folder / "report.json").string()};
        for (const std::string& override : overrides)
            arguments_.insert(arguments_.end(), {"--set", override});
        if (campaign.run->frames > 0)
            arguments_.insert(arguments_.end(), {"--frames", std::to_string(campaign.run->frames)});
        if (campaign.run->duration_s > 0)
            arguments_.insert(arguments_.end(), {"--duration", exact_number(campaign.run->duration_s)});
    }

    // Throws CaseFailure when the case went wrong, DeviceError when the machine is the cause.
    void carry_out() {
        Started camera(arguments_, folder_ / "hilcam.log", words_);
        await_camera(camera);
        if (campaign_.run->program.empty()) {
            while (!camera.has_ended()) wait_within_limit("the run");
        } else {
            run_program(camera);
        }
        require_good_end(camera);
    }

  private:
    const CampaignConfig& campaign_;
    const std::filesystem::path folder_;
    Words words_;
    std::vector<std::string> arguments_;
    Stopwatch watch_;

    // The parent ends this child at the same limit, but this process knows what was late.
    void wait_within_limit(const char* what) const {
        if (EndRequest::has_come()) throw DeviceError("interrupted");
        if (watch_.seconds() > 0.95 * campaign_.time_limit_s)
            throw CaseFailure(std::string(what) + " took longer than " +
                              std::to_string(static_cast<long>(campaign_.time_limit_s)) +
                              " s (time_limit_s)");
        pause_shortly();
    }

    void await_camera(Started& camera) const {
        while (text_of_log(folder_ / "hilcam.log").find("running;") == std::string::npos &&
               !camera.has_ended())
            wait_within_limit("the start of the camera");
        if (camera.has_ended()) require_good_end(camera);
    }

    // A camera that fails at run time (status 1) lacked something of the machine: a port, a device, disk
    // space.
    void require_good_end(const Started& camera) const {
        constexpr int kFailedAtRunTime = 1;
        require_good_end(camera, "hilcam run", "hilcam.log", camera.has_status(kFailedAtRunTime));
    }
    void require_good_end(const Started& one, const std::string& name, const char* log,
                          bool is_machines) const {
        std::string problem = one.problem(name);
        if (problem.empty()) return;
        problem += last_error(folder_ / log);
        if (is_machines || one.was_ended() || is_disk_full()) throw DeviceError(problem);
        throw CaseFailure(problem);
    }
    bool is_disk_full() const {
        constexpr std::uintmax_t kMin_bytes = 1 << 16;
        std::error_code error;
        const std::filesystem::space_info room = std::filesystem::space(folder_, error);
        return !error && room.available < kMin_bytes;
    }

    void run_program(Started& camera) {
        std::vector<std::string> arguments = campaign_.run->program;
        for (std::string& argument : arguments) argument = with_words(argument, words_);
        Started program(arguments, folder_ / "program.log", words_);
        while (!program.has_ended()) wait_within_limit("the program");
        require_good_end(program, "the program", "program.log", false);
        // The program has ended, so the camera need not wait any more.
        if (!camera.has_ended()) camera.ask_to_end();
        while (!camera.has_ended()) wait_within_limit("the end of the camera");
    }
};

}  // namespace

CaseRecord make_program_case(const CampaignConfig& campaign, const CasePlan& plan,
                             const std::filesystem::path& folder, std::size_t slot) {
    const std::filesystem::path own = std::filesystem::absolute(folder / "runs" / plan.name);
    std::error_code error;
    // Removes what an earlier attempt left.
    std::filesystem::remove_all(own, error);
    std::filesystem::create_directories(own, error);
    if (error) throw DeviceError(own.string() + " cannot be made: " + error.message());
    CaseRecord record;
    record.plan = plan;
    BenchRun(campaign, plan, own, slot).carry_out();
    read_results(own / "result.json", record);
    record.done = true;
    return record;
}

}  // namespace hilcam
