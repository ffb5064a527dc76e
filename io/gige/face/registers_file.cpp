#include "io/gige/face/registers_file.h"

#include <algorithm>
#include <charconv>

#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

constexpr std::string_view kFirstLine = "# hilcam registers 1", kBlank = " \t\r";

std::string_view trimmed(std::string_view text) {
    const std::size_t from = text.find_first_not_of(kBlank);
    return from == std::string_view::npos ? std::string_view{}
                                          : text.substr(from, text.find_last_not_of(kBlank) - from + 1);
}

bool read_line(std::string_view line, RegisterRun& out) {
    if (line.size() < 3 || line[0] != '0' || (line[1] != 'x' && line[1] != 'X')) return false;
    line.remove_prefix(2);
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), out.address, 16);
    if (error != std::errc{}) return false;
    out.bytes = bytes_of_hex(trimmed(line.substr(static_cast<std::size_t>(end - line.data()))));
    return !out.bytes.empty() && out.bytes.size() - 1 <= 0xFFFFFFFFu - out.address;
}

}  // namespace

std::vector<std::uint8_t> bytes_of_hex(std::string_view text) {
    std::vector<std::uint8_t> bytes(text.size() / 2);
    if (text.size() % 2 != 0) return {};
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const char* const pair = text.data() + 2 * i;
        const auto [end, error] = std::from_chars(pair, pair + 2, bytes[i], 16);
        if (error != std::errc{} || end != pair + 2) return {};
    }
    return bytes;
}

std::vector<RegisterRun> registers_of(std::string_view text, const std::string& name) {
    std::vector<RegisterRun> runs;
    std::vector<std::pair<std::uint32_t, std::size_t>> lines;  // address, line
    std::size_t number = 0;
    for (bool more = true; more;) {
        const std::size_t end = text.find('\n');
        const std::string_view whole = text.substr(0, end);
        more = end != std::string_view::npos;
        text.remove_prefix(more ? end + 1 : text.size());
        const std::string where = name + ":" + std::to_string(++number);
        if (number == 1) {
            if (trimmed(whole) != kFirstLine)
                throw refused(where, in_quotes(whole), "the line " + std::string(kFirstLine));
            continue;
        }
        const std::string_view line = trimmed(whole.substr(0, whole.find('#')));
        if (line.empty()) continue;
        RegisterRun run;
        if (!read_line(line, run))
            throw refused(where, in_quotes(line), "an address and bytes, as 0x0000a104 00000280");
        lines.emplace_back(run.address, runs.size());
        runs.push_back(std::move(run));
    }
    std::sort(lines.begin(), lines.end());
    for (std::size_t i = 1; i < lines.size(); ++i) {
        const RegisterRun &before = runs[lines[i - 1].second], &run = runs[lines[i].second];
        if (run.address - before.address < before.bytes.size()) {
            char at[16];
            std::snprintf(at, sizeof at, "0x%08x", run.address);
            throw InputError(name + ": the register at " + at + " is there twice");
        }
    }
    return runs;
}

}  // namespace hilcam
