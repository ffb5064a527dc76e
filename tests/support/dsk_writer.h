#pragma once
// Writes SPICE shape kernels from what NAIF's "DAS Required Reading", "DLA Required Reading" and "DSK Required Reading" say,
// with nothing of the readers.

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "render/vocabulary/vec.h"
#include "tests/support/byte_order.h"

namespace hilcam {

struct WrittenShape {
    int surface = 1, body = 2000433, frame = 10, type = 2;
    std::vector<Vec3d> vertices_km;
    std::vector<std::array<std::int32_t, 3>> plates;  // vertices from 1
};

class DskWriter {
  public:
    // records_in_turn: records of doubles and of integers lie by turns, so many at a time, as in a file that was never
    // segregated, with so many clusters to a directory; 0: all doubles, then all integers.
    explicit DskWriter(bool big_endian = false, std::size_t records_in_turn = 0, std::size_t clusters = 200)
        : big_endian_(big_endian), in_turn_(records_in_turn), clusters_(clusters) {}

    DskWriter& add(const WrittenShape& shape) {
        shapes_.push_back(shape);
        return *this;
    }

    struct Numbers {
        std::vector<std::int32_t> integers;
        std::vector<double> doubles;
    };
    // What the file has, however it is written.
    Numbers numbers() const {
        std::vector<std::int32_t> integers = {1'000'000, -1, -1};
        std::vector<double> doubles;
        std::int32_t before = -1;
        for (const WrittenShape& s : shapes_) {
            const auto at = static_cast<std::int32_t>(integers.size()) + 1;
            (before < 0 ? integers[1] : integers[static_cast<std::size_t>(before)]) = at;
            integers[2] = at;
            const std::vector<std::int32_t> own = integers_of(s);
            const std::vector<double> words = doubles_of(s);
            const auto base = static_cast<std::int32_t>(integers.size() + 8);
            for (const std::int32_t n :
                 {before, -1, base, static_cast<std::int32_t>(own.size()),
                  static_cast<std::int32_t>(doubles.size()), static_cast<std::int32_t>(words.size()), 0, 0})
                integers.push_back(n);
            before = at;
            integers.insert(integers.end(), own.begin(), own.end());
            doubles.insert(doubles.end(), words.begin(), words.end());
        }
        return {integers, doubles};
    }

    std::string bytes() const {
        const auto [integers, doubles] = numbers();
        return head() + std::string(1024, 'c') +
               body(records_of(doubles), records_of(integers), static_cast<std::int32_t>(doubles.size()),
                    static_cast<std::int32_t>(integers.size()));
    }

  private:
    bool big_endian_;
    std::size_t in_turn_, clusters_;
    std::vector<WrittenShape> shapes_;

    static std::vector<std::int32_t> integers_of(const WrittenShape& s) {
        // Vertices, plates, voxels, their extents, coarse scale, and the sizes of three lists.
        std::vector<std::int32_t> out = {static_cast<std::int32_t>(s.vertices_km.size()),
                                         static_cast<std::int32_t>(s.plates.size()),
                                         8,
                                         2,
                                         2,
                                         2,
                                         1,
                                         8,
                                         5,
                                         7};
        for (const auto& p : s.plates) out.insert(out.end(), p.begin(), p.end());
        out.insert(out.end(), 21, -7);
        return out;
    }
    static std::vector<double> doubles_of(const WrittenShape& s) {
        std::vector<double> out(34, 0.25);
        out[0] = s.surface, out[1] = s.body, out[2] = 1, out[3] = s.type, out[4] = s.frame, out[5] = 1;
        for (const Vec3d& v : s.vertices_km) out.insert(out.end(), {v.x, v.y, v.z});
        return out;
    }

    template <class T>
    std::vector<std::string> records_of(const std::vector<T>& values) const {
        std::vector<std::string> out;
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (i % (1024 / sizeof(T)) == 0) out.emplace_back();
            out.back() += ordered(values[i], big_endian_);
        }
        for (std::string& record : out) record.resize(1024, '\0');
        return out;
    }

    std::string head() const {
        std::string out = "DAS/DSK ";
        out += std::string(60, ' ') + ordered(std::int32_t{0}, big_endian_) +
               ordered(std::int32_t{0}, big_endian_) + ordered(std::int32_t{1}, big_endian_) +
               ordered(std::int32_t{900}, big_endian_) + (big_endian_ ? "BIG-IEEE" : "LTL-IEEE");
        out.resize(699, '\0');
        out += std::string("FTPSTR:\r:\n:\r\n:\r\0:\x81:\x10\xce:ENDFTP", 28);
        out.resize(1024, '\0');
        return out;
    }

    struct Cluster {
        std::int32_t kind;  // 2: doubles, 3: integers
        std::size_t first, count;
    };
    std::vector<Cluster> clusters_of(std::size_t doubles, std::size_t integers) const {
        if (in_turn_ == 0 && doubles == 0) return {{3, 0, integers}};
        if (in_turn_ == 0) return {{2, 0, doubles}, {3, 0, integers}};
        std::vector<Cluster> out;
        // Integers first: then the kinds go backwards in the circle, and forwards again.
        for (std::size_t d = 0, i = 0; d < doubles || i < integers;) {
            const std::size_t more_i = std::min(in_turn_, integers - i),
                              more_d = std::min(in_turn_, doubles - d);
            if (more_i > 0) out.push_back({3, i, more_i});
            if (more_d > 0) out.push_back({2, d, more_d});
            i += more_i, d += more_d;
        }
        // Two of a kind that would lie side by side are one.
        std::vector<Cluster> joined;
        for (const Cluster& c : out)
            if (!joined.empty() && joined.back().kind == c.kind)
                joined.back().count += c.count;
            else
                joined.push_back(c);
        return joined;
    }

    std::string body(const std::vector<std::string>& doubles, const std::vector<std::string>& integers,
                     std::int32_t last_double, std::int32_t last_integer) const {
        const std::vector<Cluster> all = clusters_of(doubles.size(), integers.size());
        std::string out;
        std::int32_t record = 3, before = 0;
        for (std::size_t from = 0; from < all.size(); from += clusters_) {
            const std::size_t end = std::min(all.size(), from + clusters_);
            std::vector<std::int32_t> directory(256, 0);
            std::string data;
            std::int32_t records = 0;
            for (std::size_t i = from; i < end; ++i) {
                const Cluster& c = all[i];
                const auto& source = c.kind == 2 ? doubles : integers;
                const std::int32_t in_record = c.kind == 2 ? 128 : 256;
                const std::int32_t last = c.kind == 2 ? last_double : last_integer;
                const std::size_t range = c.kind == 2 ? 4 : 6;
                const auto first = static_cast<std::int32_t>(c.first) * in_record + 1;
                if (directory[range] == 0) directory[range] = first;
                directory[range + 1] =
                    std::min(last, first - 1 + static_cast<std::int32_t>(c.count) * in_record);
                const auto count = static_cast<std::int32_t>(c.count);
                if (i == from)
                    directory[8] = c.kind, directory[9] = count;
                else
                    directory[9 + i - from] = c.kind == 3 ? count : -count;
                for (std::size_t r = 0; r < c.count; ++r) data += source[c.first + r];
                records += count;
            }
            directory[0] = before;
            directory[1] = end < all.size() ? record + 1 + records : 0;
            std::string text;
            for (const std::int32_t n : directory) text += ordered(n, big_endian_);
            out += text + data;
            before = record, record += 1 + records;
        }
        return out;
    }
};

}  // namespace hilcam
