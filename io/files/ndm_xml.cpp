#include "io/files/ndm_xml.h"

#include <algorithm>
#include <array>
#include <pugixml.hpp>

#include "io/files/text_lines.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

struct Unit {
    std::string_view keyword, unit;
};
constexpr std::array<Unit, 42> kNdmUnits = {{{"X", "km"},
                                             {"Y", "km"},
                                             {"Z", "km"},
                                             {"X_DOT", "km/s"},
                                             {"Y_DOT", "km/s"},
                                             {"Z_DOT", "km/s"},
                                             {"X_DDOT", "km/s**2"},
                                             {"Y_DDOT", "km/s**2"},
                                             {"Z_DDOT", "km/s**2"},
                                             {"Q1_DOT", "1/s"},
                                             {"Q2_DOT", "1/s"},
                                             {"Q3_DOT", "1/s"},
                                             {"QC_DOT", "1/s"},
                                             {"ANGVEL_X", "deg/s"},
                                             {"ANGVEL_Y", "deg/s"},
                                             {"ANGVEL_Z", "deg/s"},
                                             {"ANGLE_1", "deg"},
                                             {"ANGLE_2", "deg"},
                                             {"ANGLE_3", "deg"},
                                             {"ANGLE_1_DOT", "deg/s"},
                                             {"ANGLE_2_DOT", "deg/s"},
                                             {"ANGLE_3_DOT", "deg/s"},
                                             {"rotationAngles/rotation1", "deg"},
                                             {"rotationAngles/rotation2", "deg"},
                                             {"rotationAngles/rotation3", "deg"},
                                             {"rotationRates/rotation1", "deg/s"},
                                             {"rotationRates/rotation2", "deg/s"},
                                             {"rotationRates/rotation3", "deg/s"},
                                             {"SPIN_ALPHA", "deg"},
                                             {"SPIN_DELTA", "deg"},
                                             {"SPIN_ANGLE", "deg"},
                                             {"SPIN_ANGLE_VEL", "deg/s"},
                                             {"MEAN_MOTION", "rev/day"},
                                             {"INCLINATION", "deg"},
                                             {"RA_OF_ASC_NODE", "deg"},
                                             {"ARG_OF_PERICENTER", "deg"},
                                             {"MEAN_ANOMALY", "deg"},
                                             {"GM", "km**3/s**2"},
                                             {"SEMI_MAJOR_AXIS", "km"},
                                             {"BSTAR", "1/ER"},
                                             {"MEAN_MOTION_DOT", "rev/day**2"},
                                             {"MEAN_MOTION_DDOT", "rev/day**3"}}};

// The numbers of a data line in the order of KVN.
constexpr std::array<std::string_view, 6> kStateNumbers = {"X", "Y", "Z", "X_DOT", "Y_DOT", "Z_DOT"};
constexpr std::array<std::string_view, 34> kAttitudeNumbers = {"QC first",
                                                               "Q1",
                                                               "Q2",
                                                               "Q3",
                                                               "QC",
                                                               "QC_DOT first",
                                                               "Q1_DOT",
                                                               "Q2_DOT",
                                                               "Q3_DOT",
                                                               "QC_DOT",
                                                               "rotationAngles/rotation1",
                                                               "rotationAngles/rotation2",
                                                               "rotationAngles/rotation3",
                                                               "ANGLE_1",
                                                               "ANGLE_2",
                                                               "ANGLE_3",
                                                               "rotationRates/rotation1",
                                                               "rotationRates/rotation2",
                                                               "rotationRates/rotation3",
                                                               "ANGLE_1_DOT",
                                                               "ANGLE_2_DOT",
                                                               "ANGLE_3_DOT",
                                                               "X_RATE",
                                                               "Y_RATE",
                                                               "Z_RATE",
                                                               "ANGVEL_X",
                                                               "ANGVEL_Y",
                                                               "ANGVEL_Z",
                                                               "SPIN_ALPHA",
                                                               "SPIN_DELTA",
                                                               "SPIN_ANGLE",
                                                               "SPIN_ANGLE_VEL",
                                                               "NUTATION",
                                                               "NUTATION_PER"};
// No message nests its elements deeper.
constexpr int kDeepestData = 6;

