#include "run/chain/chain_stepper.hpp"

namespace wisp {

template class ChainStepper<LiveNumbers>;

}  // namespace wisp
