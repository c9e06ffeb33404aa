#pragma once
// Stands on what a.hpp includes, without including it.

namespace wisp {
std::vector<int> b();
}
