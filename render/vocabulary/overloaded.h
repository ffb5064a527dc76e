#pragma once
// Combines lambdas to one visitor: std::visit(Overloaded{[](A) {...}, [](B) {...}}, variant).
//
// End it with OneOf instead of a plain `auto`: [](const OneOf<C, D> auto&) {} names the alternatives that
// need nothing, so an alternative that is added later does not compile until somebody decides about it.

#include <concepts>

namespace hilcam {

template <class T, class... Named>
concept OneOf = (std::same_as<T, Named> || ...);

template <class... F>
struct Overloaded : F... {
    using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

}  // namespace hilcam
