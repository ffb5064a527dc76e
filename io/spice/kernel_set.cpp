#include "io/spice/kernel_set.h"

#include <algorithm>
#include <map>
#include <set>
#include <system_error>

#include "io/spice/text_kernel.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

constexpr std::uintmax_t kMaxTextBytes = 256u << 20;
constexpr int kDeepestMetaKernel = 8;
// A mission's meta-kernels name some hundred files with a few symbols. No name is longer than a path of Linux
// (PATH_MAX).
constexpr std::size_t kMaxNamedKernels = 10'000, kMaxSymbols = 1000, kLongestPath = 4096;

// The first bytes of a file identify its kind.
enum class KernelKind { kBinary, kShape, kText, kMeta };
KernelKind kind_of(const std::filesystem::path& file) {
    const InputFile in = open_input_file(file, {std::uintmax_t{1} << 34, "a SPICE kernel"});
    std::string word(std::min<std::uintmax_t>(in.bytes, 8), '\0');
    read_input_piece(in, file, 0, word.data(), word.size());
    const std::optional<TransferKind> transfer = transfer_kind_of(word);
    if (word.starts_with("DAF/") || word == "NAIF/DAF" || transfer == TransferKind::kDaf)
        return KernelKind::kBinary;
    if (word.starts_with("DAS/") || word == "NAIF/DAS" || transfer == TransferKind::kDas)
        return KernelKind::kShape;
    if (word.find('\0') != std::string::npos)
        throw InputError(file.string() + ": found the identification " + in_quotes(word) +
                         "; accepted: DAF/SPK, DAF/CK, DAF/PCK, or a text kernel");
    return KernelKind::kText;
}

// Replaces a meta-kernel's symbols with their paths.
class Symbols {
  public:
    explicit Symbols(const KernelPool& own, std::string where) : where_(std::move(where)) {
        const auto symbols = own.texts("PATH_SYMBOLS").value_or(std::span<const std::string>());
        const auto values = own.texts("PATH_VALUES").value_or(std::span<const std::string>());
        if (symbols.size() != values.size() || symbols.size() > kMaxSymbols)
            throw InputError(where_ + ": has " + std::to_string(symbols.size()) + " PATH_SYMBOLS and " +
                             std::to_string(values.size()) +
                             " PATH_VALUES; accepted: one value for each symbol, at most 1000");
        for (std::size_t i = 0; i < symbols.size(); ++i) paths_.push_back({"$" + symbols[i], values[i]});
        // The longest symbol comes first, because one may be the beginning of another.
        std::stable_sort(paths_.begin(), paths_.end(),
                         [](const Path& a, const Path& b) { return a.symbol.size() > b.symbol.size(); });
    }
    std::string replaced(std::string name) const {
        for (const Path& path : paths_)
            if (const std::size_t at = name.find(path.symbol); at != std::string::npos)
                name.replace(at, path.symbol.size(), path.value);
        if (name.find('$') != std::string::npos)
            throw InputError(where_ + ": KERNELS_TO_LOAD: found " + in_quotes(name) +
                             ", whose symbol has no path; accepted: symbols of PATH_SYMBOLS");
        return name;
    }

  private:
    struct Path {
        std::string symbol, value;
    };
    std::string where_;
    std::vector<Path> paths_;
};

// Determines what a file of a set is, once per file however often it is named.
struct Looked {
    std::filesystem::path file;
    KernelKind kind = KernelKind::kText;
    std::vector<std::filesystem::path> named;  // named by a meta-kernel
    KernelPool own;                            // its own variables that apply to all kernels
};

