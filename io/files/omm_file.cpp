#include "io/files/omm_file.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "io/files/ccsds_message.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr double kDay_min = 1440, kOmmDay_s = 86400;
// The standard has fewer keywords.
constexpr std::size_t kMaxKeywords = 200;

// The keywords of one message.
class Keywords {
  public:
    explicit Keywords(std::string where) : where_(std::move(where)) {}

    // A keyword without a value counts as missing: CelesTrak's headers have such ones.
    void add(std::string_view key, std::string_view value) {
        if (value.empty() || key == "COMMENT") return;
        if (entries_.size() == kMaxKeywords) throw InputError(where_ + ": has more than 200 keywords");
        if (find(key)) throw InputError(where_ + ": " + in_quotes(key) + " is given twice");
        entries_.push_back({std::string(key), std::string(value), 0});
    }
    const KvnEntry* find(std::string_view key) const {
        const auto at =
            std::find_if(entries_.begin(), entries_.end(), [&](const KvnEntry& e) { return e.key == key; });
        return at == entries_.end() ? nullptr : &*at;
    }
    std::string text(std::string_view key) const {
        const KvnEntry* const entry = find(key);
        return entry ? entry->value : std::string();
    }
    bool empty() const { return entries_.empty(); }
    const std::string& where() const { return where_; }

  private:
    std::string where_;
    std::vector<KvnEntry> entries_;
};

class OmmReader {
  public:
    explicit OmmReader(const Keywords& keywords) : keywords_(keywords) {}

    ElementSet read() {
        out_.where = keywords_.where();
        out_.name = keywords_.text("OBJECT_NAME");
        out_.designator = keywords_.text("OBJECT_ID");
        out_.satellite = keywords_.text("NORAD_CAT_ID");
        if (out_.satellite.empty()) out_.satellite = out_.designator;
        if (out_.satellite.empty()) fail("has no NORAD_CAT_ID and no OBJECT_ID");
        read_epoch();
        out_.refusal = refusal();
        if (out_.refusal.empty()) read_elements();
        return std::move(out_);
    }

