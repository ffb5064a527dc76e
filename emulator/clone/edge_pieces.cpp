#include "emulator/clone/edge_pieces.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"
#include "sensor/measure/least_squares.h"

namespace hilcam {
namespace {

constexpr int kBlocks = 16;
constexpr int kLeastRows = 48, kMostPieces = 7;
// A row's edge is where the mean of eight pixels differs most from the mean of the eight before them.
constexpr int kMean_px = 8;
constexpr double kLeastReach_px = 12, kReach_px = 32;  // width of a piece to both sides of the edge
constexpr double kNear_px = 3;  // a row counts if its edge is no farther than this from the fitted curve
// ISO 12233 asks for about 5 degrees. At 1 degree an edge crosses a pixel in 57 rows; near 45 degrees rows
// and columns do not differ.
constexpr double kLeastTilt_deg = 1, kMostTilt_deg = 40;

// The picture, transposed if its edge is near the rows.
struct Upright {
    int width = 0, height = 0;
    bool transposed = false;
    std::vector<double> value;
    std::vector<std::uint8_t> use;

    std::size_t at(int x, int y) const { return static_cast<std::size_t>(y * width + x); }
};

// The mean change over kMean_px is less noisy than that of neighbours.
double total_change(const EdgePicture& p, int dx, int dy) {
    double out = 0;
    for (int y = 0; y + dy < p.height; ++y)
        for (int x = 0; x + dx < p.width; ++x) {
            const auto i = static_cast<std::size_t>(y * p.width + x);
            const auto k = static_cast<std::size_t>((y + dy) * p.width + x + dx);
            if (p.use[i] && p.use[k]) out += p.value[k] - p.value[i];
        }
    return std::abs(out);
}

Upright upright(const EdgePicture& p) {
    const bool transposed = total_change(p, 0, kMean_px) * p.width > total_change(p, kMean_px, 0) * p.height;
    Upright out{transposed ? p.height : p.width, transposed ? p.width : p.height, transposed, {}, {}};
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) {
            const auto i = static_cast<std::size_t>(transposed ? x * p.width + y : y * p.width + x);
            out.value.push_back(p.value[i]), out.use.push_back(p.use[i]);
        }
    return out;
}

// The place in a row where the means to both sides differ most, and by how much.
struct RowEdge {
    double y = 0, x = 0, step = 0;
};
RowEdge edge_in_row(const Upright& p, int y) {
    std::vector<double> sum(1, 0.0), count(1, 0.0);
    for (int x = 0; x < p.width; ++x) {
        const bool use = p.use[p.at(x, y)] != 0;
        sum.push_back(sum.back() + (use ? p.value[p.at(x, y)] : 0));
        count.push_back(count.back() + (use ? 1 : 0));
    }
    const auto mean = [&](int from, int to) {
        const auto a = static_cast<std::size_t>(from), b = static_cast<std::size_t>(to);
        return (sum[b] - sum[a]) / std::max(count[b] - count[a], 1.0);
    };
    RowEdge out{y + 0.5, 0, 0};
    for (int x = kMean_px; x + kMean_px <= p.width; ++x) {
        const double step = mean(x, x + kMean_px) - mean(x - kMean_px, x);
        if (std::abs(step) > std::abs(out.step)) out.x = x, out.step = step;
    }
    return out;
}

// x = c0 + c1 y + c2 y^2: a lens's distortion bends the edge a little.
struct EdgeCurve {
    std::vector<double> c;
    int top = 0, bottom = 0;  // rows that show it
    double step = 0;
    double at(double y) const { return c[0] + y * (c[1] + y * c[2]); }
    double slope() const { return c[1] + c[2] * (top + bottom); }
};

[[noreturn]] void refuse_edge(const std::string& name, const std::string& found) {
    throw InputError(name + ": found " + found +
                     fmt::format("; accepted: one straight edge between a bright and a dark surface across "
                                 "the picture, in focus, slanted by {:g} to {:g} degrees",
                                 kLeastTilt_deg, kMostTilt_deg));
}

double median_value(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// The line through most rows: median of the slopes of rows that are half the picture apart.
std::vector<double> first_line(const std::vector<RowEdge>& rows) {
    std::vector<double> slopes, offsets;
    const std::size_t half = rows.size() / 2;
    for (std::size_t i = 0; i + half < rows.size(); ++i)
        slopes.push_back((rows[i + half].x - rows[i].x) / (rows[i + half].y - rows[i].y));
    const double slope = median_value(slopes);
    for (const RowEdge& r : rows) offsets.push_back(r.x - slope * r.y);
    return {median_value(offsets), slope, 0};
}

EdgeCurve find_curve(const Upright& p, double noise, const std::string& name) {
    std::vector<RowEdge> rows;
    std::vector<double> steps;
    for (int y = 0; y < p.height; ++y) {
        rows.push_back(edge_in_row(p, y));
        steps.push_back(rows.back().step);
    }
    const double step = median_value(steps);
    // Rows without the edge have steps of noise, or of something else.
    std::erase_if(rows, [&](const RowEdge& r) { return r.step * step < 0.5 * step * step; });
    if (static_cast<int>(rows.size()) < std::max(kLeastRows, p.height / 2) ||
        std::abs(step) < 10 * noise / std::sqrt(1.0 * kMean_px))
        refuse_edge(name, fmt::format("no edge in {} of {} rows", p.height - static_cast<int>(rows.size()),
                                      p.height));
    EdgeCurve curve{first_line(rows), 0, 0, step};
    std::vector<RowEdge> near;
    for (int pass = 0; pass < 3; ++pass) {
        near.clear();
        std::vector<double> y, x;
        for (const RowEdge& r : rows)
            if (std::abs(r.x - curve.at(r.y)) < kNear_px)
                near.push_back(r), y.push_back(r.y), x.push_back(r.x);
        if (near.size() < rows.size() * 2 / 3)
            refuse_edge(name,
                        fmt::format("an edge that is straight in {} of {} rows", near.size(), rows.size()));
        const std::vector<double> equal(y.size(), 1.0), none(y.size(), 0.0);
        curve.c = fit_polynomial(y, x, equal, none, 2).coefficient;
    }
    curve.top = static_cast<int>(near.front().y), curve.bottom = static_cast<int>(near.back().y) + 1;
    const auto beside = [&](int y) {
        const double x = curve.at(y + 0.5);
        return std::min(x, p.width - x);
    };
    while (curve.top < curve.bottom && beside(curve.top) < kLeastReach_px) ++curve.top;
    while (curve.bottom > curve.top && beside(curve.bottom - 1) < kLeastReach_px) --curve.bottom;
    const double tilt_deg = std::atan(std::abs(curve.slope())) / kDegree_rad;
    if (tilt_deg < kLeastTilt_deg || tilt_deg > kMostTilt_deg)
        refuse_edge(name, fmt::format("an edge at {:.1f} degrees from the {}", tilt_deg,
                                      p.transposed ? "rows" : "columns"));
    return curve;
}

struct Cut {
    int left = 0, top = 0, width = 0, height = 0;
    std::vector<double> value;
    std::vector<std::uint8_t> use;
};
Cut cut(const Upright& p, const EdgeCurve& curve, int top, int height, double reach) {
    const double a = curve.at(top), b = curve.at(top + height);
    Cut out;
    out.left = std::max(0, static_cast<int>(std::min(a, b) - reach - 1));
    const int right = std::min(p.width, static_cast<int>(std::max(a, b) + reach + 2));
    out.top = top, out.width = right - out.left, out.height = height;
    for (int y = top; y < top + height; ++y)
        for (int x = out.left; x < right; ++x)
            out.value.push_back(p.value[p.at(x, y)]), out.use.push_back(p.use[p.at(x, y)]);
    return out;
}

EdgePiece measure_piece(const Upright& p, const EdgeCurve& curve, int top, int height, double noise) {
    const double first = curve.at(top), last = curve.at(top + height);
    const double reach =
        std::min({kReach_px, std::min(first, last) - 1, p.width - std::max(first, last) - 1});
    const Cut piece = cut(p, curve, top, height, reach);
    const auto mtf_of = [&](const std::vector<std::uint8_t>& use) {
        return slanted_edge_mtf({piece.width, piece.height, piece.value, use, noise}, {0, reach});
    };
    EdgePiece out;
    const double y = top + 0.5 * height, x = curve.at(y);
    out.place_px = p.transposed ? Vec2d{y, x} : Vec2d{x, y};
    out.mtf = mtf_of(piece.use);
    if (p.transposed) out.mtf.normal_rad = kPi / 2 - out.mtf.normal_rad;
    for (int block = 0; block < kBlocks; ++block) {
        std::vector<std::uint8_t> use = piece.use;
        const auto from = static_cast<std::size_t>(block * height / kBlocks * piece.width);
        const auto to = static_cast<std::size_t>((block + 1) * height / kBlocks * piece.width);
        std::fill(use.begin() + static_cast<std::ptrdiff_t>(from),
                  use.begin() + static_cast<std::ptrdiff_t>(to), 0);
        out.without.push_back(mtf_of(use).mtf);
    }
    for (std::size_t k = 0; k < out.mtf.mtf.size(); ++k) {
        std::vector<double> values;
        for (const std::vector<double>& one : out.without) values.push_back(one[k]);
        out.mtf.uncertainty[k] = jackknife_uncertainty(values);
    }
    return out;
}

}  // namespace

double jackknife_uncertainty(const std::vector<double>& without) {
    const auto n = static_cast<double>(without.size());
    double mean = 0, sum = 0;
    for (const double value : without) mean += value / n;
    for (const double value : without) sum += square(value - mean);
    return std::sqrt(sum * (n - 1) / n);
}

std::vector<EdgePiece> measure_edge_pieces(const EdgePicture& picture, const std::string& name) {
    if (std::min(picture.width, picture.height) < kLeastRows)
        refuse_edge(name, fmt::format("a picture of {} x {}", picture.width, picture.height));
    const Upright p = upright(picture);
    const EdgeCurve curve = find_curve(p, picture.noise, name);
    const int rows = curve.bottom - curve.top;
    // Two cycles of the edge's position on the pixel grid in each piece.
    const int least = std::max(kLeastRows, static_cast<int>(std::ceil(2 / std::abs(curve.slope()))) + 2);
    if (rows < least)
        refuse_edge(name,
                    fmt::format("an edge over {} rows, where {} show two steps of a pixel", rows, least));
    const int pieces = std::clamp(rows / least, 1, kMostPieces), height = rows / pieces;
    std::vector<EdgePiece> out;
    std::string why;
    for (int i = 0; i < pieces; ++i) {
        try {
            out.push_back(measure_piece(p, curve, curve.top + i * height, height, picture.noise));
        } catch (const InputError& error) {
            why = error.what();  // a lens's distortion may have turned a piece upright
        }
    }
    if (out.empty()) refuse_edge(name, why);
    return out;
}

}  // namespace hilcam
