#include "emulator/campaign/campaign_folder.h"

#include <fcntl.h>
#include <sys/file.h>

#include <cerrno>
#include <cstring>

#include "emulator/campaign/case_record.h"
#include "emulator/recording/program_version.h"
#include "emulator/scenario/scenario_listing.h"
#include "io/system/durable_file.h"
#include "io/system/input_file.h"

namespace hilcam {

std::string campaign_listing(const CampaignConfig& campaign) {
    CampaignConfig same = campaign;
    same.count = 1, same.time_limit_s = 600, same.shard_samples = 0;
    std::string listing =
        "program = " + std::string(kProgramVersion) + "\n" + section_listing(section_of(same));
    const std::string scenario = scenario_listing(load_scenario(campaign.scenario, campaign.set));
    for (std::size_t at = 0; at < scenario.size();) {
        const std::size_t end = scenario.find('\n', at);
        // Each case has its own seed.
        if (const std::string line = scenario.substr(at, end - at); !line.starts_with("seed = "))
            listing += "scenario." + line + "\n";
        at = end + 1;
    }
    return listing;
}

CampaignFolder::CampaignFolder(const CampaignConfig& campaign, const std::filesystem::path& folder,
                               bool shared)
    : folder_(folder) {
    std::error_code error;
    const bool is_new = !std::filesystem::exists(folder / "campaign.txt", error);
    if (is_new && std::filesystem::exists(folder, error) && !std::filesystem::is_empty(folder, error) &&
        !std::filesystem::exists(folder / "campaign.lock", error))
        throw InputError(
            "--out " + folder.string() +
            ": is not empty and holds no campaign; accepted: a new folder, or this campaign's folder");
    std::filesystem::create_directories(folder, error);
    if (error) throw DeviceError(folder.string() + " cannot be made: " + error.message());
    take_lock(shared);
    check_identity(campaign);
    if (!shared) remove_unfinished(folder_);
}

void CampaignFolder::take_lock(bool shared) {
    const std::filesystem::path file = folder_ / "campaign.lock";
    lock_ = Fd(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
    if (!lock_) throw DeviceError(file.string() + " cannot be written: " + std::strerror(errno));
    if (flock(lock_.get(), (shared ? LOCK_SH : LOCK_EX) | LOCK_NB) == 0) return;
    if (errno != EWOULDBLOCK) return;  // a file system without locks
    throw InputError("--out " + folder_.string() + ": another process is working on this campaign" +
                     (shared ? "" : "; accepted: --cases for several at once"));
}

void CampaignFolder::check_identity(const CampaignConfig& campaign) const {
    const std::filesystem::path file = folder_ / "campaign.txt";
    const std::string listing = campaign_listing(campaign);
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return write_durably(file, listing);
    const std::string there = read_input_file(file, {64u << 20, "a campaign's listing"});
    if (there == listing) return;
    throw InputError("--out " + folder_.string() + ": holds another campaign (" +
                     listing_difference(there, listing) + "); accepted: another folder");
}

std::vector<std::uint64_t> CampaignFolder::missing(const CaseRange& range, bool failed) const {
    std::vector<std::uint64_t> out;
    for (std::uint64_t n = range.first; n <= range.last; ++n) {
        std::optional<CaseRecord> record;
        try {
            record = read_record(folder_, n);
        } catch (const InputError&) {
        }
        if (!record || (record->done ? !lost_file(folder_, *record).empty() : failed)) out.push_back(n);
    }
    return out;
}

}  // namespace hilcam
