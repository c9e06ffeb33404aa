#pragma once
// Figures of segment chains, in the shape that every command gives them.

#include "terminal.hpp"
#include "wisp/learn/chain_fidelity.hpp"
#include "wisp/model/model.hpp"

namespace wisp::cli {

/// A square matrix, row by row.
Json matrix_json(const std::vector<double>& values, int size);

Json fidelity_json(const ChainFidelity& fidelity);
Json join_defect_json(const JoinDefect& defect);

/// A few lines for people.
void say_fidelity(const ChainFidelity& fidelity, Terminal& terminal);

/// The figures that a model's file keeps.
void add_figures(const ChainFidelity& fidelity, Training& made);

}  // namespace wisp::cli
