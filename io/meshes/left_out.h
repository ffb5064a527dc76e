#pragma once
// The looks of a mesh file that its reader does not take, in a line for each kind.

#include <map>
#include <string>
#include <vector>

namespace hilcam {

class LeftOut {
  public:
    // Notes that a kind of look is left out of a thing: "emission", "lamp". An empty name stands for the file, or a thing without
    // a name.
    void add(const std::string& what, const std::string& whose);
    // Returns a line for each kind: "emission of 'lamp' and 3 others: not used".
    std::vector<std::string> lines() const;

  private:
    std::map<std::string, std::vector<std::string>> names_;  // by kind
};

}  // namespace hilcam
