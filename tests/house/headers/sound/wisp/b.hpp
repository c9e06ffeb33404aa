#pragma once
#include "wisp/a.hpp"

namespace wisp {
std::vector<int> b();
}
