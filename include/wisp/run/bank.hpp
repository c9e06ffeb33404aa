#pragma once
// Living instances of one model, stepped together. A single flame is a bank of one.
//
// The frame path (everything here but create() and the destructor) allocates nothing, takes no lock and makes no system
// call. What comes out depends only on the model, the seed, each instance's stream number and its inputs: the same bits
// with any compiler, at any level of optimisation, in a bank of any size and in any slot of it.
//
// Bulk buffers have one row per slot, in the order of the slots: row `id.slot` belongs to instance `id`. Rows of empty
// slots are ignored on the way in and are zeros on the way out.
//
// A bank is used by one thread at a time; different banks are independent.

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

/// Names one living instance of a bank, by value. The id of an ended instance stays invalid: the next one in its slot
/// has another generation.
struct InstanceId {
  std::uint32_t slot = 0;
  std::uint32_t generation = 0;  ///< 0 names no instance

  friend bool operator==(const InstanceId&, const InstanceId&) = default;
};

/// Where an instance of a segment chain is.
struct ChainPlace {
  std::uint32_t segment = 0;  ///< index into ChainModel::segments
  std::uint32_t step = 0;     ///< of that segment; at 0 it was joined to the one before
};

/// A body at one moment, in the world: metres, seconds, radians, z up.
struct BodyMoment {
  std::array<float, 3> position{};
  std::array<float, 4> orientation{1, 0, 0, 0};  ///< body to world, w first; its length does not matter
  std::array<float, 3> velocity{};
  std::array<float, 3> spin{};  ///< angular velocity, world axes
};

/// Where a body is to be, and when.
struct SteerTarget {
  std::array<float, 3> position{};  ///< in the world, metres
  std::chrono::nanoseconds in{};    ///< from now; above 0, at most 10 000 s
  float near = 0.1f;  ///< metres, 0.001 to 1000: how near is near enough. The nearer, the more the fall is bent to it
};

/// How a bank is made.
struct BankOptions {
  int capacity = 1;                  ///< most instances alive at once; 1 to 1 048 576
  std::uint64_t seed = 1;            ///< of all random streams of the bank
  int polyline_points = 32;          ///< points of an outline's polyline; 2 to 4096. 32 is smooth at 500 pixels' height
  std::span<std::byte> memory = {};  ///< where it lives, at least bank_bytes(); none: it allocates once
};

/// Bytes that a bank with these options needs, wherever its memory comes from (`options.memory` is not looked at).
/// Errors: as Bank::create().
Result<std::size_t> bank_bytes(const Model& model, const BankOptions& options);

/// The time of one step of a model, as banks keep it: whole nanoseconds.
std::chrono::nanoseconds step_time(const Model& model);

/// The age of what never happened.
inline constexpr std::chrono::nanoseconds kNever = std::chrono::nanoseconds::max();

/// Whether an instance burns, and how that shows. Ages are of what is shown, in time that passed through steps; a
/// drawing makes smoke and ember of them.
struct LitState {
  bool lit = true;
  float size = 1;  ///< of what is seen, 0 … 1; outputs and polylines are already multiplied by it
  std::chrono::nanoseconds since_lit = kNever;  ///< since it was last lit again; one that was spawned lit was not
  std::chrono::nanoseconds since_out = kNever;  ///< since it last went out
};

/// A longer pause than this is cut to it by Bank::advance(): nobody has watched it.
inline constexpr std::chrono::nanoseconds kLongestAdvance = std::chrono::seconds(10);

/// Share of the trained or seen range by which inputs and outputs may go beyond it, on either side.
inline constexpr double kRangeMargin = 0.5;

