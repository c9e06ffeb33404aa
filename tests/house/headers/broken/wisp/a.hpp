#pragma once
#include <vector>

namespace wisp {
std::vector<int> a();
}
