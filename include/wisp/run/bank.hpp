#pragma once
// Living instances of one model, stepped together. A single flame is a bank of one.
//
// The frame path (everything here but create() and the destructor) allocates nothing, takes no lock and makes no system
// call. What comes out depends only on the model, the seed, each instance's stream number and its inputs: the same bits
// with any compiler, at any level of optimisation, in a bank of any size and in any slot of it.
//
// Bulk buffers have one row per slot, in the order of the slots: row `id.slot` belongs to instance `id`. Rows of empty
// slots, and what a buffer has beyond slots(), are ignored on the way in and are zeros on the way out: a buffer of
// capacity() rows always serves.
//
// A bank is used by one thread at a time (which may have others step it, set_crew()); different banks are independent.

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

/// Names one living instance of a bank, by value. The id of an ended instance stays invalid: the next one in its slot
/// has another generation.
struct InstanceId {
  std::uint32_t slot = 0;
  std::uint32_t generation = 0;  ///< 0 names no instance

  friend bool operator==(const InstanceId&, const InstanceId&) = default;
};

/// A longer pause is cut to this by Bank::advance(): nobody has watched it.
inline constexpr std::chrono::nanoseconds kLongestAdvance = std::chrono::seconds(10);

/// How a bank is made.
struct BankOptions {
  int capacity = 1;          ///< most instances alive at once; 1 to 1 048 576
  std::uint64_t seed = 1;    ///< of all random streams of the bank
  int polyline_points = 32;  ///< points of an outline's polyline; 2 to 4096. 32 is smooth at 500 pixels' height
  std::chrono::nanoseconds longest_advance = kLongestAdvance;  ///< what advance() cuts pauses to: above 0, at most that
  std::span<std::byte> memory = {};  ///< where it lives, at least bank_bytes(); none: it allocates once
};

/// Bytes that a bank with these options needs, wherever its memory comes from (`options.memory` is not looked at).
/// Errors: as Bank::create().
Result<std::size_t> bank_bytes(const Model& model, const BankOptions& options);

/// The time of one step of a model, as banks keep it: whole nanoseconds.
std::chrono::nanoseconds step_time(const Model& model);

/// Share of the trained or seen range by which inputs and outputs may go beyond it, on either side.
inline constexpr double kRangeMargin = 0.5;

/// A flame as a source of light.
struct FlameLight {
  std::array<float, 3> position{};  ///< the middle of its outline, in the outline's units; z in the round, 0 elsewhere
  float intensity = 0;              ///< its area against that of the flame at rest
  float kelvin = 0;                 ///< colour temperature: 1900 K at rest, times the 16th root of the intensity
};

/// Threads of the caller's that step parts of a bank at once. `run` calls task(of, part) for every part below `parts`,
/// each once and on any thread, and returns when all calls have returned.
struct Crew {
  int parts = 1;  ///< one, or without `run`: the calling thread does all
  void (*run)(void* pool, int parts, void (*task)(void* of, int part), void* of) = nullptr;
  void* pool = nullptr;  ///< handed to `run`
};

/// A bank of instances of one model.
///
/// Precondition of every bulk function: the span has room for slots() rows or more; of every other one: exactly the
/// stated size. Checked in every build: a call that breaks it is reported (wisp/base/result.hpp) and does nothing.
/// Precondition of all but move and destruction: the bank has not been moved from.
class Bank {
 public:
  struct State;  ///< private to run/

  /// Makes an empty bank. The model is copied as far as it is needed and may go afterwards; memory that the caller
  /// gives must outlive the bank.
  /// Errors: the model is not valid (check()) or holds numbers that single precision can't, an option is out of its
  /// range, the memory is too small.
  static Result<Bank> create(const Model& model, const BankOptions& options = {});

  Bank(Bank&& other) noexcept;
  Bank& operator=(Bank&& other) noexcept;
  ~Bank();

  // Facts.
  int capacity() const;
  int size() const;             ///< instances alive
  int slots() const;            ///< rows of every bulk buffer: one more than the highest slot in use
  int input_count() const;      ///< external inputs
  int output_count() const;     ///< for an outline: x and y of each control point, as OutlineView orders them
  int polyline_points() const;  ///< 0 where the view is not an outline
  std::chrono::nanoseconds step_time() const;

  /// Starts an instance at the model's operating point, in the lowest empty slot, with all inputs zero. Its random
  /// stream is `stream`, or the count of spawns so far. Two instances of the same stream and inputs live the same life.
  /// Returns its id; an id that is not valid when the bank is full.
  InstanceId spawn();
  InstanceId spawn(std::uint64_t stream);

  /// Ends an instance. Returns false, and does nothing, when `id` is not valid.
  bool end(InstanceId id);

  /// Whether `id` names a living instance.
  bool valid(InstanceId id) const;

  /// The id of the instance in a slot; not valid when the slot is empty.
  InstanceId at(int slot) const;