  private:
    const Keywords& keywords_;
    ElementSet out_;

    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(keywords_.where() + ": the message" +
                         (out_.satellite.empty() ? "" : " of satellite " + in_quotes(out_.satellite)) + " " +
                         what);
    }
    [[noreturn]] void refuse(const std::string& key, std::string_view found,
                             const std::string& accepted) const {
        const std::string odd = odd_blank_in(found);
        throw InputError(keywords_.where() + ": " + key + ": found " + in_quotes(found) +
                         (odd.empty() ? "" : ", which has " + odd) + "; accepted: " + accepted);
    }
    const KvnEntry& require(const std::string& key) const {
        const KvnEntry* const entry = keywords_.find(key);
        if (!entry) fail("has no " + key + "; accepted: the mean elements of SGP4");
        return *entry;
    }

    double number(const std::string& key, double least, double most, const std::string& accepted) const {
        const std::string text = without_unit(keywords_.where(), require(key));
        const auto value = fortran_number_of(text);
        if (!value || *value < least || *value > most) refuse(key, text, accepted);
        return *value;
    }
    double angle_rad(const std::string& key) const {
        return number(key, -360, 360, "-360 to 360 deg") * kDegree_rad;
    }

    void read_epoch() {
        std::string text = require("EPOCH").value;
        // Older exports of Space-Track have a blank between date and time.
        if (text.size() > 10 && text[10] == ' ') text[10] = 'T';
        const std::optional<CalendarTime> date = ccsds_calendar(text);
        const std::optional<TimeTai> epoch =
            date ? from_calendar(*date, TimeSystem::kUtc) : std::optional<TimeTai>();
        if (!epoch) refuse("EPOCH", text, "an epoch as 2026-03-20T12:00:00.000000, of 1950 to 2200");
        out_.epoch = *epoch;
        out_.epoch_days_1950 =
            days_since_1950(date->year, date->month, date->day,
                            (date->hour * 3600 + date->minute * 60 + date->second) / kOmmDay_s);
    }

    // Returns why SGP4 cannot use the set; empty: it can.
    std::string refusal() const {
        const std::string theory = keywords_.text("MEAN_ELEMENT_THEORY");
        constexpr std::array<std::string_view, 4> kTheories = {"SGP4", "SGP/SGP4", "SDP4", "SGP4/SDP4"};
        const bool known = std::any_of(kTheories.begin(), kTheories.end(),
                                       [&](std::string_view t) { return is_word(theory, t); });
        if (!theory.empty() && !known)
            return "is of MEAN_ELEMENT_THEORY " + in_quotes(theory) +
                   ", which is no set for SGP4; accepted: SGP4, SGP/SGP4";
        if (const std::string type = refusal_of_ephemeris_type(keywords_.text("EPHEMERIS_TYPE"));
            !type.empty())
            return type;
        return wrong("CENTER_NAME", {"EARTH"}) + wrong("REF_FRAME", {"TEME", "TEMEOFDATE"}) +
               wrong("TIME_SYSTEM", {"UTC"}) + wrong("REF_FRAME_EPOCH", {});
    }
    std::string wrong(const std::string& key, const std::vector<std::string_view>& accepted) const {
        const std::string found = keywords_.text(key);
        if (found.empty() || std::any_of(accepted.begin(), accepted.end(),
                                         [&](std::string_view a) { return is_word(found, a); }))
            return {};
        return "has " + key + " " + in_quotes(found) + "; accepted: " +
               (accepted.empty() ? "none, as SGP4's axes are of date" : std::string(accepted.front())) + ". ";
    }

    void read_elements() {
        out_.bstar_per_er = number("BSTAR", -1e9, 1e9, "drag (B*), -1e9 to 1e9 per Earth radius");
        out_.eccentricity = number("ECCENTRICITY", 0, 0.9999999, "0 to below 1");
        out_.inclination_rad = number("INCLINATION", 0, 180, "0 to 180 deg") * kDegree_rad;
        out_.node_rad = angle_rad("RA_OF_ASC_NODE");
        out_.perigee_rad = angle_rad("ARG_OF_PERICENTER");
        out_.mean_anomaly_rad = angle_rad("MEAN_ANOMALY");
        const double turns_day = number("MEAN_MOTION", 1e-8, 20, "above 0 to 20 turns a day");
        out_.mean_motion_rad_min = turns_day * 2 * kPi / kDay_min;
    }
};

std::vector<ElementSet> read_kvn(std::string_view text, const std::string& name) {
    KvnLines lines(text, name, NdmKind::kOmm);
    std::vector<ElementSet> sets;
    std::optional<Keywords> keywords;
    const auto finish = [&] {
        if (keywords) sets.push_back(OmmReader(*keywords).read());
    };
    for (KvnLine line; lines.next(line);) {
        if (line.key.empty()) lines.refuse(line.text, "KEY = VALUE");
        if (line.key == "CCSDS_OMM_VERS") {
            if (line.value != "2.0" && line.value != "3.0")
                lines.refuse(line.value, "CCSDS_OMM_VERS 2.0 or 3.0");
            finish();
            keywords.emplace(name + ":" + std::to_string(lines.number()));
        } else if (!keywords) {
            lines.refuse(line.text, "CCSDS_OMM_VERS = 2.0 or 3.0 first");
        } else {
            keywords->add(line.key, line.value);
        }
    }
    finish();
    return sets;
}

// Returns the fields of a line (RFC 4180): a field in double quotes may have commas, and doubled quotes for
// one.
std::vector<std::string> csv_fields(const TextLines& lines, std::string_view line) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        if (quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"') {
            fields.back() += line[++i];
        } else if (c == '"') {
            quoted = !quoted;
        } else if (c == ',' && !quoted) {
            if (fields.size() == kMaxKeywords) lines.fail("the line has more than 200 fields");
            fields.emplace_back();
        } else {
            fields.back() += c;
        }
    }
    if (quoted) lines.fail("a double quote has no second one in its line");
    for (std::string& field : fields) field = std::string(trimmed(field));
    return fields;
}

