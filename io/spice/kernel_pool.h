#pragma once
// The variables that SPICE's text kernels set, as NAIF, "Kernel Required Reading" has them: numbers, dates or texts by
// name. A later assignment replaces an earlier one, += adds to it.

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hilcam {

struct KernelVariable {
    std::vector<double> numbers;     // dates as seconds since J2000, in the time system that the reader knows
    std::vector<std::string> texts;  // one of the two is empty
    std::string where;               // "file:line" of the newest assignment
};

class KernelPool {
  public:
    // Throws InputError when the pool would have more than 300 000 names, 10 million numbers or 2 million texts: no set of a mission
    // has a tenth of that, and it keeps a pool below a gigabyte.
    void assign(const std::string& name, KernelVariable value, bool append);

    // Null: there is no such variable. Owner thread, as all of these.
    const KernelVariable* find(std::string_view name) const;
    // Returns its numbers or texts. Throws InputError for one of the other kind; none: there is no such variable.
    std::optional<std::span<const double>> numbers(std::string_view name) const;
    std::optional<std::span<const std::string>> texts(std::string_view name) const;
    // Returns so many numbers. Throws InputError when the variable is missing or has another count; `what` says what it
    // is for.
    std::span<const double> require_numbers(std::string_view name, std::size_t count,
                                            const std::string& what) const;
    std::optional<double> number(std::string_view name) const;
    std::optional<int> integer(std::string_view name) const;
    std::optional<std::string> text(std::string_view name) const;
    const std::map<std::string, KernelVariable, std::less<>>& all() const { return variables_; }

  private:
    std::map<std::string, KernelVariable, std::less<>> variables_;
    std::size_t numbers_ = 0, texts_ = 0;
};

}  // namespace hilcam
