#pragma once
// The state of a bank. This struct and the arrays of its spans are in one piece of memory.

#include "run/bank/extinction_lanes.hpp"
#include "run/bank/frame_path.hpp"
#include "run/bank/outline_lanes.hpp"
#include "run/bank/shape_lanes.hpp"
#include "run/bank/stepper.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/body_facet.hpp"
#include "wisp/run/chain_facet.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace wisp {

// The step number that stands for never. In a restored bank, an event older than the bank has a negative step number,
// which wraps around to just below 2^64; so "never" is 2^63, far from all step numbers.
inline constexpr std::uint64_t kNeverInSteps = std::uint64_t{1} << 63;
// Whether a block may make many steps before the next block makes its first. Builds for size make one step at a time,
// and Steps then has no inputs and outputs.
inline constexpr bool kAhead = WISP_BLOCKS_AT_ONCE > 1;
inline constexpr float kMaxNoise = 10.0f;
inline constexpr float kMinNoise = 1e-6f;  // a smaller noise gain counts as 0

struct Bank::State {
  static constexpr int kLanes = LiveNumbers::kLanes;

  State(const Model& model, const BankOptions& options, Arena& arena);

  int blocks() const { return (rows + kLanes - 1) / kLanes; }
  bool valid(InstanceId id) const {
    return id.generation != 0 && id.slot < static_cast<std::uint32_t>(capacity) && alive[id.slot] &&
           generation[id.slot] == id.generation;
  }
  ChainStepper<LiveNumbers>* chain_stepper() { return std::get_if<ChainStepper<LiveNumbers>>(&stepper); }
  const ChainStepper<LiveNumbers>* chain_stepper() const { return std::get_if<ChainStepper<LiveNumbers>>(&stepper); }
  const SwitchedStepper<LiveNumbers>* switched_stepper() const {
    return std::get_if<SwitchedStepper<LiveNumbers>>(&stepper);
  }
  float* regressors_of(int block) { return regressors.data() + block * channels.regressors.size() * kLanes; }
  float* shown_of(int block) { return shown.data() + block * visible * kLanes; }
  const float* shown_of(int block) const { return const_cast<State*>(this)->shown_of(block); }
  LifeLanes<float> life_of(int block) {
    const int first = block * kLanes;
    return {wind.data() + first, harm.data() + first, lit.data() + first};
  }
  bool burns(int slot) const { return !extinction.present || lit[slot] != 0.0f; }

  Moment<LiveNumbers> moment(int block, std::uint32_t* flags, int ahead = 0) const;
  void start(int slot);
  void relight(int slot);
  void extinguish(int slot);
  LitState lit_state(int slot) const;
  FlameLight light_of(int slot) const;
  template <class LanesOf>
  void take_inputs(int block, const LanesOf& lanes_of);
  void set_inputs(int block, const float* all_rows);
  void set_common_inputs(int block, const float* values);
  void set_lane_inputs(int slot, const float* values);  // null: sets zeros
  void step_all(const Steps& made);
  std::uint64_t step_blocks(int first, int last, const Steps& made);
  template <int kBlocks, class Dynamics>
  std::uint64_t step_group(Dynamics& dynamics, int first, const Steps& made, int blocks = kBlocks);
  template <class Dynamics>
  std::uint64_t step_alone(Dynamics& dynamics, const Steps& made);
  void read_block(int block, float* rows) const;  // fills in the block's rows of slots() × outputs
  bool lives_whole(int block) const;
  void read_whole_block(int block, float* rows) const;
  template <class Work>
  std::uint64_t share(Work work);  // returns the sum of work(first, end) over ranges of blocks that cover all
  std::uint32_t count_clamped(int block, const std::uint32_t* flags) const;
  void live_block(int block, const float* newest, std::uint64_t moment);
  void go_out(int slot, const float* newest, std::uint64_t moment);
  void begin_event(int slot, std::span<const std::uint32_t> events, std::uint64_t at);
  void play_event(int slot, const float* newest);
  float newest_of(int slot, std::size_t i, const float* newest) const;
  float recorded_component(std::size_t row, std::size_t component) const;
  float shape_in_event(int slot, std::size_t component, float dynamics, float share) const;
  std::size_t moved() const { return shape.empty() ? visible : shape.components(); }  // variables of the dynamics
  float& offset_of(int slot, std::size_t i) const {
    return offset[(slot / kLanes * moved() + i) * kLanes + slot % kLanes];
  }
  float* components_of(int block) const { return components.data() + block * shape.components() * kLanes; }
  void show();
  void show_block(int block);
  template <int kBlocks, class Dynamics>
  void show_blocks(const Dynamics& dynamics, int first);
  bool is_whole(int block) const;
  void show_events(int block);
  void show_shape(int block, LevelView from, float* points) const;
  void show_life(int block, std::size_t count, float* values) const;
  void see_round(int block, bool lines_too = true) const;
  void set_noise(float scale);
  void begin_call() {
    called = steps;
    if (std::exchange(handled, false)) std::fill(by_hand.begin(), by_hand.end(), std::uint8_t{0});
  }
  void set_ground(float height);  // for a chain
  void read_outputs(int slot, float* values) const;
  template <class Show>
  void polyline_of(int block, const Show& show,
                   const float* points = nullptr) const {  // show(2 · point + coordinate, [lane])
    for (int coordinate : {0, 1}) {
      polyline_lanes<LiveNumbers>(polyline, coordinate, points ? points : shown_of(block),
                                  [&](int point, const auto& values) {
                                    float lanes[kLanes];
                                    store(values, lanes);
                                    show(2 * point + coordinate, lanes);
                                  });
    }
  }

