#include "emulator/campaign/campaign.h"

#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <memory>
#include <system_error>
#include <thread>

#include "emulator/campaign/campaign_results.h"
#include "emulator/campaign/case_record.h"
#include "emulator/campaign/end_request.h"
#include "emulator/campaign/picture_case.h"
#include "emulator/campaign/program_case.h"
#include "emulator/campaign/worker_pool.h"
#include "emulator/progress/progress.h"
#include "io/system/durable_file.h"
#include "io/system/plain_words.h"
#include "render/vocabulary/stopwatch.h"
#include "render/vocabulary/time.h"

namespace hilcam {
namespace {

std::string host_name() {
    std::array<char, 65> name{};
    return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

std::string wall_clock_utc() {
    std::array<char, 32> text{};
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc)};
}

double processor_s() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

class CampaignMaker {
  public:
    CampaignMaker(const CampaignConfig& campaign, const CampaignFolder& folder, std::size_t workers)
        : campaign_(campaign), folder_(folder), workers_(workers), draw_(campaign) {
        // Limits this process to one thread: children are forked from it, and oneTBB's threads would not
        // exist in them.
        if (workers_ > 1)
            threads_ = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, 1);
        // A single child loads for itself, with all threads.
        if (workers_ > 1 && !campaign_.run) load();
    }

    void run(const std::vector<std::uint64_t>& numbers, CampaignOutcome& outcome) {
        WorkerPool pool(workers_, campaign_.time_limit_s, [this](std::size_t slot) { return begin(slot); });
        Progress progress("campaign " + campaign_.name, static_cast<double>(numbers.size()));
        std::uint64_t told = 0;
        const auto tell = [&](std::uint64_t number, std::string problem, WorkerPool::End end) {
            progress.done(static_cast<double>(++told));
            // The child had no time to write the record itself.
            if (end == WorkerPool::End::kCrashed) problem = keep(failed_record(number, problem));
            if (problem.empty())
                ++outcome.made;
            else
                add_problem(outcome, case_name(number) + ": " + problem);
        };
        pool.run(numbers, tell, EndRequest::has_come);
    }

  private:
    const CampaignConfig& campaign_;
    const CampaignFolder& folder_;
    std::size_t workers_;
    CaseDraw draw_;
    std::unique_ptr<tbb::global_control> threads_;
    std::unique_ptr<PictureCases> pictures_;
    std::unique_ptr<EndRequest> end_;

    void load() { pictures_ = std::make_unique<PictureCases>(campaign_); }

    // Runs in the child. Cores without a child of their own are divided among the children.
    WorkerPool::Work begin(std::size_t slot) {
        const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
        const std::size_t threads = std::max<std::size_t>(1, cores / workers_);
        threads_.reset();
        threads_ =
            std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, threads);
        if (!campaign_.run && !pictures_) load();
        // Started programs must be ended on a signal; pictures need nothing.
        if (campaign_.run) end_ = std::make_unique<EndRequest>();
        return [this, slot](std::uint64_t number) { return make(number, slot); };
    }

    CaseRecord failed_record(std::uint64_t number, const std::string& reason) const {
        CaseRecord record;
        record.plan = draw_.plan(number, 0);
        record.reason = reason;
        record.host = host_name();
        record.begun_utc = wall_clock_utc();
        return record;
    }

    // Writes the record. Returns why that failed, or an empty text.
    std::string keep(const CaseRecord& record) const {
        try {
            write_record(folder_.path(), record);
            return {};
        } catch (const std::exception& problem) {
            return problem.what();
        }
    }

    // A failure for lack of machine resources is not an outcome of the case: it leaves no record, and the
    // same command makes the case again.
    CaseRecord outcome_of(std::uint64_t number, std::size_t slot) {
        try {
            return campaign_.run ? make_program_case(campaign_, draw_.plan(number, 0), folder_.path(), slot)
                                 : pictures_->make(number, folder_.path());
        } catch (const std::bad_alloc&) {
            throw DeviceError("not enough memory");
        } catch (const DeviceError&) {
            throw;
        } catch (const std::system_error&) {
            throw;
        } catch (const std::exception& problem) {
            return failed_record(number, problem.what());
        }
    }

    std::string make(std::uint64_t number, std::size_t slot) {
        const Stopwatch watch;
        const double before_s = processor_s();
        const std::string begun = wall_clock_utc();
        CaseRecord record;
        try {
            record = outcome_of(number, slot);
        } catch (const std::exception& problem) {
            return plain_words(problem);
        }
        record.begun_utc = begun;
        record.host = host_name();
        record.all_s = watch.seconds();
        record.cpu_s = processor_s() - before_s;
        return keep(record);
    }
};

std::uint64_t size_of(const CaseRange& range) { return range.last - range.first + 1; }

}  // namespace

void add_problem(CampaignOutcome& outcome, std::string line) {
    constexpr std::size_t kMaxNamed = 20;
    ++outcome.problems;
    if (outcome.failures.size() < kMaxNamed) outcome.failures.push_back(std::move(line));
}

std::string interruption_text(std::uint64_t done, std::uint64_t all) {
    return std::to_string(done) + " of " + std::to_string(all) + " done; the same command goes on";
}

CampaignOutcome run_campaign(const CampaignConfig& campaign, const CampaignOptions& options) {
    const CaseRange all{1, static_cast<std::uint64_t>(campaign.count)};
    const CaseRange range = options.cases.value_or(all);
    if (range.first < 1 || range.last < range.first || range.last > all.last)
        throw InputError("--cases: found " + std::to_string(range.first) + "-" + std::to_string(range.last) +
                         "; accepted: numbers from 1 to " + std::to_string(all.last) + " (count)");
    // Impossible campaigns are reported before a folder is made.
    const CaseDraw draw(campaign);
    load_keypoints(campaign.keypoints);
    EndRequest end;
    end.end_at_once("hilcam: interrupted; the same command goes on\n");
    const CampaignFolder folder(campaign, options.out, options.cases.has_value());
    CampaignOutcome outcome;
    const std::vector<std::uint64_t> missing =
        options.merge ? std::vector<std::uint64_t>() : folder.missing(range, options.retry);
    end.end_at_once("hilcam: " + interruption_text(size_of(range) - missing.size(), size_of(range)) + "\n");
    if (!missing.empty()) {
        const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
        const std::size_t workers = std::min(options.jobs > 0 ? options.jobs : cores, missing.size());
        const Stopwatch loading;
        CampaignMaker maker(campaign, folder, workers);
        outcome.load_s = loading.seconds();
        const Stopwatch working;
        end.end_at_once("");
        maker.run(missing, outcome);
        outcome.seconds = working.seconds();
        outcome.before = size_of(range) - missing.size();
        outcome.all = size_of(range);
        outcome.interrupted = EndRequest::has_come();
        if (outcome.interrupted) return outcome;
        end.end_at_once("hilcam: " + interruption_text(outcome.before + outcome.made, size_of(range)) + "\n");
    }
    write_results(campaign, folder.path(), range, !options.cases, outcome);
    return outcome;
}

}  // namespace hilcam
