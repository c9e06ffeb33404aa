#pragma once
// How the long checks tell what they found.

#include <cstdio>
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

}  // namespace wisp::verify