// Returns a name without its namespace.
std::string_view local_name(const pugi::xml_node& node) {
    const std::string_view name = node.name();
    const std::size_t colon = name.find(':');
    return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

pugi::xml_node child_named(const pugi::xml_node& parent, std::string_view name) {
    for (const pugi::xml_node& node : parent.children())
        if (local_name(node) == name) return node;
    return {};
}

bool is_element(const pugi::xml_node& node) { return node.type() == pugi::node_element; }

struct Word {
    std::string_view kind, version;
};
Word word_of(NdmKind kind) {
    switch (kind) {
        case NdmKind::kAem:
            return {"aem", "CCSDS_AEM_VERS"};
        case NdmKind::kOmm:
            return {"omm", "CCSDS_OMM_VERS"};
        case NdmKind::kOem:
            break;
    }
    return {"oem", "CCSDS_OEM_VERS"};
}

class Unroller {
  public:
    Unroller(std::string_view xml, const std::string& name, NdmKind kind)
        : xml_(xml), name_(name), kind_(kind) {}

    NdmText unroll() {
        if (xml_.size() > kMaxNdmXmlBytes)
            throw InputError(name_ + ": has " + std::to_string(xml_.size()) +
                             " bytes of XML; accepted: at most " + std::to_string(kMaxNdmXmlBytes));
        const pugi::xml_parse_result parsed = document_.load_buffer(xml_.data(), xml_.size());
        if (!parsed) fail(parsed.offset, std::string("is no XML: ") + parsed.description());
        const pugi::xml_node root = document_.document_element();
        if (local_name(root) == word_of(kind_).kind) add_message(root);
        if (local_name(root) == "ndm")
            for (const pugi::xml_node& message : root.children())
                if (local_name(message) == word_of(kind_).kind) add_message(message);
        if (out_.text.empty())
            fail(root.offset_debug(), "found the element " + in_quotes(root.name()) + " without <" +
                                          std::string(word_of(kind_).kind) + "> in it; accepted: <" +
                                          std::string(word_of(kind_).kind) + "> or an <ndm> of such");
        return std::move(out_);
    }

  private:
    std::string_view xml_;
    const std::string& name_;
    NdmKind kind_;
    pugi::xml_document document_;
    NdmText out_;
    // Lines are counted as elements are met, which is in the file's order.
    std::size_t counted_ = 0;
    int line_ = 1;

    int line_at(std::ptrdiff_t offset) {
        const std::size_t to =
            std::min(xml_.size(), static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)));
        if (to < counted_) counted_ = 0, line_ = 1;
        line_ += static_cast<int>(std::count(xml_.begin() + static_cast<std::ptrdiff_t>(counted_),
                                             xml_.begin() + static_cast<std::ptrdiff_t>(to), '\n'));
        counted_ = to;
        return line_;
    }
    [[noreturn]] void fail(std::ptrdiff_t offset, const std::string& what) {
        throw InputError(name_ + ":" + std::to_string(line_at(offset)) + ": " + what);
    }

    void add_line(const pugi::xml_node& node, std::string line) {
        for (char& c : line)
            if (static_cast<unsigned char>(c) < ' ') c = ' ';
        out_.text += line + '\n';
        out_.lines.push_back(line_at(node.offset_debug()));
    }

    void add_message(const pugi::xml_node& message) {
        const Word word = word_of(kind_);
        // The segments of several messages are read as those of one.
        if (out_.text.empty() || kind_ == NdmKind::kOmm) {
            add_line(message, std::string(word.version) + " = " + message.attribute("version").value());
            add_keywords(child_named(message, "header"));
        }
        const pugi::xml_node body = child_named(message, "body");
        bool any = false;
        for (const pugi::xml_node& segment : body.children())
            if (local_name(segment) == "segment") add_segment(segment), any = true;
        if (!any) fail(message.offset_debug(), "the message has no <segment> in a <body>");
    }

    void add_segment(const pugi::xml_node& segment) {
        const pugi::xml_node metadata = child_named(segment, "metadata"), data = child_named(segment, "data");
        if (!metadata || !data) fail(segment.offset_debug(), "the segment has no <metadata> and <data>");
        if (kind_ == NdmKind::kOmm) {
            add_keywords(metadata);
            for (const pugi::xml_node& block : data.children()) add_keywords(block);
            return;
        }
        add_line(segment, "META_START");
        add_keywords(metadata);
        add_line(data, "META_STOP");
        if (kind_ == NdmKind::kAem) add_line(data, "DATA_START");
        const std::string_view scalar = child_named(metadata, "QUATERNION_TYPE").child_value();
        const bool first = is_unit(trimmed(scalar), "FIRST");
        for (const pugi::xml_node& state : data.children())
            if (is_element(state) && local_name(state) != "COMMENT" &&
                local_name(state) != "covarianceMatrix")
                add_state(state, first);
        if (kind_ == NdmKind::kAem) add_line(data, "DATA_STOP");
    }

    // Adds the elements of a block as keywords; blocks of an OMM without any that SGP4 needs are skipped.
    void add_keywords(const pugi::xml_node& block) {
        const std::string_view name = local_name(block);
        if (name == "covarianceMatrix" || name == "userDefinedParameters" || name == "COMMENT") return;
        for (const pugi::xml_node& node : block.children()) {
            const std::string_view key = local_name(node);
            if (!is_element(node) || key == "COMMENT" || key == "USER_DEFINED") continue;
            const std::string value(trimmed_all(node.child_value()));
            check_unit(node, key);
            if (!value.empty()) add_line(node, std::string(key) + " = " + value);
        }
    }

    static std::string_view trimmed_all(std::string_view text) {
        const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
        while (!text.empty() && blank(text.front())) text.remove_prefix(1);
        while (!text.empty() && blank(text.back())) text.remove_suffix(1);
        return text;
    }

    void check_unit(const pugi::xml_node& node, std::string_view key) {
        const pugi::xml_attribute units = node.attribute("units");
        const std::string_view unit = unit_of_keyword(key);
        if (units && !unit.empty() && !is_unit(units.value(), unit))
            fail(node.offset_debug(), std::string(key) + ": found units " + in_quotes(units.value()) +
                                          "; accepted: " + std::string(unit));
    }

    struct Number {
        std::size_t rank;
        std::string_view text;
    };
    // Collects the numbers below an element, and its epoch.
    void collect(const pugi::xml_node& parent, bool first, int depth, std::string_view& epoch,
                 std::vector<Number>& numbers) {
        if (depth > kDeepestData)
            fail(parent.offset_debug(), "elements of data stand in each other too deep");
        for (const pugi::xml_node& node : parent.children()) {
            const std::string_view name = local_name(node);
            if (!is_element(node) || name == "COMMENT") continue;
            if (is_element(node.first_child())) {
                collect(node, first, depth + 1, epoch, numbers);
                continue;
            }
            const std::string_view text = trimmed_all(node.child_value());
            if (text.empty() || text.find_first_of(" \t\r\n") != std::string_view::npos)
                fail(node.offset_debug(),
                     std::string(name) + ": found " + in_quotes(text) + "; accepted: one value");
            if (name == "EPOCH") {
                epoch = text;
                continue;
            }
            std::string key(name);
            if (name.starts_with("rotation")) key = std::string(local_name(parent)) + "/" + key;
            check_unit(node, key);
            if (first && (name == "QC" || name == "QC_DOT")) key += " first";
            if (const auto rank = rank_of(key)) numbers.push_back({*rank, text});
            // Parts of a state that are not used, the accelerations, are left out.
            else if (kind_ == NdmKind::kAem)
                fail(node.offset_debug(),
                     "found the element " + in_quotes(name) + "; accepted: those of attitudes by 504.0-B");
        }
    }

    std::optional<std::size_t> rank_of(std::string_view key) const {
        const auto find = [&](const auto& names) -> std::optional<std::size_t> {
            const auto at = std::find(names.begin(), names.end(), key);
            if (at == names.end()) return {};
            return static_cast<std::size_t>(at - names.begin());
        };
        return kind_ == NdmKind::kOem ? find(kStateNumbers) : find(kAttitudeNumbers);
    }

    void add_state(const pugi::xml_node& state, bool first) {
        std::string_view epoch;
        std::vector<Number> numbers;
        collect(state, first, 0, epoch, numbers);
        std::stable_sort(numbers.begin(), numbers.end(),
                         [](const Number& a, const Number& b) { return a.rank < b.rank; });
        for (std::size_t i = 1; i < numbers.size(); ++i)
            if (numbers[i].rank == numbers[i - 1].rank)
                fail(state.offset_debug(), "a number of the state that begins here is given twice");
        if (epoch.empty()) fail(state.offset_debug(), "the state that begins here has no EPOCH");
        if (kind_ == NdmKind::kOem && numbers.size() != kStateNumbers.size())
            fail(state.offset_debug(), "the state that begins here has " + std::to_string(numbers.size()) +
                                           " of X, Y, Z, X_DOT, Y_DOT, Z_DOT; accepted: all six");
        std::string line(epoch);
        for (const Number& number : numbers) line += ' ' + std::string(number.text);
        add_line(state, line);
    }
};

}  // namespace

bool is_xml(std::string_view text) {
    const std::size_t at = text.find_first_not_of(" \t\r\n");
    return at != std::string_view::npos && text[at] == '<';
}

NdmText kvn_of_xml(std::string_view xml, const std::string& name, NdmKind kind) {
    return Unroller(xml, name, kind).unroll();
}

std::string_view unit_of_keyword(std::string_view key) {
    for (const Unit& unit : kNdmUnits)
        if (unit.keyword == key) return unit.unit;
    return {};
}

bool is_unit(std::string_view found, std::string_view unit) {
    const auto upper = [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; };
    return std::equal(found.begin(), found.end(), unit.begin(), unit.end(),
                      [&](char a, char b) { return upper(a) == upper(b); });
}

}  // namespace hilcam
