#include "io/config/config_yaml.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>

#include "io/config/config_advice.h"
#include "io/config/config_manual.h"
#include "io/config/open_bracket.h"
#include "io/config/second_document.h"
#include "io/system/input_file.h"
#include "io/system/program_files.h"
#include "io/system/shipped_parts.h"
#include "io/system/text_mark.h"
#include "io/system/text_number.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/overloaded.h"
#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

const InputKind kYamlFile{4u << 20, "a YAML file"};
constexpr int kDeepest = 16;
// The library has the same words for each of these.
constexpr const char* kYamlRules =
    " (tabs are not allowed; a space comes after the colon; the keys of one mapping begin in one column)";

// The place of a value: in a file, or on the command line.
struct Place {
    std::string name;  // file, or "--set KEY"
    std::filesystem::path folder;
    bool command_line = false;
};

std::string show(const YAML::Node& node) {
    if (!node.IsDefined() || node.IsNull()) return "nothing";
    if (node.IsScalar()) return in_quotes(node.Scalar());
    return node.IsMap() ? "a mapping" : "a list of " + std::to_string(node.size());
}

std::optional<double> to_number(const YAML::Node& node) {
    return node.IsScalar() ? number_of(node.Scalar()) : std::nullopt;
}

// A word that stands in the place of a number or a list.
bool is_word(const YAML::Node& node, const std::string& word) {
    return !word.empty() && node.IsScalar() && node.Scalar() == word;
}
std::string in_place_of(const std::string& accepted, const std::string& word) {
    return word.empty() ? accepted : accepted + ", or '" + word + "'";
}

// Returns what a word means by YAML 1.1 (the type "bool"; without y and n, which PyYAML leaves words): scripts that read a file by it and write it
// again have true where it had `on`.
std::optional<bool> to_flag(const std::string& word) {
    for (const bool value : {true, false})
        for (const char* known : {value ? "true" : "false", value ? "yes" : "no", value ? "on" : "off"}) {
            const std::string small = known;
            std::string first = small, capitals = small;
            first[0] = static_cast<char>(std::toupper(first[0]));
            for (char& c : capitals) c = static_cast<char>(std::toupper(c));
            if (word == small || word == first || word == capitals) return value;
        }
    return {};
}

// The key as a section has it: `on` where a script wrote true.
std::string known_key(const std::string& key, const Fields& known) {
    const auto is_known = [&](std::string_view word) {
        return std::any_of(known.begin(), known.end(), [&](const Field& f) { return f.key == word; });
    };
    const std::optional<bool> flag = is_known(key) ? std::nullopt : to_flag(key);
    return flag && is_known(*flag ? "on" : "off") ? (*flag ? "on" : "off") : key;
}

// The value of a section's key.
YAML::Node value_of(const YAML::Node& map, const std::string& key, const Fields& known) {
    if (const YAML::Node own = map[key]; own.IsDefined() || !to_flag(key)) return own;
    for (const auto& entry : map)
        if (entry.first.IsScalar() && known_key(entry.first.Scalar(), known) == key) return entry.second;
    return YAML::Node(YAML::NodeType::Undefined);
}

// A whole number, which scripts may write as a decimal (256.0, 2.56e2).
std::optional<std::int64_t> to_whole(const std::string& text) {
    if (const auto value = parsed_as<std::int64_t>(text)) return value;
    constexpr double kExact = 9007199254740992;  // 2^53: each whole number up to it is a double
    const auto value = number_of(text);
    if (!value || std::abs(*value) > kExact || *value != std::floor(*value)) return {};
    return static_cast<std::int64_t>(*value);
}

struct Override {
    std::string path;
    YAML::Node value;
    bool used = false;
};

class Reader {
  public:
    Reader(const Fields& root, std::span<const std::string> overrides, KeyPlaces* places = nullptr)
        : root_(root), places_(places) {
        for (const std::string& text : overrides) add_override(text);
    }

    void read_file(const std::filesystem::path& file, const SectionField& section, const std::string& path,
                   int depth) {
        in_file(file, path, [&](const YAML::Node& node, const Place& place) {
            read_section(node, place, section, path, depth);
        });
    }

