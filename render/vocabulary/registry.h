#pragma once
// Models by name. Each kind of model has one registry (modules.h). It starts with the program's own models,
// and plug-ins add more (plugin.h). Owner thread.

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "render/vocabulary/check.h"

namespace hilcam {

// Arguments: what each factory of this kind gets.
template <class Model, class... Arguments>
class Registry {
  public:
    using Factory = std::function<std::unique_ptr<Model>(Arguments...)>;

    explicit Registry(std::string kind) : kind_(std::move(kind)) {}

    // Throws InputError if the name is taken.
    void add(const std::string& name, Factory factory) {
        if (!factories_.emplace(name, std::move(factory)).second)
            throw InputError("there are two models '" + name + "' of kind " + kind_);
    }
    // Throws InputError with the list of names if there is no model of this name.
    std::unique_ptr<Model> make(const std::string& name, Arguments... arguments) const {
        const auto found = factories_.find(name);
        if (found == factories_.end())
            throw InputError(kind_ + ": found '" + name + "'; accepted: " + names());
        return found->second(arguments...);
    }
    std::vector<std::string> list() const {
        std::vector<std::string> all;
        for (const auto& [name, factory] : factories_) all.push_back(name);
        return all;
    }
    std::string names() const {
        std::string list;
        for (const auto& [name, factory] : factories_) list += (list.empty() ? "" : " | ") + name;
        return list;
    }

  private:
    std::string kind_;
    std::map<std::string, Factory> factories_;
};

}  // namespace hilcam
