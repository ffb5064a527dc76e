#include "emulator/run/light_maker.h"

#include <pthread.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "emulator/progress/progress.h"
#include "io/system/plain_words.h"
#include "render/vocabulary/stopwatch.h"

namespace hilcam {

LightMaker::LightMaker(std::vector<Job> jobs) : jobs_(std::move(jobs)) {
    for (const Job& job : jobs_) tables_ += job.orders.size();
}

void LightMaker::start() {
    thread_ = std::thread([this] { run(); });
}

void LightMaker::stop() noexcept {
    stopping_.store(true);
    if (thread_.joinable()) thread_.join();
}

double LightMaker::share() const {
    const double made = static_cast<double>(made_.load()) + share_of_next_.load();
    return std::min(1.0, made / static_cast<double>(std::max<std::size_t>(1, tables_)));
}

void LightMaker::run() {
    // Frames have priority, and one of the cores that they leave is enough (as in
    // render/vocabulary/ahead_thread.cpp).
    pthread_setname_np(pthread_self(), kLightThreadName);
    constexpr int kNicer = 10;  // relative to the program's niceness
    setpriority(PRIO_PROCESS, 0, getpriority(PRIO_PROCESS, 0) + kNicer);
    tbb::task_arena alone(1, 1);
    const Stopwatch watch;
    try {
        alone.execute([this] {
            for (Job& job : jobs_) make(job);
        });
        seconds_ = watch.seconds();
        done_.store(true, std::memory_order_release);
    } catch (const GivenUp&) {
    } catch (const std::exception& error) {
        spdlog::error("light between surfaces cannot be cached ({}): frames use random paths",
                      plain_words(error));
    }
}

void LightMaker::make(Job& job) {
    std::vector<std::shared_ptr<const TransferTable>> tables;
    for (const TableOrder& order : job.orders) {
        const auto table = make(order);
        tables.resize(std::max(tables.size(), order.objects.back() + 1));
        for (const std::size_t object : order.objects) tables[object] = table;
    }
    job.orders = {};  // frees the meshes in the orders
    job.renderer->give_tables(tables);
}

std::shared_ptr<const TransferTable> LightMaker::make(const TableOrder& order) {
    const Progress progress("light kept on " + order.name, 1, [this] { return share_of_next_.load(); });
    auto table = make_table(order, [this](double share) { watch(share); });
    share_of_next_.store(0);
    made_.fetch_add(1);
    return table;
}

void LightMaker::watch(double share) {
    if (stopping_.load(std::memory_order_relaxed)) throw GivenUp();
    share_of_next_.store(share, std::memory_order_relaxed);
}

}  // namespace hilcam
