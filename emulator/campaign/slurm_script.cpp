#include "emulator/campaign/slurm_script.h"

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "io/system/durable_file.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// Quotes a word for a shell.
std::string shell_word(const std::string& text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

// Returns "0-3,7", as --array accepts it.
std::string array_text(const std::vector<std::uint64_t>& tasks) {
    std::string out;
    for (std::size_t i = 0; i < tasks.size();) {
        std::size_t last = i;
        while (last + 1 < tasks.size() && tasks[last + 1] == tasks[last] + 1) ++last;
        out += (out.empty() ? "" : ",") + std::to_string(tasks[i]);
        if (last > i) out += "-" + std::to_string(tasks[last]);
        i = last + 1;
    }
    return out;
}

std::string job_name(const SlurmPlan& plan) {
    std::string name = "hilcam-" + plan.name;
    for (char& c : name)
        if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'))) c = '-';
    return name;
}

std::string command_of(const SlurmPlan& plan) {
    std::string out = shell_word(plan.program.string()) + " campaign " + shell_word(plan.campaign.string()) +
                      " --out " + shell_word(plan.folder.string());
    for (const std::string& override : plan.overrides) out += " --set " + shell_word(override);
    return out;
}

// Quotes a file name for sbatch in a script line: sbatch splits words and handles quotes like a shell, and
// has patterns with % (sbatch(1), "filename pattern"). log: may contain such patterns.
std::string log_word(const SlurmPlan& plan, const std::string& log) {
    std::string folder;
    for (const char c : (plan.folder / "slurm").string())
        folder += c == '%' ? std::string("%%") : std::string(1, c);
    return shell_word(folder + "/" + log);
}

std::string heading(const SlurmPlan& plan, const std::string& name, const std::string& log) {
    return "#!/bin/sh\n#SBATCH --job-name=" + name + "\n#SBATCH --output=" + log_word(plan, log) + "\n";
}

// Refuses a line feed, which would end the script line that names the folder, and a backslash, which would
// turn off all patterns in a log's name.
void require_plain_folder(const std::filesystem::path& folder) {
    const std::string name = folder.string();
    const bool bad = std::any_of(name.begin(), name.end(), [](char c) {
        return static_cast<unsigned char>(c) < 0x20 || c == 0x7F || c == '\\';
    });
    if (bad)
        throw InputError("--out " + in_quotes(name) +
                         ": accepted with --slurm: a folder whose name has no control characters and no "
                         "backslash");
}

// Runs a command and returns its output. The words must already be quoted.
std::string output_of(const std::string& command) {
    FILE* const pipe = popen((command + " 2>&1").c_str(), "re");
    if (!pipe) throw DeviceError("sbatch cannot be started");
    std::string out;
    std::array<char, 4096> piece{};
    for (std::size_t size; (size = fread(piece.data(), 1, piece.size(), pipe)) > 0;)
        out.append(piece.data(), size);
    const int status = pclose(pipe);
    while (!out.empty() && out.back() == '\n') out.pop_back();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw DeviceError("sbatch: " + shortened(out));
    return out;
}

bool has_sbatch() { return std::system("command -v sbatch >/dev/null 2>&1") == 0; }

}  // namespace

std::uint64_t chunk_of(double case_s, double task_s) {
    return static_cast<std::uint64_t>(std::clamp(std::floor(task_s / std::max(case_s, 1e-3)), 1.0, 1e6));
}

std::vector<std::uint64_t> tasks_of(const std::vector<std::uint64_t>& missing, std::uint64_t chunk) {
    std::vector<std::uint64_t> out;
    for (const std::uint64_t number : missing)
        if (const std::uint64_t task = (number - 1) / chunk; out.empty() || out.back() != task)
            out.push_back(task);
    return out;
}

std::string array_script(const SlurmPlan& plan) {
    const std::string chunk = std::to_string(plan.chunk), count = std::to_string(plan.count);
    return heading(plan, job_name(plan), "task-%a.log") + "#SBATCH --array=" + array_text(plan.tasks) +
           "\n"
           // The work of a node that dies is kept, and the task continues where it was.
           "#SBATCH --requeue\n#SBATCH --open-mode=append\n"
           "first=$((SLURM_ARRAY_TASK_ID * " +
           chunk +
           " + 1))\n"
           "last=$((first + " +
           chunk +
           " - 1))\n"
           "[ $last -gt " +
           count + " ] && last=" + count +
           "\n"
           "exec " +
           command_of(plan) + " --cases $first-$last --jobs ${SLURM_CPUS_PER_TASK:-1}\n";
}

std::string merge_script(const SlurmPlan& plan) {
    return heading(plan, job_name(plan) + "-merge", "merge.log") + "exec " + command_of(plan) + " --merge\n";
}

std::vector<std::string> submit_campaign(const SlurmPlan& plan, bool submit) {
    require_plain_folder(plan.folder);
    const std::filesystem::path array = plan.folder / "slurm" / "array.sh",
                                merge = plan.folder / "slurm" / "merge.sh";
    write_durably(array, array_script(plan));
    write_durably(merge, merge_script(plan));
    std::vector<std::string> out = {std::to_string(plan.tasks.size()) + " tasks of " +
                                    std::to_string(plan.chunk) + " cases: " + array.string()};
    if (!submit || !has_sbatch()) {
        out.push_back("not submitted: sbatch " + array.string() + ", and " + merge.string() + " after it");
        return out;
    }
    const std::string job = output_of("sbatch --parsable " + shell_word(array.string()));
    // Tasks with failed cases count as failed; the results are put together anyway.
    const std::string last = output_of("sbatch --parsable --dependency=afterany:" + shell_word(job) + " " +
                                       shell_word(merge.string()));
    out.push_back("submitted: job " + job + ", and " + last + " to put its results together");
    return out;
}

}  // namespace hilcam
