#include "io/cache/generated_mesh.h"

#include <algorithm>
#include <cctype>

#include "io/system/program_files.h"
#include "io/system/run_program.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// Raise this when a generator makes another mesh for the same arguments.
constexpr int kMeshVersion = 2;

bool is_plain(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_'; }

void generate(const std::string& program, const std::vector<std::string>& arguments,
              const std::filesystem::path& file) {
    const auto beside = helper_program(program);
    if (!std::filesystem::exists(beside))
        throw InputError("mesh generator " + beside.string() +
                         " is missing; build it, or give the object a mesh file");
    std::vector<std::string> words = arguments;
    words.insert(words.end(), {"--out", file.string()});
    const int status = run_program(beside, words).value_or(-1);
    if (status == 2) throw InputError("mesh generator " + program + " refuses its arguments (see above)");
    if (status != 0 || !std::filesystem::exists(file))
        throw DeviceError("mesh generator " + program + " failed with status " + std::to_string(status) +
                          " for " + file.string());
}

}  // namespace

std::string generated_mesh_name(const std::string& program, const std::vector<std::string>& arguments) {
    if (program.empty() || !std::all_of(program.begin(), program.end(), is_plain))
        throw InputError("mesh generator " + in_quotes(program) +
                         ": accepted: the name of a program beside hilcam, as " + "hilcam-make-spacecraft");
    std::string name = program;
    for (const std::string& argument : arguments) {
        const std::string word = argument.substr(std::min(argument.find_first_not_of('-'), argument.size()));
        name += "_";
        for (const char c : word) name += is_plain(c) || c == '.' ? c : '-';
    }
    return name + "_v" + std::to_string(kMeshVersion) + ".glb";
}

HeldFile generated_mesh(const std::string& program, const std::vector<std::string>& arguments,
                        const Cache& cache) {
    return cache.glb(generated_mesh_name(program, arguments),
                     [&](const std::filesystem::path& file) { generate(program, arguments, file); });
}

}  // namespace hilcam
