#include "io/spice/kernel_names.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "io/system/text_number.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

struct Named {
    std::string_view name;
    int code;
};
// NAIF, "NAIF IDs Required Reading".
constexpr std::array kNaifNames = {
    Named{"SSB", 0},
    Named{"SOLAR SYSTEM BARYCENTER", 0},
    Named{"MERCURY BARYCENTER", 1},
    Named{"VENUS BARYCENTER", 2},
    Named{"EARTH BARYCENTER", 3},
    Named{"EARTH MOON BARYCENTER", 3},
    Named{"EARTH-MOON BARYCENTER", 3},
    Named{"EMB", 3},
    Named{"MARS BARYCENTER", 4},
    Named{"JUPITER BARYCENTER", 5},
    Named{"SATURN BARYCENTER", 6},
    Named{"URANUS BARYCENTER", 7},
    Named{"NEPTUNE BARYCENTER", 8},
    Named{"PLUTO BARYCENTER", 9},
    Named{"SUN", 10},
    Named{"MERCURY", 199},
    Named{"VENUS", 299},
    Named{"EARTH", 399},
    Named{"MOON", 301},
    Named{"MARS", 499},
    Named{"PHOBOS", 401},
    Named{"DEIMOS", 402},
    Named{"JUPITER", 599},
    Named{"IO", 501},
    Named{"EUROPA", 502},
    Named{"GANYMEDE", 503},
    Named{"CALLISTO", 504},
    Named{"AMALTHEA", 505},
    Named{"SATURN", 699},
    Named{"MIMAS", 601},
    Named{"ENCELADUS", 602},
    Named{"TETHYS", 603},
    Named{"DIONE", 604},
    Named{"RHEA", 605},
    Named{"TITAN", 606},
    Named{"HYPERION", 607},
    Named{"IAPETUS", 608},
    Named{"PHOEBE", 609},
    Named{"JANUS", 610},
    Named{"EPIMETHEUS", 611},
    Named{"URANUS", 799},
    Named{"ARIEL", 701},
    Named{"UMBRIEL", 702},
    Named{"TITANIA", 703},
    Named{"OBERON", 704},
    Named{"MIRANDA", 705},
    Named{"NEPTUNE", 899},
    Named{"TRITON", 801},
    Named{"NEREID", 802},
    Named{"PLUTO", 999},
    Named{"CHARON", 901},
    Named{"CERES", 2000001},
    Named{"PALLAS", 2000002},
    Named{"VESTA", 2000004},
    Named{"EROS", 2000433},
    Named{"MATHILDE", 2000253},
    Named{"LUTETIA", 2000021},
    Named{"STEINS", 2002867},
    Named{"ITOKAWA", 2025143},
    Named{"BENNU", 2101955},
    Named{"RYUGU", 2162173},
    Named{"IDA", 2431010},
    Named{"DACTYL", 2431011},
    Named{"GASPRA", 9511010},
    Named{"CHURYUMOV-GERASIMENKO", 1000012},
    Named{"TEMPEL 1", 1000093},
    Named{"HARTLEY 2", 1000041},
};

std::string name_as_compared(std::string_view name) {
    std::string out;
    for (const char c : name) {
        const char letter = c == '_' ? ' ' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        if (letter == ' ' && (out.empty() || out.back() == ' ')) continue;
        out += letter;
    }
    while (!out.empty() && out.back() == ' ') out.pop_back();
    return out;
}

}  // namespace

std::optional<int> kernel_code(const KernelPool& pool, std::string_view name) {
    if (const auto number = parsed_as<int>(name)) return number;
    const std::string wanted = name_as_compared(name);
    const auto names = pool.texts("NAIF_BODY_NAME");
    const auto codes = pool.numbers("NAIF_BODY_CODE");
    if (names && codes) {
        if (names->size() != codes->size())
            throw InputError(pool.find("NAIF_BODY_NAME")->where + ": NAIF_BODY_NAME has " +
                             std::to_string(names->size()) + " names and NAIF_BODY_CODE " +
                             std::to_string(codes->size()) + " codes; accepted: one code for each name");
        for (std::size_t i = names->size(); i-- > 0;)
            if (name_as_compared((*names)[i]) == wanted && std::abs((*codes)[i]) < 2e9)
                return static_cast<int>((*codes)[i]);
    }
    const auto own =
        std::find_if(kNaifNames.begin(), kNaifNames.end(), [&](const Named& n) { return n.name == wanted; });
    if (own != kNaifNames.end()) return own->code;
    return {};
}

int require_kernel_code(const KernelPool& pool, std::string_view name, const std::string& key) {
    if (const auto code = kernel_code(pool, name)) return *code;
    throw InputError(
        key + ": found " + in_quotes(name) +
        "; accepted: a name of the Solar System or of the kernels' NAIF_BODY_NAME, or NAIF's code");
}

}  // namespace hilcam