std::vector<ElementSet> read_csv(std::string_view text, const std::string& name) {
    TextLines lines(text, name);
    std::vector<ElementSet> sets;
    std::vector<std::string> names;
    for (std::string_view line; lines.next(line);) {
        if (trimmed(line).empty()) continue;
        const std::vector<std::string> fields = csv_fields(lines, line);
        if (names.empty()) {
            names = fields;
            continue;
        }
        if (fields.size() != names.size())
            lines.fail("found " + std::to_string(fields.size()) +
                       " fields; accepted: " + std::to_string(names.size()) + ", as the first line has");
        Keywords keywords(name + ":" + std::to_string(lines.number()));
        for (std::size_t i = 0; i < names.size(); ++i) keywords.add(names[i], fields[i]);
        sets.push_back(OmmReader(keywords).read());
    }
    return sets;
}

// Takes the objects of a text as they come, without a tree, because input may be nested deeply.
class JsonSets : public nlohmann::json_sax<nlohmann::json> {
  public:
    explicit JsonSets(const std::string& name) : name_(name) {}
    std::vector<ElementSet> take() { return std::move(sets_); }

    bool null() override { return value(""); }
    bool boolean(bool on) override { return value(on ? "true" : "false"); }
    bool number_integer(number_integer_t number) override { return value(std::to_string(number)); }
    bool number_unsigned(number_unsigned_t number) override { return value(std::to_string(number)); }
    bool number_float(number_float_t, const string_t& text) override { return value(text); }
    bool string(string_t& text) override { return value(trimmed(text)); }
    bool binary(binary_t&) override { return false; }
    bool start_array(std::size_t) override {
        if (array_ || keywords_) refuse("an array inside");
        array_ = true;
        return true;
    }
    bool end_array() override { return true; }
    bool start_object(std::size_t) override {
        if (keywords_) refuse("an object inside");
        keywords_.emplace(name_ + ": set " + std::to_string(sets_.size() + 1));
        return true;
    }
    bool key(string_t& text) override {
        key_ = text;
        return true;
    }
    bool end_object() override {
        sets_.push_back(OmmReader(*keywords_).read());
        keywords_.reset();
        return true;
    }
    bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception&) override {
        throw InputError(name_ + ": is no JSON from its byte " + std::to_string(position) + " on");
    }

  private:
    const std::string& name_;
    std::vector<ElementSet> sets_;
    std::optional<Keywords> keywords_;
    std::string key_;
    bool array_ = false;

    [[noreturn]] void refuse(const std::string& what) const {
        throw InputError(name_ + ": set " + std::to_string(sets_.size() + 1) + ": found " + what +
                         "; accepted: an object of keywords and values, or an array of such");
    }
    bool value(std::string_view text) {
        if (!keywords_) refuse("a value");
        keywords_->add(key_, text);
        return true;
    }
};

std::vector<ElementSet> read_json(std::string_view text, const std::string& name) {
    JsonSets sets(name);
    nlohmann::json::sax_parse(text.begin(), text.end(), &sets);
    return sets.take();
}

}  // namespace

std::optional<OmmForm> omm_form_of(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    if (is_xml(text)) return OmmForm::kXml;
    const std::size_t at = text.find_first_not_of(" \t\r\n");
    if (at == std::string_view::npos) return {};
    text.remove_prefix(at);
    if (text.starts_with("CCSDS_")) return OmmForm::kKvn;
    const std::string_view first = text.substr(0, text.find_first_of("\r\n"));
    // A satellite's name may begin with a bracket.
    const std::size_t next = text.find_first_not_of(" \t\r\n", 1);
    const char after = next == std::string_view::npos ? '\0' : text[next];
    if ((text[0] == '{' && after == '"') || (text[0] == '[' && (after == '{' || after == '[')))
        return OmmForm::kJson;
    if (first.find(',') != std::string_view::npos && first.find("MEAN_MOTION") != std::string_view::npos)
        return OmmForm::kCsv;
    return {};
}

std::vector<ElementSet> read_omm(std::string_view text, const std::string& name, OmmForm form) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    std::vector<ElementSet> sets = form == OmmForm::kJson  ? read_json(text, name)
                                   : form == OmmForm::kCsv ? read_csv(text, name)
                                                           : read_kvn(text, name);
    if (sets.empty()) throw InputError(name + ": holds no orbit mean-elements message (CCSDS OMM)");
    return sets;
}

}  // namespace hilcam
