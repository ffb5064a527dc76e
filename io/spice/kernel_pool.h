#pragma once
// The variables of SPICE's text kernels (NAIF, "Kernel Required Reading"): numbers, dates or texts by name. A
// later assignment replaces an earlier one, += appends to it.

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hilcam {

struct KernelVariable {
    // Dates: seconds since J2000, in the time system that the kernel's kind implies.
    std::vector<double> numbers;
    std::vector<std::string> texts;  // one of the two is empty
    std::string where;               // "file:line" of the newest assignment
};

class KernelPool {
  public:
    // Throws InputError beyond 300 000 names, 10 million numbers or 2 million texts. No mission's set has a
    // tenth of that, and it keeps a pool below a gigabyte.
    void assign(const std::string& name, KernelVariable value, bool append);

    // Returns null when there is no such variable. Owner thread, as all of these.
    const KernelVariable* find(std::string_view name) const;
    // Return the variable's numbers or texts; nothing when there is no such variable. Throw InputError for
    // the other kind.
    std::optional<std::span<const double>> numbers(std::string_view name) const;
    std::optional<std::span<const std::string>> texts(std::string_view name) const;
    // Returns exactly `count` numbers. Throws InputError when the variable is missing or has another count;
    // `what` says what it is for.
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
