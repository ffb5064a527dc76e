#include "io/system/durable_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <set>

#include "io/system/fd.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr const char* kUnfinishedMark = ".unfinished-";

[[noreturn]] void fail_file(const std::filesystem::path& file, int error) {
    throw DeviceError(file.string() + " cannot be written: " + std::strerror(error));
}

// The host's name is part of the name: machines that share a folder may have processes with the same number.
std::filesystem::path unfinished_name(const std::filesystem::path& file) {
    std::array<char, 65> host{};
    if (gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
    return file.parent_path() / (std::string(kUnfinishedMark) + host.data() + "-" + std::to_string(getpid()) +
                                 "-" + file.filename().string());
}

void make_parent(const std::filesystem::path& file) {
    std::error_code error;
    if (!file.parent_path().empty()) std::filesystem::create_directories(file.parent_path(), error);
    if (error) throw DeviceError(file.parent_path().string() + " cannot be made: " + error.message());
}

void sync_path(const std::filesystem::path& path, int flags) {
    const Fd fd(open(path.c_str(), flags | O_CLOEXEC));
    // Some file systems sync no folders (EINVAL, fsync(2)).
    if (!fd || (fsync(fd.get()) != 0 && errno != EINVAL)) fail_file(path, errno);
}

void sync_folder(const std::filesystem::path& folder) {
    sync_path(folder.empty() ? "." : folder, O_RDONLY | O_DIRECTORY);
}

}  // namespace

void write_durably(const std::filesystem::path& file, std::string_view text) {
    DurableFiles files;
    const std::filesystem::path now = files.begin(file);
    Fd fd(open(now.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    if (!fd) fail_file(file, errno);
    while (!text.empty()) {
        const ssize_t wrote = ::write(fd.get(), text.data(), text.size());
        if (wrote < 0 && errno == EINTR) continue;
        if (wrote <= 0) fail_file(file, wrote < 0 ? errno : EIO);
        text.remove_prefix(static_cast<std::size_t>(wrote));
    }
    fd.reset();
    files.commit();
}

DurableFiles::~DurableFiles() {
    std::error_code ignored;
    for (const auto& [now, then] : files_) std::filesystem::remove(now, ignored);
}

std::filesystem::path DurableFiles::begin(const std::filesystem::path& file) {
    make_parent(file);
    files_.emplace_back(unfinished_name(file), file);
    return files_.back().first;
}

void DurableFiles::commit() {
    std::set<std::filesystem::path> folders;
    for (const auto& [now, then] : files_) sync_path(now, O_RDONLY);
    for (const auto& [now, then] : files_) {
        if (std::rename(now.c_str(), then.c_str()) != 0) fail_file(then, errno);
        folders.insert(then.parent_path());
    }
    files_.clear();
    for (const std::filesystem::path& folder : folders) sync_folder(folder);
}

void remove_unfinished(const std::filesystem::path& folder) {
    std::error_code error;
    std::vector<std::filesystem::path> found;
    for (auto at = std::filesystem::recursive_directory_iterator(folder, error);
         !error && at != std::filesystem::recursive_directory_iterator(); at.increment(error))
        if (at->path().filename().string().starts_with(kUnfinishedMark)) found.push_back(at->path());
    for (const std::filesystem::path& file : found) std::filesystem::remove(file, error);
}

}  // namespace hilcam
