#pragma once
// Records of Chebyshev polynomials over spans of equal length, as in types 2 and 3 of SPK and of binary PCK.

#include <array>

#include "io/spice/chebyshev.h"
#include "io/spice/segment_words.h"

namespace hilcam {

// A record is the midpoint and half the length of its span [s], then the coefficients of each function. After
// the records come the beginning of the first, the length of each, the words of each, and their number.
class ChebyshevRecords {
  public:
    static constexpr std::size_t kMaxSets = 6;

    // sets: number of functions, at most kMaxSets. Throws InputError.
    ChebyshevRecords(std::vector<double> words, const std::string& where, std::size_t sets)
        : words_(std::move(words), where), sets_(sets) {
        record_ = words_.count_from_end(2, "words of a record", static_cast<double>(2 + sets_), 1e6);
        count_ = words_.count_from_end(1, "records", 1, kMaxRecords);
        begin_s_ = words_.from_end(4), length_s_ = words_.from_end(3);
        if ((record_ - 2) % sets_ != 0)
            words_.fail("words of a record: found " + std::to_string(record_) +
                        "; accepted: 2 and a multiple of " + std::to_string(sets_));
        if (!(length_s_ > 0))
            words_.fail("length of a record: found " + plain(length_s_) + "; accepted: above 0");
        words_.require_size(count_ * record_ + 4);
        for (std::size_t i = 0; i < count_; ++i)
            if (!(words_[i * record_ + 1] > 0))
                words_.fail("record " + std::to_string(i + 1) + ": its radius is " +
                            plain(words_[i * record_ + 1]) + "; accepted: above 0");
    }

    // Returns the functions and their slopes per second. Loop.
    std::array<ChebyshevValue, kMaxSets> at(double et_s) const {
        const double index = std::floor((et_s - begin_s_) / length_s_);
        const auto i = static_cast<std::size_t>(std::clamp(index, 0.0, static_cast<double>(count_ - 1)));
        const std::size_t terms = (record_ - 2) / sets_, from = i * record_;
        const double radius_s = words_[from + 1];
        const double s = std::clamp((et_s - words_[from]) / radius_s, -1.0, 1.0);
        std::array<ChebyshevValue, kMaxSets> out;
        for (std::size_t k = 0; k < sets_; ++k) {
            out[k] = chebyshev_at(words_.piece(from + 2 + k * terms, terms), s);
            out[k].slope /= radius_s;
        }
        return out;
    }

  private:
    SegmentWords words_;
    std::size_t sets_, record_ = 0, count_ = 0;
    double begin_s_ = 0, length_s_ = 0;
};

}  // namespace hilcam
