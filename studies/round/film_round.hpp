#pragma once
// Makers of films whose body is known, and what a joined recording says of one.

#include <cstddef>
#include <optional>

#include "wisp/record/recording.hpp"

/// Films the candle of round_flow.hpp; the arguments are those of the program from PREFIX on.
int film_round(int count, char** words);

/// Films drawn bodies, captures and joins them; prints how far axis and radius are off, and returns 1 beyond the
/// bounds.
int drawn_bodies();

/// A level section of a recorded body.
struct RoundCut {
  double x = 0, z = 0, radius = 0;  // pixels
};

/// At a height over the base, in pixels: between where the outlines in the planes of x and of z cross it. Nothing where
/// a row has no body, or does not reach it on both flanks.
std::optional<RoundCut> cut_at(const wisp::Recording& rings, std::size_t row, double y);

/// What coefficients of their own for x and for z win over shared ones on the last 30 % of a joined recording's rows.
int symmetry(const wisp::Recording& rings);
