#include "io/files/kept_stderr.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <opencv2/core/utils/logger.hpp>

#include "render/vocabulary/quoted.h"

namespace hilcam {

KeptStderr::KeptStderr()
    : kept_(memfd_create("hilcam_stderr", MFD_CLOEXEC)), terminal_(fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0)) {
    if (kept_ && terminal_) dup2(kept_.get(), STDERR_FILENO);
    // OpenCV's own lines name its source files; those of the libraries below it say what is wrong.
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
}

KeptStderr::~KeptStderr() {
    if (kept_ && terminal_) dup2(terminal_.get(), STDERR_FILENO);
}

std::string KeptStderr::first_line() const {
    std::array<char, 512> text{};
    const ssize_t size = kept_ ? pread(kept_.get(), text.data(), text.size(), 0) : 0;
    if (size <= 0) return {};
    const std::string_view all(text.data(), static_cast<std::size_t>(size));
    return shortened(all.substr(0, all.find('\n')));
}

}  // namespace hilcam
