#include "emulator/scenario/outputs.h"

#include <iterator>

namespace hilcam {

Fields fields(OutputsConfig& outputs) {
    Fields list;
    outputs.for_each([&]<class Config>(Config& config, bool& given) {
        list.push_back(optional(section(Config::kKey, config, Config::kMeaning), given));
    });
    return list;
}

std::vector<ListeningPort> listening(const OutputsConfig& outputs) {
    std::vector<ListeningPort> all;
    outputs.for_each_given([&](const auto& config) {
        if constexpr (requires { listening(config); }) {
            std::vector<ListeningPort> own = listening(config);
            std::move(own.begin(), own.end(), std::back_inserter(all));
        }
    });
    return all;
}

std::vector<RunFolder> run_folders(const OutputsConfig& outputs) {
    std::vector<RunFolder> all;
    outputs.for_each_given([&](const auto& config) {
        if constexpr (requires { run_folder(config); })
            if (RunFolder folder = run_folder(config); !folder.folder.empty())
                all.push_back(std::move(folder));
    });
    return all;
}

bool have_fixed_size(const OutputsConfig& outputs) {
    return outputs.any([]<class Config>(const Config&) {
        if constexpr (requires { Config::kFixedSize; })
            return Config::kFixedSize;
        else
            return false;
    });
}

bool have_live(const OutputsConfig& outputs) {
    return outputs.any([]<class Config>(const Config& config) {
        if constexpr (requires { is_live(config); })
            return is_live(config);
        else if constexpr (requires { Config::kLive; })
            return Config::kLive;
        else
            return false;
    });
}

}  // namespace hilcam
