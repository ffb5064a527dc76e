#include "emulator/run/page_maker.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "io/system/program_files.h"
#include "render/vocabulary/check.h"

namespace hilcam {

int run_helper(const std::string& name, const std::vector<std::string>& arguments,
               const std::string& without) {
    const auto program = helper_program(name);
    if (!std::filesystem::exists(program))
        throw DeviceError(program.string() + " is missing: " + without + "; build it (target " + name + ")");
    std::vector<std::string> words = {name};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_t child = 0;
    if (posix_spawn(&child, program.c_str(), nullptr, nullptr, argv.data(), environ) != 0)
        throw DeviceError(program.string() + " cannot be started: " + without);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

void run_page_maker(const std::string& name, const std::vector<std::string>& arguments) {
    if (run_helper(name, arguments, "no page is made; it needs python3") != 0)
        throw DeviceError(name + " failed (see above): no page is made");
}

}  // namespace hilcam
