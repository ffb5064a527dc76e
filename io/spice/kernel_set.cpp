#include "io/spice/kernel_set.h"

#include <algorithm>

#include "io/spice/text_kernel.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

constexpr std::uintmax_t kMaxTextBytes = 256u << 20;
constexpr int kDeepestMetaKernel = 8;

// The first bytes of a file say what it is.
enum class Kind { kBinary, kShape, kTransfer, kText };
Kind kind_of(const std::filesystem::path& file) {
    const InputFile in = open_input_file(file, {std::uintmax_t{1} << 34, "a SPICE kernel"});
    std::string word(std::min<std::uintmax_t>(in.bytes, 8), '\0');
    read_input_piece(in, file, 0, word.data(), word.size());
    if (word.starts_with("DAFETF") || word.starts_with("DASETF")) return Kind::kTransfer;
    if (word.starts_with("DAF/") || word == "NAIF/DAF") return Kind::kBinary;
    if (word.starts_with("DAS/") || word == "NAIF/DAS") return Kind::kShape;
    if (word.find('\0') != std::string::npos)
        throw InputError(file.string() + ": found the identification " + in_quotes(word) +
                         "; accepted: DAF/SPK, DAF/CK, DAF/PCK, or a text kernel");
    return Kind::kText;
}

// Puts the path that a meta-kernel has for a symbol in its place.
std::string with_paths(std::string name, std::span<const std::string> symbols,
                       std::span<const std::string> values, const std::string& where) {
    // The longest symbol first: one may begin as another.
    std::vector<std::size_t> order(symbols.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return symbols[a].size() > symbols[b].size(); });
    for (const std::size_t i : order) {
        const std::string symbol = "$" + symbols[i];
        if (const std::size_t at = name.find(symbol); at != std::string::npos)
            name.replace(at, symbol.size(), values[i]);
    }
    if (name.find('$') != std::string::npos)
        throw InputError(where + ": KERNELS_TO_LOAD: found " + in_quotes(name) +
                         ", whose symbol has no path; accepted: symbols of PATH_SYMBOLS");
    return name;
}

class Loader {
  public:
    void load(const std::filesystem::path& file, int depth) {
        if (depth > kDeepestMetaKernel)
            throw InputError(file.string() +
                             ": meta-kernels name each other more than 8 deep; accepted: no circle");
        set_.files.push_back(file.string());
        switch (kind_of(file)) {
            case Kind::kBinary:
                set_.binaries.push_back(std::make_unique<DafFile>(file));
                return;
            case Kind::kShape:
                // A mission's meta-kernel names shapes beside the rest.
                if (depth > 0) return;
                throw InputError(file.string() +
                                 ": is a shape kernel (DSK); accepted here: SPK, CK, PCK and text "
                                 "kernels (a shape is an object's mesh)");
            case Kind::kTransfer:
                throw InputError(file.string() +
                                 ": is a kernel in transfer format; accepted: the binary kernel that "
                                 "NAIF's tobin makes of it");
            case Kind::kText:
                load_text(file, depth);
        }
    }
    KernelSet take() {
        set_.time = ephemeris_time(set_.pool);
        return std::move(set_);
    }

  private:
    KernelSet set_;

    void load_text(const std::filesystem::path& file, int depth) {
        const std::string text = read_input_file(file, {kMaxTextBytes, "a SPICE kernel"});
        // A meta-kernel's own variables hold for it alone.
        KernelPool own;
        read_text_kernel(text, file.string(), own);
        if (!own.find("KERNELS_TO_LOAD")) {
            read_text_kernel(text, file.string(), set_.pool);
            return;
        }
        for (const auto& [name, variable] : own.all())
            if (name != "KERNELS_TO_LOAD" && name != "PATH_SYMBOLS" && name != "PATH_VALUES")
                set_.pool.assign(name, variable, false);
        const auto names = own.texts("KERNELS_TO_LOAD").value();
        const auto symbols = own.texts("PATH_SYMBOLS").value_or(std::span<const std::string>());
        const auto values = own.texts("PATH_VALUES").value_or(std::span<const std::string>());
        const std::string where = own.find("KERNELS_TO_LOAD")->where;
        if (symbols.size() != values.size())
            throw InputError(where + ": has " + std::to_string(symbols.size()) + " PATH_SYMBOLS and " +
                             std::to_string(values.size()) +
                             " PATH_VALUES; accepted: one value for each symbol");
        // A name that ends with + goes on in the next one.
        std::string name;
        for (const std::string& part : names) {
            if (part.ends_with('+')) {
                name += part.substr(0, part.size() - 1);
                continue;
            }
            name = with_paths(name + part, symbols, values, where);
            const std::filesystem::path path = file.parent_path() / name;
            if (!std::filesystem::exists(path))
                throw InputError(where + ": KERNELS_TO_LOAD: no such file " + in_quotes(path.string()));
            load(path, depth + 1);
            name.clear();
        }
    }
};

}  // namespace

KernelSet load_kernels(std::span<const std::filesystem::path> files) {
    Loader loader;
    for (const std::filesystem::path& file : files) loader.load(file, 0);
    return loader.take();
}

}  // namespace hilcam