    void read_text(std::string_view text, const Place& place, const SectionField& section,
                   const std::string& path, int depth) {
        read_section(mapping_in(text, place, path), place, section, path, depth);
    }

    static YAML::Node only_document(std::string_view bytes, const Place& place) {
        const std::string text = in_utf8(bytes);
        if (const auto line = line_of_second_document(text))
            throw InputError(place.name + ":" + std::to_string(*line) +
                             ":1: a second document ('---') begins here; accepted: one a file");
        try {
            // An alias makes one node stand in many places; without any there is nothing to blow up.
            return YAML::Load(text);
        } catch (const YAML::Exception& error) {
            const std::string open = unpaired_bracket(text);
            throw InputError(place.name + ":" + std::to_string(error.mark.line + 1) + ":" +
                             std::to_string(error.mark.column + 1) + ": not YAML: " + shortened(error.msg) +
                             (open.empty() ? kYamlRules : "; " + open));
        }
    }

    void require_all_overrides_used() const {
        for (const Override& o : overrides_)
            if (!o.used) throw InputError("--set " + shortened(o.path) + ": " + why_unused(o.path, root_));
    }

  private:
    const Fields& root_;
    KeyPlaces* places_;
    std::vector<Override> overrides_;
    std::vector<std::filesystem::path> open_files_;
    std::size_t nodes_ = 0;
    std::size_t numbers_ = 0;

    // Has `use` read what a file holds.
    template <class Use>
    void in_file(const std::filesystem::path& file, const std::string& path, const Use& use) {
        std::error_code error;
        const auto canonical = std::filesystem::weakly_canonical(file, error);
        if (std::find(open_files_.begin(), open_files_.end(), canonical) != open_files_.end())
            throw InputError(file.string() + ": the file includes itself");
        const std::string text = read_input_file(file, kYamlFile);
        open_files_.push_back(canonical);
        const Place place{file.string(), file.parent_path()};
        use(mapping_in(text, place, path), place);
        open_files_.pop_back();
    }

    static YAML::Node mapping_in(std::string_view text, const Place& place, const std::string& path) {
        const YAML::Node node = only_document(text, place);
        if (!node.IsMap()) fail(place, node, path, "found " + show(node) + "; accepted: a mapping of keys");
        return node;
    }

    // file:line:column
    static std::string where(const Place& place, const YAML::Node& node) {
        const YAML::Mark mark = node.IsDefined() ? node.Mark() : YAML::Mark::null_mark();
        if (place.command_line || mark.is_null()) return place.name;
        return place.name + ":" + std::to_string(mark.line + 1) + ":" + std::to_string(mark.column + 1);
    }
    [[noreturn]] static void fail(const Place& place, const YAML::Node& node, const std::string& path,
                                  const std::string& what) {
        throw InputError(where(place, node) + ": " + (path.empty() || place.command_line ? "" : path + ": ") +
                         what);
    }

    // Follows an override's path down the sections until a word is unknown.
    std::string why_unused(std::string_view path, const Fields& known) const {
        const std::string_view word = path.substr(0, path.find('.'));
        const auto field =
            std::find_if(known.begin(), known.end(), [&](const Field& f) { return f.key == word; });
        if (field == known.end()) return "unknown key" + advice_for(word, known, root_);
        if (std::holds_alternative<SectionsField>(field->target))
            return "the list '" + field->key + "' has no such element in the file";
        const std::optional<SectionField> nested = section_in(*field);
        if (!nested || word.size() == path.size()) return "'" + field->key + "' has no keys below it";
        return why_unused(path.substr(word.size() + 1), nested->fields);
    }

    void add_override(const std::string& text) {
        const auto equals = text.find('=');
        if (equals == std::string::npos || equals == 0)
            throw InputError("--set " + shortened(text) +
                             ": accepted: KEY=VALUE, as --set camera.exposure_ms=2");
        try {
            overrides_.push_back({text.substr(0, equals), YAML::Load(text.substr(equals + 1))});
        } catch (const YAML::Exception& error) {
            throw InputError("--set " + shortened(text.substr(0, equals)) +
                             ": not YAML: " + shortened(error.msg));
        }
    }

