#pragma once
// What is said of a chain: how it was learned, and how like the recorded falls its own are.

#include "learn/chain/chain_fidelity.hpp"
#include "learn/chain/chain_fit.hpp"
#include "wisp/base/report.hpp"

namespace wisp::chain {

ReportSection segments_section(const ChainSummary& summary);

/// `fidelity` and `join_defect`; without orientation what needs one is for programs only.
ReportSection fidelity_section(const ChainFidelity& fidelity, bool has_orientation);

/// The figures that a model keeps.
void add_figures(const ChainFidelity& fidelity, Training& training);

/// Measures by name, and those of which the recorded falls are too few or too short to say anything.
struct Judged {
  std::string judged;
  std::string unjudged;
};

Judged judged_by(const ChainFidelity& fidelity);

/// Why falls are not like the recorded ones: a measure near its ceiling, or past it. Nothing: they are.
std::optional<std::string> fault_of(const ChainFidelity& fidelity);

}  // namespace wisp::chain
