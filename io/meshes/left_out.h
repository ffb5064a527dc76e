#pragma once
// Collects what a reader of mesh files does not use, and lists it by kind.

#include <map>
#include <string>
#include <vector>

namespace hilcam {

class LeftOut {
  public:
    // Notes that a kind of look, "emission" or "lamp", of a named thing is not used. An empty name stands for
    // the file, or for a thing without a name.
    void add(const std::string& what, const std::string& whose);
    // Returns a line for each kind: "emission of 'lamp' and 3 others: not used".
    std::vector<std::string> lines() const;

  private:
    std::map<std::string, std::vector<std::string>> names_;  // by kind
};

}  // namespace hilcam