    // The last override of a key counts, so that a script's user can change what the script sets.
    Override* override_at(const std::string& path) {
        Override* last = nullptr;
        for (Override& o : overrides_)
            if (o.path == path) o.used = true, last = &o;
        return last;
    }
    bool override_below(const std::string& path) const {
        return std::any_of(overrides_.begin(), overrides_.end(),
                           [&](const Override& o) { return o.path.starts_with(path + "."); });
    }
    static std::string join(const std::string& path, const std::string& key) {
        return path.empty() ? key : path + "." + key;
    }

    // What a file names: from that one's folder; where nothing is there, the shipped file of that path, or the
    // shipped part of that name, where the key takes one. What a shipped file names and is not shipped is the
    // user's: a mesh to bring, a folder to write to. It lies in the working directory.
    static std::filesystem::path found_from(const Place& place, const std::string& name,
                                            const std::string& key) {
        std::filesystem::path own = place.folder / name;
        std::error_code error;
        if (std::filesystem::exists(own, error)) return own;
        std::filesystem::path shipped = shipped_file(name);
        if (!shipped.empty()) return shipped;
        if (const ShippedKind* const kind = kind_of_key(key)) shipped = shipped_part(*kind, name);
        if (!shipped.empty()) return shipped;
        return is_shipped(place.folder) ? std::filesystem::current_path() / name : own;
    }

    void count_node(const Place& place, const YAML::Node& node, const std::string& path, int depth) {
        if (++nodes_ > 200000) fail(place, node, path, "the configuration has more than 200000 values");
        if (depth > kDeepest)
            fail(place, node, path, "nested deeper than " + std::to_string(kDeepest) + " levels");
    }

    // Through an alias a list of thousands may stand in thousands of places. 4 MiB of pairs as people write
    // them are half a million numbers.
    void count_number(const Place& place, const YAML::Node& node, const std::string& path) {
        if (++numbers_ > 1000000)
            fail(place, node, path, "the configuration has more than 1000000 numbers in its lists");
    }

    void read_section(const YAML::Node& map, const Place& place, const SectionField& section,
                      const std::string& path, int depth) {
        count_node(place, map, path, depth);
        refuse_unknown_keys(map, place, section.fields, path);
        std::vector<const Field*> given_fields;
        for (const Field& field : section.fields) {
            const std::string field_path = join(path, field.key);
            const Override* override = override_at(field_path);
            // yaml-cpp's nodes are references: one is only ever made, never assigned.
            const YAML::Node given = override ? override->value : value_of(map, field.key, section.fields);
            const bool absent = !given.IsDefined() || given.IsNull();
            const bool opened = absent && holds_section(field) && override_below(field_path);
            if (absent && !opened) {
                if (field.required)
                    fail(place, map, field_path, "the key is missing; it is " + field.meaning);
                continue;
            }
            given_fields.push_back(&field);
            if (field.present) *field.present = true;
            const Place value_place =
                override ? Place{"--set " + field_path, std::filesystem::current_path(), true} : place;
            read_value(opened ? YAML::Node(YAML::NodeType::Map) : given, value_place, field, field_path,
                       depth);
        }
        try {
            for (const Field* field : given_fields)
                if (const std::string why = field->why_idle ? field->why_idle() : ""; !why.empty())
                    throw KeyError(field->key, why);
            if (section.validate) section.validate();
        } catch (const KeyError& error) {
            fail_at_key(place, map, path, error);
        } catch (const InputError& error) {
            const std::string what = error.what();
            const std::size_t said = said_of_path(path, what), colon = what.find(": ", said);
            if (said == 0 || colon == std::string::npos) fail(place, map, path, what);
            fail_at_key(place, map, path, {what.substr(said, colon - said), what.substr(colon + 2)});
        }
    }

    // A check that names its key from the top says the way to it already. Returns how many letters of the text are that way:
    // all of the path, or of a further camera's its end ("outputs.preview." of "cameras.0.outputs.preview").
    static std::size_t said_of_path(std::string_view path, std::string_view text) {
        while (!path.empty()) {
            if (text.starts_with(path) && text.substr(path.size()).starts_with('.')) return path.size() + 1;
            const std::size_t dot = path.find('.');
            path = dot == path.rfind('.') ? std::string_view() : path.substr(dot + 1);
        }
        return 0;
    }

