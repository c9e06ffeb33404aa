#pragma once
// The types behind the opaque handles of the C ABI.

#include <cstdint>

#include "wisp/model/model.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/wisp.h"

struct wisp_model {
  wisp::Model model;
};

struct wisp_bank {
  wisp::Bank bank;
};

namespace wisp::c {

inline InstanceId id_of(wisp_instance instance) {
  return {static_cast<std::uint32_t>(instance), static_cast<std::uint32_t>(instance >> 32)};
}

inline wisp_instance instance_of(InstanceId id) {
  if (id.generation == 0) return WISP_NO_INSTANCE;
  return static_cast<wisp_instance>(id.generation) << 32 | id.slot;
}

}  // namespace wisp::c
