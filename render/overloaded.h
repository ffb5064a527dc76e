#pragma once
// Lambdas as one visitor: std::visit(Overloaded{[](A) {...}, [](B) {...}}, variant).

namespace hilcam {

template <class... F>
struct Overloaded : F... {
    using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

}  // namespace hilcam