    // Fails where the key stands, or at as much of the way to it as there is in this file or on the command
    // line.
    [[noreturn]] void fail_at_key(const Place& place, const YAML::Node& map, const std::string& path,
                                  const KeyError& error) {
        const std::string key = error.key().substr(said_of_path(path, error.key()));
        const std::string whole = join(path, key);
        for (const Override& o : overrides_)
            if (whole == o.path || whole.starts_with(o.path + "."))
                throw InputError("--set " + whole + ": " + error.reason());
        std::vector<YAML::Node> way = {map};
        std::istringstream words(key);
        for (std::string word; std::getline(words, word, '.');) {
            const YAML::Node& at = way.back();
            const YAML::Node next = at.IsMap()        ? at[word]
                                    : at.IsSequence() ? at[std::strtoul(word.c_str(), nullptr, 10)]
                                                      : YAML::Node(YAML::NodeType::Undefined);
            if (!next.IsDefined()) break;
            way.push_back(next);
        }
        fail(place, way.back(), whole, error.reason());
    }

    void refuse_unknown_keys(const YAML::Node& map, const Place& place, const Fields& known,
                             const std::string& path) const {
        std::vector<std::string> seen;
        for (const auto& entry : map) {
            const std::string key =
                entry.first.IsScalar() ? known_key(entry.first.Scalar(), known) : std::string("(not a word)");
            if (std::none_of(known.begin(), known.end(), [&](const Field& f) { return f.key == key; }))
                fail(place, entry.first, join(path, shortened(key)),
                     "unknown key" + advice_for(key, known, root_));
            if (std::find(seen.begin(), seen.end(), key) != seen.end())
                fail(place, entry.first, join(path, shortened(key)), "the key is given twice");
            seen.push_back(key);
        }
    }

