#pragma once
// Instances of one model, stepped together. A single flame is a bank of one.
//
// The frame path (everything here but bank_bytes(), create(), the destructor and an error of restore()) allocates
// nothing, takes no lock and makes no system call. Outputs depend only on the model, the seed, each instance's stream
// and its inputs: the same bits with any compiler, at any level of optimisation, in a bank of any size, in any slot.
//
// Bulk buffers have one row per slot, in slot order: row `id.slot` belongs to instance `id`. Rows of empty slots, and
// the part of a buffer beyond slots(), are ignored in inputs and zero in outputs: a buffer of capacity() rows is always
// large enough.
//
// A bank is used by one thread at a time (which may delegate to others, set_crew()); different banks are independent.

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

class BodyFacet;
class ChainFacet;
class ExtinctionFacet;

/// Identifies one instance of a bank. The next instance in the slot of an ended one has another generation.
struct InstanceId {
  std::uint32_t slot = 0;
  std::uint32_t generation = 0;  ///< 0 names no instance

  friend bool operator==(const InstanceId&, const InstanceId&) = default;
};

/// Default and upper bound of BankOptions::longest_advance.
inline constexpr std::chrono::nanoseconds kLongestAdvance = std::chrono::seconds(10);

/// Options of creating a bank.
struct BankOptions {
  int capacity = 1;          ///< largest number of instances alive at once; 1 to 1 048 576
  std::uint64_t seed = 1;    ///< seed of all random streams of the bank
  int polyline_points = 32;  ///< points of an outline's polyline; 2 to 4096. 32 is smooth at a height of 500 pixels
  std::chrono::nanoseconds longest_advance = kLongestAdvance;  ///< longest pause that advance() plays, > 0, ≤ 10 s
  std::span<std::byte> memory = {};  ///< memory for the bank, at least bank_bytes(); empty: create() allocates it
};

/// Returns the number of bytes that a bank with these options needs; `options.memory` is ignored.
/// Errors: those of Bank::create().
Result<std::size_t> bank_bytes(const Model& model, const BankOptions& options);

/// Returns the duration of one step of a model, in the whole nanoseconds that banks use.
std::chrono::nanoseconds step_time(const Model& model);

/// Share of the width of the trained range by which inputs and outputs may exceed it, on either side.
inline constexpr double kRangeMargin = 0.5;

/// A flame as a light source.
struct FlameLight {
  std::array<float, 3> position{};  ///< centroid of the outline's control points as a polygon; z of a body, else 0
  float intensity = 0;              ///< area of the control polygon relative to that of the flame at rest
  float kelvin = 0;                 ///< colour temperature: 1900 K at rest, times the 16th root of the intensity
};

/// Threads of the caller that step parts of a bank in parallel. `run` calls task(of, part) for every part below
/// `parts`, each once and on any thread, and returns when all calls have returned.
struct Crew {
  int parts = 1;  ///< number of parts; if it is 1, or `run` null, the calling thread steps all instances
  void (*run)(void* pool, int parts, void (*task)(void* of, int part), void* of) = nullptr;
  void* pool = nullptr;  ///< first argument of `run`
};

/// A bank of instances of one model. Precondition: a bulk buffer has room for slots() rows or more, any other span has
/// exactly the stated size. Checked in every build: a call that violates this is reported (wisp/base/result.hpp) and
/// does nothing. Precondition of all functions but move and destruction: the bank has not been moved from.
class Bank {
 public:
  struct State;  ///< private to run/

  /// Creates an empty bank. The needed parts of the model are copied, and it may be destroyed afterwards; memory given
  /// by the caller must outlive the bank. Errors: the model is not valid (check()) or holds numbers outside single
  /// precision, an option is out of its range, the memory is too small or cannot be allocated.
  static Result<Bank> create(const Model& model, const BankOptions& options = {});

  Bank(Bank&& other) noexcept;
  Bank& operator=(Bank&& other) noexcept;
  ~Bank();

  // Properties.
  int capacity() const;
  int size() const;             ///< number of instances alive
  int slots() const;            ///< rows of every bulk buffer: one more than the highest slot in use
  int input_count() const;      ///< number of external inputs
  int output_count() const;     ///< for an outline: x and y of each control point, as OutlineView orders them
  int polyline_points() const;  ///< 0 if the view is not an outline
  std::chrono::nanoseconds step_time() const;

  /// Starts an instance at the model's operating point, in the lowest empty slot, with all inputs zero. Its random
  /// stream is `stream`, or the count of spawns so far. Two instances with equal streams and inputs have equal outputs.
  /// Returns its id; an invalid id when the bank is full.
  InstanceId spawn();
  InstanceId spawn(std::uint64_t stream);

  /// Ends an instance. Returns false, and does nothing, when `id` is not valid.
  bool end(InstanceId id);

  /// Returns whether `id` names a living instance.
  bool valid(InstanceId id) const;

  /// Returns the id of the instance in a slot; an invalid one when the slot is empty.
  InstanceId at(int slot) const;

  /// Sets the inputs of every instance from the next step on: slots() × input_count(), in the inputs' units. Numbers
  /// are clamped to the trained range extended by kRangeMargin; NaN counts as 0.
  void set_inputs(std::span<const float> values);

