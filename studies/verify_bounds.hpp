#pragma once
// How the long checks tell what they found.

#include <algorithm>
#include <cstdio>
#include <span>
#include <string>

namespace wisp::verify {

/// Prints each bound with what was found and remembers whether one was missed.
class Bounds {
 public:
  void at_least(const std::string& what, double found, double least) { tell(what, found, ">=", least, found >= least); }
  void at_most(const std::string& what, double found, double most) { tell(what, found, "<=", most, found <= most); }
  int missed() const { return missed_; }

 private:
  void tell(const std::string& what, double found, const char* sign, double bound, bool held) {
    std::printf("  %s  %-78s %8.3f %s %.3f\n", held ? "held  " : "MISSED", what.c_str(), found, sign, bound);
    missed_ += held ? 0 : 1;
  }

  int missed_ = 0;
};

/// A part of a long check, by the name that asks for it alone.
struct Check {
  const char* name;
  void (*run)(Bounds&);
};

/// Runs the checks that are named, all where none is. Returns what the program ends with: 1 where a bound was missed.
inline int run_checks(std::span<const Check> checks, std::span<char* const> names) {
  Bounds bounds;
  for (const Check& check : checks) {
    const auto wanted = [&](const char* name) { return std::string(name) == check.name; };
    if (!names.empty() && std::none_of(names.begin(), names.end(), wanted)) continue;
    check.run(bounds);
    std::fflush(stdout);
  }
  std::printf("\n%d bounds missed\n", bounds.missed());
  return bounds.missed() == 0 ? 0 : 1;
}

}  // namespace wisp::verify