    void read_value(const YAML::Node& node, const Place& place, const Field& field, const std::string& path,
                    int depth) {
        count_node(place, node, path, depth);
        if (places_) places_->note(path, where(place, node));
        const auto refuse = [&](const YAML::Node& at, const std::string& accepted,
                                const std::string& advice = "") {
            fail(place, at, path,
                 "found " + show(at) + "; accepted: " + accepted + " (" + field.meaning + ")" + advice);
        };
        // column: of a table.
        const auto number = [&](const YAML::Node& at, const Range& range, std::string_view column = {}) {
            count_number(place, at, path);
            const std::optional<double> value = to_number(at);
            if (!value || *value < range.least || *value > range.most)
                refuse(at, "a number, " + accepted(range),
                       value ? unit_advice(column.empty() ? field.key : column, *value, range) : "");
            return *value;
        };
        const auto list = [&](std::size_t fewest, std::size_t most) {
            if (!node.IsSequence() || node.size() < fewest || node.size() > most)
                refuse(node, "a list of " +
                                 (fewest == most ? std::to_string(most)
                                                 : std::to_string(fewest) + " to " + std::to_string(most)) +
                                 " numbers");
        };
        std::visit(
            Overloaded{
                [&](const NumberField& f) {
                    if (is_word(node, f.word))
                        *f.value = f.word_value;
                    else if (!f.word.empty() && !to_number(node))
                        refuse(node, in_place_of("a number, " + accepted(f.range), f.word));
                    else
                        *f.value = number(node, f.range) * f.si_per_unit;
                },
                [&](const IntegerField& f) { *f.value = integer(node, f.range, refuse); },
                [&](const FlagField& f) {
                    const std::optional<bool> flag = node.IsScalar() ? to_flag(node.Scalar()) : std::nullopt;
                    if (!flag) refuse(node, "true or false");
                    *f.value = *flag;
                },
                [&](const TextField& f) {
                    if (!node.IsScalar()) refuse(node, "a text");
                    *f.value = node.Scalar();
                },
                [&](const TextsField& f) {
                    if (!node.IsScalar() && !node.IsSequence()) refuse(node, "a list of texts");
                    std::vector<std::string> list_of_texts;
                    if (node.IsScalar()) list_of_texts.push_back(node.Scalar());
                    for (const auto& item : node) {
                        count_number(place, item, path);
                        if (!item.IsScalar()) refuse(item, "a text");
                        list_of_texts.push_back(item.Scalar());
                    }
                    *f.value = list_of_texts;
                },
                [&](const PathField& f) {
                    if (!node.IsScalar() || node.Scalar().empty()) refuse(node, "a path");
                    *f.value = found_from(place, node.Scalar(), path);
                    if (f.where) *f.where = where(place, node) + (place.command_line ? "" : ": " + path);
                },
                [&](const ChoiceField& f) {
                    // free-run is as good as free_run.
                    std::string given = node.IsScalar() ? node.Scalar() : "";
                    std::replace(given.begin(), given.end(), '-', '_');
                    auto word = std::find(f.words.begin(), f.words.end(), given);
                    // A script that read `off` may have written false.
                    if (word == f.words.end())
                        word = std::find_if(f.words.begin(), f.words.end(), [&](const std::string& w) {
                            return to_flag(w) && to_flag(w) == to_flag(given);
                        });
                    if (word == f.words.end()) {
                        std::string words;
                        for (const std::string& w : f.words) words += (words.empty() ? "" : " | ") + w;
                        refuse(node, words);
                    }
                    f.set(static_cast<std::size_t>(word - f.words.begin()));
                },
                [&](const NumbersField& f) {
                    list(f.fewest, f.most);
                    std::vector<double> values;
                    for (const auto& item : node) values.push_back(number(item, f.range) * f.si_per_unit);
                    *f.value = values;
                },
                [&](const Vec3Field& f) {
                    list(3, 3);
                    *f.value = f.si_per_unit * Vec3d{number(node[0], f.range), number(node[1], f.range),
                                                     number(node[2], f.range)};
                },
                [&](const QuatField& f) {
                    list(4, 4);
                    const Range unit{-1.001, 1.001};
                    const Quat q{number(node[0], unit), number(node[1], unit), number(node[2], unit),
                                 number(node[3], unit)};
                    if (std::abs(norm(q) - 1) > 1e-3)
                        fail(place, node, path,
                             "found a quaternion of norm " + plain(norm(q)) +
                                 "; accepted: [w, x, y, z] of norm 1");
                    *f.value = normalized(q);
                },
                [&](const CurveField& f) {
                    *f.value = curve(node, f.range, number, refuse);
                    f.value->where = where(place, node);
                },
                [&](const TableField& f) { *f.value = table(node, f, number, refuse); },
                [&](const SectionField& f) { section(node, place, f, path, depth, refuse); },
                [&](const OptionalSectionField& f) { section(node, place, f.open(), path, depth, refuse); },
                [&](const SectionsField& f) {
                    if (f.holds_word) *f.holds_word = is_word(node, f.word);
                    if (is_word(node, f.word)) return;
                    if (node.IsScalar()) return list_in_file(node, place, field, f.word, path, depth);
                    if (!node.IsSequence())
                        refuse(node, in_place_of("a list of mappings", f.word) +
                                         ", or the path of a file that holds it");
                    for (std::size_t i = 0; i < node.size(); ++i)
                        section(node[i], place, f.append(), join(path, std::to_string(i)), depth, refuse);
                },
            },
            field.target);
    }

    template <class Refuse>
    static std::int64_t integer(const YAML::Node& node, const Range& range, const Refuse& refuse) {
        const auto value = node.IsScalar() ? to_whole(node.Scalar()) : std::nullopt;
        const auto as_double = static_cast<double>(value.value_or(0));
        if (!value || as_double < range.least || as_double > range.most)
            refuse(node, "a whole number, " + accepted(range));
        return *value;
    }

    template <class Number, class Refuse>
    static Curve curve(const YAML::Node& node, const Range& range, const Number& number,
                       const Refuse& refuse) {
        if (node.IsScalar()) return Curve::constant(number(node, range));
        if (!node.IsSequence() || node.size() == 0)
            refuse(node, "a number, or [[wavelength_um, value], ...]");
        Table pairs = table(node, {nullptr, "wavelength_um", "value", {0.1, 100}, range}, number, refuse);
        return {std::move(pairs.x), std::move(pairs.y), {}};
    }