  /// Sets equal inputs for every instance: input_count() values.
  void set_common_inputs(std::span<const float> values);

  /// Sets the inputs of one instance: input_count() values. Returns false when `id` is not valid.
  bool set_inputs(InstanceId id, std::span<const float> values);

  /// Sets the scale of the residual noise: 1 as learned, 0 none; clamped to [0, 10]. NaN and scales below 1e-6 count as
  /// 0. At 0 a step is cheaper, and a switched model takes the likeliest transition. A segment chain has only random
  /// choices, no residual noise: at 0 it takes the likeliest mode, and of this mode's segments the best-joining or,
  /// without a list of successors, the first. Instances then differ by their initial heading alone, and their motion
  /// eventually becomes periodic. For a chain, all scales above 0 have the same effect.
  void set_noise(float scale);
  float noise() const;

  /// Makes one step of the model, for all instances. Outputs read afterwards are those of that step.
  void step();

  /// Makes many steps in one call, for offline play, with the same bits as single steps. Row t of `inputs`, slots() ×
  /// input_count(), is set before step t, and the last one stays set; empty: the inputs stay as they are. Row t of
  /// `outputs`, slots() × output_count(), receives the outputs after step t; empty: they are not read.
  /// Precondition: count >= 0; `inputs` and `outputs` have `count` rows, or none.
  void step(int count, std::span<const float> inputs = {}, std::span<float> outputs = {});

  /// Advances time: makes the steps that fall due, and interpolates outputs between the last two steps (one step of
  /// latency). Negative time counts as 0, time above BankOptions::longest_advance as longest_advance.
  /// Returns the number of steps made.
  int advance(std::chrono::nanoseconds time);

  /// Advances time in seconds; NaN counts as 0.
  int advance(double seconds);

  /// Distributes step() and advance() over a crew from now on: each part steps some of the instances, with the same
  /// bits. Worthwhile from some thousand instances on. Once an instance of a chain has been steered, the calling thread
  /// makes all steps.
  void set_crew(const Crew& crew);

  /// Reads all outputs: slots() × output_count(), in the outputs' units. They are clamped to the trained range extended
  /// by kRangeMargin, then multiplied by a flame's size (LitState::size). A chain's positions are clamped to ±1000 km.
  void outputs(std::span<float> values) const;

  /// Reads the outputs of one instance: output_count() values. Returns false when `id` is not valid.
  bool outputs(InstanceId id, std::span<float> values) const;

  /// Reads all outlines: slots() × polyline_points() × (x, y), from the base's left over the tip to the base's right at
  /// equal steps of the spline's parameter. Precondition: polyline_points() > 0.
  void polylines(std::span<float> values) const;

  /// Reads the outline of one instance: polyline_points() × (x, y). Returns false when `id` is not valid.
  bool polyline(InstanceId id, std::span<float> values) const;

  /// Returns the light of an instance whose view is an outline; nothing for another view or an invalid `id`.
  std::optional<FlameLight> light(InstanceId id) const;

  /// Returns the mode of a switched ARX model that produced an instance's newest sample; nothing before its first step
  /// and for other models.
  std::optional<int> mode(InstanceId id) const;

  /// Return facets, the functions for one kind of model; null for a model of another kind. Facets live as long as the
  /// bank, move with it, and are cheap enough to be requested every frame.
  ChainFacet* chain();  ///< for a segment chain (wisp/run/chain_facet.hpp)
  const ChainFacet* chain() const;
  ExtinctionFacet* extinction();  ///< for a model with a rule of extinction (wisp/run/extinction_facet.hpp)
  const ExtinctionFacet* extinction() const;
  BodyFacet* body();  ///< for a model of a body (wisp/run/body_facet.hpp)
  const BodyFacet* body() const;

  /// Resets one instance, or all instances and the time passed since the last step, to the state after spawn(); streams
  /// and inputs stay. Returns false when `id` is not valid.
  bool reset(InstanceId id);
  void reset();

  /// Counts since the bank was created; restore() sets them too. `steps`: steps of every instance, added up. `clamped`:
  /// those in which at least one output of a burning instance was clamped to its range. If ordinary input gives more
  /// than 1 in 1000, the model is not usable. A chain's positions count as clamped beyond 1000 km from the origin.
  struct Clamped {
    std::uint64_t clamped = 0;
    std::uint64_t steps = 0;
  };
  Clamped clamped() const;

  /// Returns the number of bytes that save() writes for a bank with this model and capacity.
  std::size_t save_bytes() const;

  /// Writes the state of the bank, settings included: a bank restored from it continues with the same bits.
  /// Precondition: `bytes` has save_bytes() bytes.
  void save(std::span<std::byte> bytes) const;

  /// Restores a state, seed included, that save() wrote for a bank with the same model and capacity.
  /// Errors: too short or too long, not a bank's state, a version that this build does not read, another model or
  /// capacity, damaged. The bank is then unchanged.
  Result<void> restore(std::span<const std::byte> bytes);

 private:
  friend Result<std::size_t> bank_bytes(const Model& model, const BankOptions& options);

  struct Release {
    bool owned = false;
    void operator()(State* state) const;
  };

  explicit Bank(std::unique_ptr<State, Release> state);

  std::unique_ptr<State, Release> state_;
};

}  // namespace wisp
