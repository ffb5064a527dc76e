// `hilcam cache`: lists and deletes what earlier runs have stored.

#include <spdlog/fmt/fmt.h>

#include "emulator/send/command_examples.h"
#include "emulator/subcommands/arguments.h"
#include "io/cache/cache.h"
#include "io/cache/cache_room.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

struct CacheArguments {};

constexpr double kMegabyte_bytes = 1e6;

std::filesystem::path trusted_folder() {
    const std::filesystem::path folder = cache_folder();
    if (folder.empty())
        throw InputError(
            "there is no cache folder: nothing is kept from run to run; accepted: one in HILCAM_CACHE, or "
            "HOME");
    if (const std::string why = mistrust_of(folder); !why.empty()) throw InputError(why);
    return folder;
}

int look(const CacheArguments&) {
    const std::filesystem::path folder = trusted_folder();
    const CacheSize all = cache_size(folder);
    fmt::print("{}: {} files, {:.0f} MB of at most {:.0f} MB (HILCAM_CACHE_MB)\n", harmless(folder.string()),
               all.files, static_cast<double>(all.bytes) / kMegabyte_bytes,
               static_cast<double>(cache_bound_bytes()) / kMegabyte_bytes);
    for (const CacheKind& kind : kCacheKinds) {
        const CacheSize size = cache_size(folder, kind.prefix);
        fmt::print("{:18}{:6} files{:9.1f} MB\n", kind.meaning, size.files,
                   static_cast<double>(size.bytes) / kMegabyte_bytes);
    }
    return 0;
}

int clear(const CacheArguments&) {
    const std::filesystem::path folder = trusted_folder();
    const CacheSize gone = clear_cache(folder);
    fmt::print("{}: {} files removed, {:.0f} MB\n", harmless(folder.string()), gone.files,
               static_cast<double>(gone.bytes) / kMegabyte_bytes);
    return 0;
}

}  // namespace

void add_cache_command(CLI::App& app, Action& action) {
    auto o = std::make_shared<CacheArguments>();
    CLI::App* cache = app.add_subcommand(
        "cache",
        "list what is kept from run to run ($HILCAM_CACHE, else ~/.cache/hilcam), and how large it is");
    cache->require_subcommand(0, 1);
    CLI::App* all_gone = cache->add_subcommand(
        "clear",
        "remove what hilcam has put there and nothing else; removed files are made again when needed");
    set_examples(cache, {"hilcam cache"});
    set_examples(all_gone, {"hilcam cache clear"});
    when_named(all_gone, action, o, clear);
    cache->callback([&action, cache, o] {
        if (cache->get_subcommands().empty()) action = [o] { return look(*o); };
    });
}

}  // namespace hilcam
