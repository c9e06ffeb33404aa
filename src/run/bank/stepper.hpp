#pragma once
// Steppers of all dynamics. A new kind needs a stepper file with ArxStepper's public functions, and entries here.

#include <type_traits>
#include <variant>

#include "run/arx/arx_stepper.hpp"
#include "run/chain/chain_stepper.hpp"

namespace wisp {

/// Stepper for dynamics of a kind, on numbers N.
template <class Kind, class N>
struct StepperOf;

template <class N>
struct StepperOf<ArxModel, N> {
  using Type = ArxStepper<N>;
};

template <class N>
struct StepperOf<ChainModel, N> {
  using Type = ChainStepper<N>;
};

template <class N>
struct StepperOf<SwitchedArxModel, N> {
  using Type = SwitchedStepper<N>;
};

using Stepper = std::variant<ArxStepper<LiveNumbers>, ChainStepper<LiveNumbers>, SwitchedStepper<LiveNumbers>>;

// Each kind is compiled in its own file, so that a build can optimise each for speed or for size.
#ifndef WISP_FRAME_PATH  // the wide versions are compiled with frame_path.cpp
extern template class ArxStepper<LiveNumbers>;
extern template class ChainStepper<LiveNumbers>;
extern template class ArxStepper<LiveNumbers, ModeLanes<LiveNumbers>>;
#endif

/// Calls use(dynamics, kind), where `kind` is a std::type_identity of the stepper of the model's dynamics.
template <class N, class Use>
auto visit_dynamics(const Model& model, Use use) {
  return std::visit(
      [&]<class Kind>(const Kind& dynamics) {
        return use(dynamics, std::type_identity<typename StepperOf<Kind, N>::Type>());
      },
      model.dynamics);
}

}  // namespace wisp
