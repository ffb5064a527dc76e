#pragma once
// A function given by samples: linear between them, constant beyond the first and the last.

#include <algorithm>
#include <cstddef>
#include <vector>

namespace hilcam {

struct Table {
    std::vector<double> x;  // strictly rising
    std::vector<double> y;

    bool empty() const { return x.empty(); }
    double at(double position) const {
        if (position <= x.front()) return y.front();
        if (position >= x.back()) return y.back();
        const auto after =
            static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), position) - x.begin());
        const double u = (position - x[after - 1]) / (x[after] - x[after - 1]);
        return y[after - 1] + u * (y[after] - y[after - 1]);
    }
};

}  // namespace hilcam