    template <class Number, class Refuse>
    static Table table(const YAML::Node& node, const TableField& f, const Number& number,
                       const Refuse& refuse) {
        const std::string pair_text = "[" + f.x_name + ", " + f.y_name + "]";
        if (!node.IsSequence() || node.size() == 0) refuse(node, "[" + pair_text + ", ...]");
        Table out;
        for (const auto& pair : node) {
            if (!pair.IsSequence() || pair.size() != 2) refuse(pair, "a pair " + pair_text);
            const double x = number(pair[0], f.x_range, f.x_name);
            if (!out.x.empty() && x <= out.x.back())
                refuse(pair[0], f.x_name + " that rises from pair to pair");
            out.x.push_back(x);
            out.y.push_back(number(pair[1], f.y_range, f.y_name));
        }
        return out;
    }

    // The file that stands in the place of a mapping or a list; fails when there is none.
    static std::filesystem::path named_file(const YAML::Node& node, const Place& place,
                                            const std::string& path, const std::string& whole) {
        std::filesystem::path file = found_from(place, node.Scalar(), path);
        std::error_code error;
        if (!std::filesystem::exists(file, error))
            fail(place, node, path,
                 "found " + show(node) + "; accepted: " + whole + ", or the path of a file that holds it" +
                     shipped_advice(path, node.Scalar()) + "; " + file.string() + ": no such file");
        return file;
    }

    // Says which shipped parts a key takes by name.
    static std::string shipped_advice(const std::string& path, const std::string& found) {
        const ShippedKind* const kind = kind_of_key(path);
        if (!kind) return {};
        const std::vector<std::string> names = shipped_names(*kind);
        const std::string nearest = nearest_of(found, names);
        return ", or the name of a shipped one ('hilcam list " + std::string(kind->words) + "')" +
               (nearest.empty() ? "" : "; nearest: " + nearest);
    }

    // A list in a file of its own stands there under the key that it has here.
    void list_in_file(const YAML::Node& node, const Place& place, const Field& field, const std::string& word,
                      const std::string& path, int depth) {
        in_file(named_file(node, place, path, in_place_of("a list of mappings", word)), path,
                [&](const YAML::Node& map, const Place& own) {
                    refuse_unknown_keys(map, own, {field}, path);
                    const YAML::Node list = map[field.key];
                    if (!list.IsDefined() || list.IsNull())
                        fail(own, map, path,
                             "the key '" + field.key + "' is missing; it is " + field.meaning);
                    read_value(list, own, field, path, depth + 1);
                });
    }

    template <class Refuse>
    void section(const YAML::Node& node, const Place& place, const SectionField& f, const std::string& path,
                 int depth, const Refuse& refuse) {
        if (node.IsScalar()) return read_file(named_file(node, place, path, "a mapping"), f, path, depth + 1);
        if (!node.IsMap()) refuse(node, "a mapping, or the path of a file that holds it");
        read_section(node, place, f, path, depth + 1);
    }
};

}  // namespace

void read_config(const std::filesystem::path& file, const SectionField& root,
                 std::span<const std::string> overrides, KeyPlaces* places) {
    Reader reader(root.fields, overrides, places);
    reader.read_file(file, root, "", 0);
    reader.require_all_overrides_used();
}

void read_config_text(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                      const SectionField& root, std::span<const std::string> overrides) {
    Reader reader(root.fields, overrides);
    reader.read_text(text, {name, folder}, root, "", 0);
    reader.require_all_overrides_used();
}

bool has_top_level_key(const std::filesystem::path& file, const std::string& key) {
    try {
        const YAML::Node node = YAML::Load(in_utf8(read_input_file(file, kYamlFile)));
        return node.IsMap() && node[key].IsDefined();
    } catch (const YAML::Exception&) {
        return false;
    } catch (const InputError&) {
        return false;
    }
}

}  // namespace hilcam