  /// Sets what acts on every instance from the next step on: slots() × input_count(), in the inputs' units. Numbers
  /// beyond the trained range and kRangeMargin are clamped to it; what is not a number counts as 0.
  void set_inputs(std::span<const float> values);

  /// The same inputs for every instance: input_count() values.
  void set_common_inputs(std::span<const float> values);

  /// The inputs of one instance: input_count() values. Returns false when `id` is not valid.
  bool set_inputs(InstanceId id, std::span<const float> values);

  /// Scale of the residual noise: 1 as learned, 0 none; clamped to [0, 10]. At 0 a step costs less.
  /// A segment chain has no residual noise, its chance is in its walk: at 0 the likeliest mode follows, as the segment
  /// that joins best. Instances that are spawned then differ by their first heading alone, and their lives sooner or
  /// later repeat themselves. Any other scale leaves a chain as it is.
  void set_noise(float scale);
  float noise() const;

  /// One step of the model, for all instances. Outputs read afterwards are those of that step.
  void step();

  /// Many steps in one call, for play offline: the same bits as so many single ones. Row t of `inputs`, slots() ×
  /// input_count(), is set before step t, and stays set after the last; none: what was set acts on all. Row t of
  /// `outputs`, slots() × output_count(), is what is read after it; none: nothing is.
  ///
  /// Precondition: count >= 0; `inputs` and `outputs` have `count` rows, or none.
  void step(int count, std::span<const float> inputs = {}, std::span<float> outputs = {});

  /// Lets time pass: makes the steps that fall into it, and shows the outputs between the last two steps in proportion
  /// (one step of latency). A negative time counts as none, a longer one than BankOptions::longest_advance as that.
  /// Returns the number of steps made.
  int advance(std::chrono::nanoseconds time);

  /// The same with seconds; what is not a number counts as none.
  int advance(double seconds);

  /// From now on step() and advance() are shared by a crew: each part steps some of the instances, with the same bits.
  /// Worth its while from some thousand instances on. A chain in which an instance has been steered is stepped by the
  /// calling thread.
  void set_crew(const Crew& crew);

  /// Reads all outputs: slots() × output_count(), in the outputs' units, clamped to the seen range and kRangeMargin
  /// (those of an instance that is out, or about to be, lie between there and 0). A chain's positions go as far as they
  /// go.
  void outputs(std::span<float> values) const;

  /// Reads the outputs of one instance: output_count() values. Returns false when `id` is not valid.
  bool outputs(InstanceId id, std::span<float> values) const;

  /// Reads all outlines: slots() × polyline_points() × (x, y), from the base's left over the tip to the base's right at
  /// equal steps of the spline's parameter.
  ///
  /// Precondition: polyline_points() > 0.
  void polylines(std::span<float> values) const;

  /// Reads the outline of one instance: polyline_points() × (x, y). Returns false when `id` is not valid.
  bool polyline(InstanceId id, std::span<float> values) const;

  /// The light of an instance whose view is an outline; nothing where it is none or `id` is not valid.
  std::optional<FlameLight> light(InstanceId id) const;

  /// The mode of a switched ARX model that made an instance's newest sample; nothing where there is none.
  std::optional<int> mode(InstanceId id) const;

  /// What only some models have is asked of a facet, which is null where the model has none of it. Facets live as long
  /// as the bank, move with it, and may be asked for every frame.
  ChainFacet* chain();  ///< of a segment chain (wisp/run/chain_facet.hpp)
  const ChainFacet* chain() const;
  ExtinctionFacet* extinction();  ///< where there is a rule of extinction (wisp/run/extinction_facet.hpp)
  const ExtinctionFacet* extinction() const;
  BodyFacet* body();  ///< of a model in the round (wisp/run/body_facet.hpp)
  const BodyFacet* body() const;

  /// Puts one instance, or all that live and the bank's time, back to where they were when spawned, lit; streams and
  /// inputs stay. Returns false when `id` is not valid.
  bool reset(InstanceId id);
  void reset();

  /// How many instance-steps there were since the bank was made or restored, and in how many of them at least one
  /// output of an instance that burns was clamped at its range. More than 1 in 1000 on ordinary input says that the
  /// model is not usable. A chain's positions have no range: they are clamped at 1000 km from the origin.
  struct Clamped {
    std::uint64_t clamped = 0;
    std::uint64_t steps = 0;
  };
  Clamped clamped() const;

  /// Bytes that save() writes for a bank with this model and capacity.
  std::size_t save_bytes() const;

  /// Writes the whole state of the bank, all that was set included, so that a bank restored from it goes on with the
  /// same bits.
  ///
  /// Precondition: `bytes` has save_bytes() bytes.
  void save(std::span<std::byte> bytes) const;

  /// Takes over a state written by save() of a bank with the same model and capacity (the seed comes with it).
  /// Errors: too short or too long, not a bank's state, a version that this build does not read, another model or
  /// capacity, damaged. The bank stays as it was then.
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
