#include "run/arx/arx_stepper.hpp"

namespace wisp {

template class ArxStepper<LiveNumbers>;
template class ArxStepper<LiveNumbers, ModeLanes<LiveNumbers>>;

}  // namespace wisp
