#include "run/arx/switched_stepper.hpp"

namespace wisp {

template class SwitchedStepper<LiveNumbers>;

}  // namespace wisp