std::vector<std::filesystem::path> names_of(const std::filesystem::path& file, const KernelPool& own) {
    const std::string where = own.find("KERNELS_TO_LOAD")->where;
    const Symbols symbols(own, where);
    std::vector<std::filesystem::path> out;
    std::string name;
    const auto require_short = [&] {
        if (name.size() > kLongestPath)
            throw InputError(where + ": KERNELS_TO_LOAD: found the name " + in_quotes(name) +
                             " of more than " + std::to_string(kLongestPath) +
                             " bytes; accepted: a shorter one");
    };
    const std::span<const std::string> parts = own.texts("KERNELS_TO_LOAD").value();
    for (const std::string& part : parts) {
        // A name that ends with + continues in the next one.
        const bool goes_on = part.ends_with('+');
        name.append(part, 0, part.size() - (goes_on ? 1 : 0));
        require_short();
        if (goes_on) continue;
        name = symbols.replaced(name);
        require_short();
        if (out.size() == kMaxNamedKernels)
            throw InputError(where +
                             ": KERNELS_TO_LOAD: has more than 10000 names; accepted: as many at most");
        out.push_back(file.parent_path() / name);
        std::error_code no_reason;
        if (!std::filesystem::exists(out.back(), no_reason))
            throw InputError(where + ": KERNELS_TO_LOAD: no such file " + in_quotes(out.back().string()));
        name.clear();
    }
    return out;
}

Looked look_at(const std::filesystem::path& file) {
    Looked out{file, kind_of(file), {}, {}};
    if (out.kind != KernelKind::kText) return out;
    KernelPool own;
    read_text_kernel(read_input_file(file, {kMaxTextBytes, "a SPICE kernel"}), file.string(), own);
    if (!own.find("KERNELS_TO_LOAD")) return out;
    out.kind = KernelKind::kMeta;
    out.named = names_of(file, own);
    // A meta-kernel's own keywords apply to it only.
    for (const auto& [name, variable] : own.all())
        if (name != "KERNELS_TO_LOAD" && name != "PATH_SYMBOLS" && name != "PATH_VALUES")
            out.own.assign(name, variable, false);
    return out;
}

// The files of a set in order of precedence. A file that is named again counts at its last place.
class KernelList {
  public:
    void add(const std::filesystem::path& file, int depth = 0) {
        if (depth > kDeepestMetaKernel)
            throw InputError(file.string() +
                             ": meta-kernels name each other more than 8 deep; accepted: no circle");
        if (++named_ > kMaxNamedKernels)
            throw InputError(
                file.string() +
                ": meta-kernels name each other's files more than 10000 times; accepted: each file once");
        std::error_code no_such_file;  // a missing file is reported by look_at()
        const std::filesystem::path path = std::filesystem::canonical(file, no_such_file);
        const std::string key = no_such_file ? file.string() : path.string();
        auto at = looked_.find(key);
        if (at == looked_.end()) at = looked_.emplace(key, look_at(file)).first;
        const Looked& looked = at->second;
        if (looked.kind == KernelKind::kShape && depth == 0)
            throw InputError(file.string() +
                             ": is a shape kernel (DSK); accepted here: SPK, CK, PCK and text "
                             "kernels (a shape is an object's mesh)");
        order_.push_back(&looked);
        for (const std::filesystem::path& name : looked.named) add(name, depth + 1);
    }
    std::vector<const Looked*> take() const {
        std::vector<const Looked*> out;
        std::set<const Looked*> seen;
        for (std::size_t i = order_.size(); i-- > 0;)
            if (seen.insert(order_[i]).second) out.push_back(order_[i]);
        std::reverse(out.begin(), out.end());
        return out;
    }

  private:
    std::map<std::string, Looked> looked_;
    std::vector<const Looked*> order_;
    std::size_t named_ = 0;
};

void load(const Looked& looked, KernelSet& set) {
    set.files.push_back(looked.file.string());
    // A mission's meta-kernel may name shapes as well.
    if (looked.kind == KernelKind::kShape) return;
    if (looked.kind == KernelKind::kBinary)
        set.binaries.push_back(std::make_unique<DafFile>(looked.file));
    else if (looked.kind == KernelKind::kText)
        read_text_kernel(read_input_file(looked.file, {kMaxTextBytes, "a SPICE kernel"}),
                         looked.file.string(), set.pool);
    else
        for (const auto& [name, variable] : looked.own.all()) set.pool.assign(name, variable, false);
}

}  // namespace

KernelSet load_kernels(std::span<const std::filesystem::path> files) {
    KernelList list;
    for (const std::filesystem::path& file : files) list.add(file);
    KernelSet set;
    for (const Looked* looked : list.take()) load(*looked, set);
    set.time = ephemeris_time(set.pool);
    return set;
}

}  // namespace hilcam
