#pragma once
// A table of the suite: one thing is taken to its extremes, and at each value the program is held against a
// truth that does not come from it.

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

namespace hilcam::extremes {

// Largest relative rounding errors of the two precisions (IEEE 754).
inline constexpr double kFloatGrain = 0x1p-24, kDoubleGrain = 0x1p-53;
// Where an error is a matter of chance: a normal deviate is beyond this once in 150,000.
inline constexpr double kSigmas = 4.5;

// What one quantity should be, and how far off it is, in the terms that the table names. An error that is no
// number stands for something that was not finite.
struct Found {
    double truth = 0;
    double error = 0;
};

// A row.
struct Case {
    std::string value;
    std::vector<double> limits;  // of the errors, one per quantity
    std::function<std::vector<Found>()> measure;
    bool heavy = false;  // too much for a build with sanitizers
};

struct Group {
    std::string name;    // of the test: letters
    std::string title;   // in extremes.csv
    std::string varied;  // with its unit
    std::vector<std::string> quantities;
    std::string truth;  // where it comes from
    std::string limit;  // what it is derived from
    std::vector<Case> cases;
};

// The greatest of some errors; no number once one of them was none.
class Worst {
  public:
    void add(double error) {
        if (!std::isnan(worst_) && !(error <= worst_)) worst_ = error;
    }
    double value() const { return worst_; }

  private:
    double worst_ = 0;
};

inline double relative(double found, double truth) { return std::abs(found / truth - 1); }

inline std::string text(double value) {
    char out[32];
    std::snprintf(out, sizeof out, "%g", value);
    return out;
}

}  // namespace hilcam::extremes
