#pragma once
// Lambdas as one visitor: std::visit(Overloaded{[](A) {...}, [](B) {...}}, variant).
//
// A last lambda of `auto` would take alternatives that are added later without anybody having thought of
// them. OneOf names those that need nothing: [](const OneOf<C, D> auto&) {}, and a new one does not compile.

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
