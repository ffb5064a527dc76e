#include "io/spice/kernel_pool.h"

#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

constexpr std::size_t kMaxNames = 300'000, kMaxNumbers = 10'000'000, kMaxTexts = 2'000'000;

}  // namespace

void KernelPool::assign(const std::string& name, KernelVariable value, bool append) {
    KernelVariable& kept = variables_[name];
    const bool empty = kept.numbers.empty() && kept.texts.empty();
    const std::size_t numbers = numbers_ + value.numbers.size() - (append ? 0 : kept.numbers.size()),
                      texts = texts_ + value.texts.size() - (append ? 0 : kept.texts.size());
    if (variables_.size() > kMaxNames || numbers > kMaxNumbers || texts > kMaxTexts)
        throw InputError(value.where + ": " + in_quotes(name) +
                         " is more than the kernels' variables may hold; accepted: " +
                         std::to_string(kMaxNames) + " names, " + std::to_string(kMaxNumbers) +
                         " numbers and " + std::to_string(kMaxTexts) + " texts at most, in all kernels");
    numbers_ = numbers, texts_ = texts;
    if (!append || empty) {
        kept = std::move(value);
        return;
    }
    if (kept.texts.empty() != value.texts.empty())
        throw InputError(value.where + ": adds " + (value.texts.empty() ? "numbers" : "texts") + " to " +
                         name + ", which has " + (kept.texts.empty() ? "numbers" : "texts") + " (" +
                         kept.where + ")");
    kept.numbers.insert(kept.numbers.end(), value.numbers.begin(), value.numbers.end());
    kept.texts.insert(kept.texts.end(), value.texts.begin(), value.texts.end());
    kept.where = std::move(value.where);
}

const KernelVariable* KernelPool::find(std::string_view name) const {
    const auto at = variables_.find(name);
    return at == variables_.end() ? nullptr : &at->second;
}

std::optional<std::span<const double>> KernelPool::numbers(std::string_view name) const {
    const KernelVariable* v = find(name);
    if (!v) return {};
    if (!v->texts.empty())
        throw InputError(v->where + ": " + std::string(name) + ": found a text; accepted: numbers");
    return std::span<const double>(v->numbers);
}

std::optional<std::span<const std::string>> KernelPool::texts(std::string_view name) const {
    const KernelVariable* v = find(name);
    if (!v) return {};
    if (v->texts.empty())
        throw InputError(v->where + ": " + std::string(name) + ": found a number; accepted: texts");
    return std::span<const std::string>(v->texts);
}

std::span<const double> KernelPool::require_numbers(std::string_view name, std::size_t count,
                                                    const std::string& what) const {
    const auto found = numbers(name);
    if (!found)
        throw InputError("no kernel has " + std::string(name) + ", which " + what +
                         " needs; accepted: a kernel with it");
    if (found->size() != count)
        throw InputError(find(name)->where + ": " + std::string(name) + ": found " +
                         std::to_string(found->size()) + " numbers; accepted: " + std::to_string(count));
    return *found;
}

std::optional<double> KernelPool::number(std::string_view name) const {
    const auto found = numbers(name);
    if (!found) return {};
    return found->front();
}

std::optional<int> KernelPool::integer(std::string_view name) const {
    const auto found = number(name);
    if (!found) return {};
    if (*found != std::floor(*found) || std::abs(*found) > 2e9)
        throw InputError(find(name)->where + ": " + std::string(name) + ": found " + plain(*found) +
                         "; accepted: a whole number");
    return static_cast<int>(*found);
}

std::optional<std::string> KernelPool::text(std::string_view name) const {
    const auto found = texts(name);
    if (!found) return {};
    return found->front();
}

}  // namespace hilcam