  const FramePath* path = frame_paths().front();
  int capacity;
  int inputs;
  std::uint64_t seed;
  RandomKeys keys;
  std::int64_t step_time;  // nanoseconds
  std::uint64_t model_hash;
  Channels channels;
  Stepper stepper;
  ShapeProgram shape;
  std::size_t visible;  // outputs that a host reads: control points, if the dynamics move shape components
  PolylineProgram polyline;
  ExtinctionProgram extinction;

  std::span<std::uint32_t> generation;  // per slot, like the next three
  std::span<std::uint8_t> alive;
  std::span<std::uint64_t> stream;
  std::span<std::uint64_t> born;  // value of `steps` at spawning or resetting
  std::span<float> regressors;    // [block][regressor][lane]: regressors of the next step
  std::span<float> shown;         // [block][output][lane]: outputs as a host reads them
  std::span<float> components;    // [block][component][lane]: the components behind `shown`, for a model with a shape

  std::span<float> round_points;  // [x, z][output][lane]: scratch, control points of a block seen from two sides
  std::span<float> round_lines;   // [x, z][2 · point + coordinate][lane]: scratch, their polylines

  // Per slot; empty for a model without extinction.
  std::span<float> wind;  // magnitude of the wind in the next step
  std::span<float> harm;
  std::span<float> lit;  // 1 or 0
  std::span<float> size;
  std::span<float> previous_size;   // size before the last step
  std::span<float> event;           // index of the next step's size in the extinction's sizes, or kNoEvent
  std::span<float> left;            // share of `offset` that is applied, 0 … 1
  std::span<float> previous_left;   // share before the last step
  std::span<float> offset;          // [block][moved][lane]: shown variables minus those of the event or the dynamics;
                                    // for an extinguished instance the shown variables themselves
  std::span<std::uint64_t> lit_at;  // value of `steps` at the last relighting, or kNeverInSteps
  std::span<std::uint64_t> out_at;  // value of `steps` at the last extinction, or kNeverInSteps
  std::span<std::uint8_t> by_hand;  // whether relight() or extinguish() acted since the last step() or advance()

  int living = 0;
  int rows = 0;         // one more than the highest slot in use
  int lowest_free = 0;  // no slot below this one is free
  std::uint64_t spawned = 0;
  std::uint64_t steps = 0;   // steps of the bank
  std::uint64_t called = 0;  // value of `steps` before the last call of step() or advance()
  float rest_area = 0;       // area of the outline at the operating point
  std::int64_t longest;      // longest time that advance() plays, nanoseconds
  std::int64_t passed = 0;   // nanoseconds since the last step
  LevelView view;            // view of a body
  bool handled = false;      // whether any element of `by_hand` is set
  bool between = false;      // whether `shown` is interpolated between the last two steps, by `passed`
  float noise = 0.0f;
  float ground = kNoGround;
  Crew crew;
  Clamped clamped;
  ChainFacet chain_facet{*this};
  ExtinctionFacet extinction_facet{*this};
  BodyFacet body_facet{*this};
};

}  // namespace wisp
