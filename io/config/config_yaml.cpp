#include "io/config/config_yaml.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <sstream>

#include "io/config/config_advice.h"
#include "io/config/config_files.h"
#include "io/config/yaml_flag.h"
#include "io/config/yaml_place.h"
#include "io/config/yaml_value.h"
#include "io/system/input_file.h"
#include "io/system/text_mark.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/overloaded.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

const InputKind kYamlFile{4u << 20, "a YAML file"};
constexpr int kDeepest = 16;

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
        in_file(file, path, [&](const YAML::Node& node, const YamlPlace& place) {
            read_section(node, place, section, path, depth);
        });
    }

    void read_text(std::string_view text, const YamlPlace& place, const SectionField& section,
                   const std::string& path, int depth) {
        read_section(only_mapping(text, place, path), place, section, path, depth);
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

    // Lets `use` read what a file holds.
    template <class Use>
    void in_file(const std::filesystem::path& file, const std::string& path, const Use& use) {
        std::error_code error;
        const auto canonical = std::filesystem::weakly_canonical(file, error);
        if (std::find(open_files_.begin(), open_files_.end(), canonical) != open_files_.end())
            throw InputError(file.string() + ": the file includes itself");
        const std::string text = read_input_file(file, kYamlFile);
        open_files_.push_back(canonical);
        const YamlPlace place{file.string(), file.parent_path()};
        use(only_mapping(text, place, path), place);
        open_files_.pop_back();
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

    // The last override of a key counts, so that a user can change what a script sets.
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

    void count_node(const YamlPlace& place, const YAML::Node& node, const std::string& path, int depth) {
        if (++nodes_ > 200000) fail_at(place, node, path, "the configuration has more than 200000 values");
        if (depth > kDeepest)
            fail_at(place, node, path, "nested deeper than " + std::to_string(kDeepest) + " levels");
    }

    void read_section(const YAML::Node& map, const YamlPlace& place, const SectionField& section,
                      const std::string& path, int depth) {
        count_node(place, map, path, depth);
        refuse_unknown_keys(map, place, section.fields, path);
        std::vector<const Field*> given_fields;
        for (const Field& field : section.fields) {
            const std::string field_path = join(path, field.key);
            const Override* override = override_at(field_path);
            // yaml-cpp's nodes are references: a node is only constructed, never assigned.
            const YAML::Node given =
                override ? override->value : value_of_key(map, field.key, section.fields);
            const bool absent = !given.IsDefined() || given.IsNull();
            const bool opened = absent && holds_section(field) && override_below(field_path);
            if (absent && !opened) {
                if (field.required)
                    fail_at(place, map, field_path, "the key is missing; it is " + field.meaning);
                continue;
            }
            given_fields.push_back(&field);
            if (field.present) *field.present = true;
            const YamlPlace value_place =
                override ? YamlPlace{"--set " + field_path, std::filesystem::current_path(), true} : place;
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
            if (said == 0 || colon == std::string::npos) fail_at(place, map, path, what);
            fail_at_key(place, map, path, {what.substr(said, colon - said), what.substr(colon + 2)});
        }
    }

    // A check that names its key from the top has the path in its text already. Returns how many letters of
    // the text repeat the path: all of it or, for a further camera, its end ("outputs.preview." of
    // "cameras.0.outputs.preview").
    static std::size_t said_of_path(std::string_view path, std::string_view text) {
        while (!path.empty()) {
            if (text.starts_with(path) && text.substr(path.size()).starts_with('.')) return path.size() + 1;
            const std::size_t dot = path.find('.');
            path = dot == path.rfind('.') ? std::string_view() : path.substr(dot + 1);
        }
        return 0;
    }

    // Fails at the key, or at the innermost section above it that this file or the command line gives.
    [[noreturn]] void fail_at_key(const YamlPlace& place, const YAML::Node& map, const std::string& path,
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
        fail_at(place, way.back(), whole, error.reason());
    }

    void refuse_unknown_keys(const YAML::Node& map, const YamlPlace& place, const Fields& known,
                             const std::string& path) const {
        std::vector<std::string> seen;
        for (const auto& entry : map) {
            const std::string key =
                entry.first.IsScalar() ? known_key(entry.first.Scalar(), known) : std::string("(not a word)");
            if (std::none_of(known.begin(), known.end(), [&](const Field& f) { return f.key == key; }))
                fail_at(place, entry.first, join(path, shortened(key)),
                        "unknown key" + advice_for(key, known, root_));
            if (std::find(seen.begin(), seen.end(), key) != seen.end())
                fail_at(place, entry.first, join(path, shortened(key)), "the key is given twice");
            seen.push_back(key);
        }
    }

    void read_value(const YAML::Node& node, const YamlPlace& place, const Field& field,
                    const std::string& path, int depth) {
        count_node(place, node, path, depth);
        if (places_) places_->note(path, where_is(node, place));
        const YamlValue value(node, place, field, path, numbers_);
        std::visit(
            Overloaded{
                [&](const OneOf<NumberField, IntegerField, FlagField, TextField, TextsField, PathField,
                                ChoiceField, NumbersField, Vec3Field, QuatField, CurveField, TableField> auto&
                        f) { value.read(f); },
                [&](const SectionField& f) { section(node, place, f, path, depth, value); },
                [&](const OptionalSectionField& f) { section(node, place, f.open(), path, depth, value); },
                [&](const SectionsField& f) {
                    if (f.holds_word) *f.holds_word = value.is_word(f.word);
                    if (value.is_word(f.word)) return;
                    if (node.IsScalar()) return list_in_file(node, place, field, f.word, path, depth);
                    if (!node.IsSequence())
                        value.refuse(node, accepted_or_word("a list of mappings", f.word) +
                                               ", or the path of a file that holds it");
                    for (std::size_t i = 0; i < node.size(); ++i)
                        section(node[i], place, f.append(), join(path, std::to_string(i)), depth, value);
                },
            },
            field.target);
    }

    // Returns the file named in place of a mapping or a list; fails when there is none.
    static std::filesystem::path named_file(const YAML::Node& node, const YamlPlace& place,
                                            const std::string& path, const std::string& whole) {
        std::filesystem::path file = file_named_from(place.folder, node.Scalar(), path);
        std::error_code error;
        if (!std::filesystem::exists(file, error))
            fail_at(place, node, path,
                    "found " + shown(node) + "; accepted: " + whole +
                        ", or the path of a file that holds it" + shipped_advice(path, node.Scalar()) + "; " +
                        file.string() + ": no such file");
        return file;
    }

    // A list in its own file has the same key there as here.
    void list_in_file(const YAML::Node& node, const YamlPlace& place, const Field& field,
                      const std::string& word, const std::string& path, int depth) {
        in_file(named_file(node, place, path, accepted_or_word("a list of mappings", word)), path,
                [&](const YAML::Node& map, const YamlPlace& own) {
                    refuse_unknown_keys(map, own, {field}, path);
                    const YAML::Node list = map[field.key];
                    if (!list.IsDefined() || list.IsNull())
                        fail_at(own, map, path,
                                "the key '" + field.key + "' is missing; it is " + field.meaning);
                    read_value(list, own, field, path, depth + 1);
                });
    }

    // value: names the key in an error.
    void section(const YAML::Node& node, const YamlPlace& place, const SectionField& f,
                 const std::string& path, int depth, const YamlValue& value) {
        if (node.IsScalar()) return read_file(named_file(node, place, path, "a mapping"), f, path, depth + 1);
        if (!node.IsMap()) value.refuse(node, "a mapping, or the path of a file that holds it");
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
