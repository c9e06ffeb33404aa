#pragma once
// What only a bank of a switched ARX model has (Bank::switched()): modes.

#include <optional>

#include "wisp/run/bank.hpp"

namespace wisp {

/// The modes of a switched model's instances. It lives as long as the bank, and moves with it.
class SwitchedFacet {
 public:
  /// The mode that made an instance's newest sample; nothing before the first step and when `id` is not valid.
  std::optional<int> mode_of(InstanceId id) const;

 private:
  friend struct Bank::State;  // makes it
  explicit SwitchedFacet(const Bank::State& state) : state_(&state) {}
  SwitchedFacet(const SwitchedFacet&) = delete;
  SwitchedFacet& operator=(const SwitchedFacet&) = delete;

  const Bank::State* state_;
};

}  // namespace wisp