/// A bank of instances of one model.
///
/// Precondition of every bulk function: the span has exactly the stated size.
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
  int input_count() const;      ///< external inputs, before signs are split
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
  /// beyond the trained range and kRangeMargin are held to it; what is not a number counts as 0.
  void set_inputs(std::span<const float> values);

  /// The same inputs for every instance: input_count() values.
  void set_common_inputs(std::span<const float> values);

  /// The inputs of one instance: input_count() values. Returns false when `id` is not valid.
  bool set_inputs(InstanceId id, std::span<const float> values);

  /// Scale of the residual noise: 1 as learned, 0 none; held to [0, 10]. At 0 a step costs less.
  /// A segment chain has no residual noise, its chance is in its walk: at 0 the likeliest mode follows, as the segment
  /// that joins best. Instances that are spawned then differ by their first heading alone, and their lives sooner or
  /// later repeat themselves (chain_loop() in wisp/run/chain_loop.hpp tells when). Any other scale leaves a chain as it
  /// is.
  void set_noise(float scale);
  float noise() const;

  /// Limits how many modes back a segment chain looks when it chooses the next one; 0: as many as it has learned to, as
  /// at first. Counts below 0 are 0. It acts from the next draw on, a step before a join; may change at any time; and
  /// changes nothing where the dynamics are not a chain.
  void set_history(int longest);
  int history() const;

  /// How a segment chain chooses among the segments of a mode: each is T / (1 + T) times as likely as the one that
  /// joins next best, so that the one of rank T, counted from 0, is about the usual one. 0: always the best; infinity:
  /// any segment of the mode alike. Nothing, as at first: as learned, one of the best few. What is below 0 or not a
  /// number counts as 0. A chain that was learned without best-joining segments has nothing to choose by, and is left
  /// as it is.
  void set_temperature(std::optional<float> temperature);
  std::optional<float> temperature() const;

  /// One step of the model, for all instances. Outputs read afterwards are those of that step.
  void step();

  /// Lets time pass: makes the steps that fall into it, and shows the outputs between the last two steps in proportion
  /// (one step of latency). A negative time counts as none, a longer one than kLongestAdvance as that. Returns the
  /// number of steps made.
  int advance(std::chrono::nanoseconds time);

  /// Reads all outputs: slots() × output_count(), in the outputs' units, held to the seen range and kRangeMargin (those
  /// of an instance that is out, or about to be, lie between there and 0). A chain's positions go as far as they go.
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

  /// Where in its chain an instance is; nothing where the dynamics are not a chain or `id` is not valid.
  std::optional<ChainPlace> chain_place(InstanceId id) const;

  /// The mode of a switched ARX model that made an instance's newest sample; nothing for other models, before the first
  /// step, and for ids that are not valid.
  std::optional<int> arx_mode(InstanceId id) const;

  /// Sets an instance of a chain where a body is, as after a collision or a kick: it goes on with the segment that
  /// begins most as the body moves, the rest fading as at any join. Where the chain is not free of heading, or has no
  /// orientation, that part of the body is not taken over. Looks at every segment once: not for every frame.
  /// Returns false, and does nothing, when `id` is not valid, a number is not finite, or the dynamics are not a chain.
  bool place(InstanceId id, const BodyMoment& body);

  /// Steers an instance of a chain: at joins it prefers what leads to the target, weighed against how likely that is,
  /// until the time has come; then it falls on as before. What lies beyond its reach is not reached. A new target takes
  /// the place of the one before; placing and resetting end it. A join costs more meanwhile; docs/chains.md has
  /// figures. Returns false, and does nothing, when `id` is not valid, a number is out of its range, or the model can't
  /// be steered: not a chain, or one that was learned before chains could be.
  bool steer(InstanceId id, const SteerTarget& target);

  /// Lets an instance fall as it will. Returns false when `id` is not valid.
  bool release(InstanceId id);

  /// The height of level ground, on which instances of a chain come to rest until they are placed or reset; nothing:
  /// they fall for ever, as at first. A body whose size the view knows touches with its lowest corner, and no corner
  /// sinks in while it lies down.
  void set_ground(std::optional<float> height);
  std::optional<float> ground() const;

  /// Whether the model has a rule of extinction (wisp/model/extinction.hpp). Where it has one, instances whose wind the
  /// rule finds too strong go out in a step and stay out, whatever the wind does then; their outputs shrink to 0 and
  /// are 0 until they are lit again. Their random streams go on. Where it has none, everything burns for ever.
  bool goes_out() const;

  /// Whether an instance burns; nothing when `id` is not valid.
  std::optional<LitState> lit_state(InstanceId id) const;

  /// The same of all: slots() values; what is in an empty slot does not burn and never did.
  void lit_states(std::span<LitState> states) const;

  /// Lights an instance that is out: it starts at the model's operating point, unharmed, and grows from the size that
  /// is left of it. One that burns goes on. Returns false when `id` is not valid.
  bool relight(InstanceId id);

  /// Puts an instance out, whatever the wind. One that is out stays so; without a rule of extinction nothing happens.
  /// Returns false when `id` is not valid.
  bool extinguish(InstanceId id);

  /// Puts one instance, or all that live and the bank's time, back to where they were when spawned, lit; streams and
  /// inputs stay. Returns false when `id` is not valid.
  bool reset(InstanceId id);
  void reset();

  /// How many instance-steps there were since the bank was made or restored, and in how many of them at least one
  /// output of an instance that burns was held at its range. More than 1 in 1000 on ordinary input says that the model
  /// is not usable. A chain's positions have no range: they are held at 1000 km from the origin.
  struct Held {
    std::uint64_t held = 0;
    std::uint64_t steps = 0;
  };
  Held held() const;

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
