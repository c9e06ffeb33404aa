#pragma once
// Shapes of a take: points of the spline, Bézier curves, operating point, surfaces of flames and leaves. Seamless loops
// of a play: the periodic orbit of a linear model, and a chain's walk that returns to its start.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/export/export.hpp"
#include "wisp/run/bank.hpp"

namespace wisp::exporting {

/// Returns points of the spline at equal steps of its parameter, as x, y, 0.
std::vector<float> outline_points(const std::vector<double>& knots, std::span<const double> control, int points);

/// Returns the spline as consecutive cubic Bézier curves: 3 · curves + 1 points, as neighbouring curves share one.
std::vector<std::array<double, 2>> bezier_points(const std::vector<double>& knots, std::span<const float> control);

/// Returns the operating point of the outputs of an ARX or switched model; zeros for a chain.
std::vector<double> operating_point(const Model& model);

inline constexpr int kRings = 12, kSegments = 12;  ///< mesh size of an exported flame

/// Computes the circular rings of a body (wisp/run/body_facet.hpp) from its outlines in front view and in side view.
/// `side` is empty for a model without a side view. The result is linear in both outlines.
std::vector<float> rings_of(const std::vector<double>& knots, std::span<const float> front,
                            std::span<const float> side);

/// Return the vertex positions of the surface through rings, and three vertex indices per triangle of the surface.
std::vector<float> ring_places(const std::vector<float>& rings, int segments);
std::vector<std::uint16_t> ring_corners(int rings, int segments);

/// A surface: x, y, z of vertices and of their normals, and three vertex indices per triangle.
struct Surface {
  std::vector<float> places, normals;
  std::vector<std::uint16_t> triangles;
};

/// Returns a leaf in a body's first two axes, folded and bent along its midrib, the first axis. Half sizes in metres;
/// an unknown length (0) becomes 0.03, an unknown width the length.
Surface leaf_blade(double half_first, double half_second);

/// Checks that a take fits a model. Errors: another number of outputs; no frames, instances or rate; a wrong number of
/// values or, for a loop of a chain, of travels.
Result<void> check_take(const Model& model, const Take& take);

/// Replaces rows of an ARX or switched model's outputs by the periodic orbit under their own shocks: adds to each row
/// the model's free response to the difference of the two ends, summed over all periods. `rows` begin lags − 1 rows
/// before the loop's first frame and end with the frame that equals the first; `mode`: each row's mode (switched
/// models). Returns false if the sum diverges. Precondition: rows.size() == (lags + frames) × outputs, lags ==
/// output_lags(model).
bool close_orbit(const Model& model, std::span<const std::size_t> mode, std::size_t lags, std::vector<double>& rows);

/// Returns the longest lag of an output in an ARX or switched model, at least 1.
std::size_t output_lags(const Model& model);

struct WalkLoop {
  std::vector<float> rows;  ///< frames × outputs; its first row is at the origin
  std::array<double, 3> travel{};
};

/// Plays banks of one chain until an instance returns to a row of a segment after exactly `frames` steps, and rotates
/// its walk evenly so that the frame after the last one has the attitude and the velocity of the first. Errors: no walk
/// returns; kStopped. Precondition: the model is a valid chain with stored segments; inputs.size() ==
/// model.inputs.size().
Result<WalkLoop> find_walk_loop(const Model& model, std::size_t frames, std::uint64_t seed,
                                const std::vector<float>& inputs, const Progress& progress);

}  // namespace wisp::exporting
