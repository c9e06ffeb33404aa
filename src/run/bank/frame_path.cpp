// The work of a frame (frame_path.hpp). This file is compiled once for every vector width, each in its own namespace
// (#define wisp wisp_avx2): templates and inline functions with wide vectors must not be linked into code for a narrow
// machine. tests/house lists the symbols of the wide objects.

#include <algorithm>

#include "run/bank/bank_state.hpp"

#ifndef WISP_FRAME_PATH
#define WISP_FRAME_PATH wisp_frame_path
#endif
#ifndef WISP_WIDTH_NAME
#define WISP_WIDTH_NAME "baseline"
#endif

namespace wisp {
namespace {

// Returns a value in the first lane and 0 in the others. It stays in registers: a load would wait for the store.
Reals<LiveNumbers> alone(float value) {
  auto lanes = all<Reals<LiveNumbers>>(0.0f);
  first_part(value, lanes.part[0]);
  return lanes;
}

// Copies `count` rows of one number per lane. For few rows a call of memcpy takes longer than this loop.
inline void copy_lanes(const float* from, std::size_t count, float* to) {
  constexpr int kLanes = LiveNumbers::kLanes;
  if (!kAhead) {
    std::copy_n(from, count * kLanes, to);  // smaller code
    return;
  }
  for (std::size_t k = 0; k < count; ++k) store(load<Reals<LiveNumbers>>(from + k * kLanes), to + k * kLanes);
}

}  // namespace

template <class LanesOf>
void Bank::State::take_inputs(int block, const LanesOf& lanes_of) {
  float* out = regressors_of(block);
  Regressing<LiveNumbers, LanesOf> regressing(lanes_of);
  for (const RegressorChannel& channel : channels.regressors) {
    store(regressing(channel), out);
    out += kLanes;
  }
  if (!extinction.present) return;
  store(blowing<LiveNumbers>(extinction, lanes_of), wind.data() + block * kLanes);
}

// Sets a block's inputs from its rows of `all_rows`. Also writes lanes beyond the last slot; spawn() clears them.
void Bank::State::set_inputs(int block, const float* all_rows) {
  const float* values = all_rows + static_cast<std::size_t>(block) * kLanes * inputs;
  const int count = std::min(kLanes, rows - block * kLanes);
  const auto lanes_of = [&](int input) {
    if (inputs == 1 && count == kLanes)
      return load<Reals<LiveNumbers>>(values);  // memory and lanes have the same order
    if (kAhead && count == 1) return alone(values[input]);
    float lanes[kLanes] = {};
    for (int lane = 0; lane < count; ++lane) lanes[lane] = values[lane * inputs + input];
    return load<Reals<LiveNumbers>>(lanes);
  };
  take_inputs(block, lanes_of);
}

void Bank::State::set_common_inputs(int block, const float* values) {
  take_inputs(block, [&](int input) { return all<Reals<LiveNumbers>>(values[input]); });
}

Moment<LiveNumbers> Bank::State::moment(int block, std::uint32_t* flags, int ahead) const {
  const std::size_t first = static_cast<std::size_t>(block) * kLanes;
  return {&keys,
          {stream.data() + first, born.data() + first, steps + static_cast<std::uint64_t>(ahead)},
          flags,
          rows - block * kLanes};
}

// Makes all steps of a group of blocks, while the group's history is in the cache, before those of the next group.
std::uint64_t Bank::State::step_blocks(int first, int last, const Steps& made) {
  std::uint64_t count_of_clamped = 0;
  std::visit(
      [&]<class Dynamics>(Dynamics& dynamics) {
        constexpr int kGroup = Dynamics::kGroup;
        for (int block = first, group = 0; block < last; block += group) {
          if constexpr (requires { dynamics.fetch(block); }) {
            if (kGroup > 1 && dynamics.is_far()) {
              for (int b = block + kGroup; b < std::min(block + 2 * kGroup, last); ++b) dynamics.fetch(b);
            }
          }
          group = std::min(kGroup, last - block);
          if (group < kGroup && !Dynamics::kGroupsVary) group = 1;
          const auto step = [&](auto& one) {
            if constexpr (Dynamics::kGroupsVary) {
              count_of_clamped += step_group<kGroup>(one, block, made, group);
            } else {
              count_of_clamped +=
                  // NOLINTNEXTLINE(bugprone-branch-clone): one and the same only where a group is one block
                  group == kGroup ? step_group<kGroup>(one, block, made) : step_group<1>(one, block, made);
            }
          };
          if (!kAhead || made.count == 1) {
            step(dynamics);
          } else {
            auto&& one = dynamics.ahead();
            step(one);
          }
        }
      },
      stepper);
  return count_of_clamped;
}

template <int kBlocks, class Dynamics>
std::uint64_t Bank::State::step_group(Dynamics& dynamics, int first, const Steps& made, int blocks) {
  std::uint64_t count_of_clamped = 0;
  if constexpr (kAhead && kBlocks == 1 && Dynamics::kGroup > 1) {
    const bool lone = rows == 1 && visible == 1 && made.count > 1 && !extinction.present;
    if (lone && dynamics.steps_alone()) return step_alone(dynamics, made);
  }
  std::uint32_t flags[kBlocks * kLanes];
  const int count = kAhead ? made.count : 1, last = first + blocks;
  for (int step = 0; step < count; ++step) {
    if (step > 0) dynamics.turn();
    for (int block = first; block < last; ++block) {
      if (kAhead && made.inputs) set_inputs(block, made.inputs + static_cast<std::size_t>(step) * rows * inputs);
      copy_lanes(regressors_of(block), channels.regressors.size(), dynamics.regressors(block));
    }
    if constexpr (Dynamics::kGroupsVary) {
      dynamics.step(first, blocks, moment(first, flags, step));
    } else {
      dynamics.template step<kBlocks>(first, moment(first, flags, step));
    }
    for (int block = first; block < last; ++block) {
      if (extinction.present) live_block(block, dynamics.newest(block), steps + static_cast<std::uint64_t>(step) + 1);
      count_of_clamped += count_clamped(block, flags + (block - first) * kLanes);
    }
    const bool read = kAhead && made.outputs;
    if (read || (made.show && step + 1 == count)) {
      if constexpr (Dynamics::kGroupsVary) {
        for (int block = first; block < last; ++block) show_blocks<1>(dynamics, block);
      } else {
        show_blocks<kBlocks>(dynamics, first);
      }
    }
    for (int block = first; read && block < last; ++block) {
      read_block(block, made.outputs + static_cast<std::size_t>(step) * rows * visible);
    }
  }
  return count_of_clamped;
}

// Steps a bank of one instance with one output; its inputs and outputs are converted with one step per lane.
template <class Dynamics>
std::uint64_t Bank::State::step_alone(Dynamics& dynamics, const Steps& made) {
  const auto regressors_at = [&](int k, int first, int count, float* out) {
    const RegressorChannel& channel = channels.regressors[k];
    for (int step = 0; step < count; step += kLanes, out += kLanes) {
      float lanes[kLanes] = {};
      for (int lane = 0; lane < std::min(kLanes, count - step); ++lane) {
        lanes[lane] = made.inputs[static_cast<std::size_t>(first + step + lane) * inputs + channel.input];
      }
      store(regress<LiveNumbers>(channel, load<Reals<LiveNumbers>>(lanes)), out);
    }
  };
  const auto fill = [&](int k, int first, int count, float* out) {
    if (made.inputs) return regressors_at(k, first, count, out);
    std::fill_n(out, count, regressors[static_cast<std::size_t>(k) * kLanes]);
  };
  const Presentation<Reals<LiveNumbers>> presentation(channels.outputs[0]);
  const auto take = [&](int first, int count, const float* deviations) {
    if (!made.outputs) return;
    for (int step = 0; step < count; step += kLanes) {
      float lanes[kLanes];
      store(presentation.of(load<Reals<LiveNumbers>>(deviations + step)), lanes);
      std::copy_n(lanes, std::min(kLanes, count - step), made.outputs + first + step);
    }
  };
  const std::uint64_t count_of_clamped = dynamics.step_alone(moment(0, nullptr), made.count, fill, take);
  if (made.inputs) set_inputs(0, made.inputs + static_cast<std::size_t>(made.count - 1) * inputs);
  if (made.show) show_blocks<1>(dynamics, 0);
  return count_of_clamped;
}

// Returns the number of the block's living and lit instances with a clamped output.
std::uint32_t Bank::State::count_clamped(int block, const std::uint32_t* flags) const {
  if (!any(load<Words<LiveNumbers>>(flags))) return 0;
  std::uint32_t count = 0;
  const int first = block * kLanes;
  for (int lane = 0; lane < kLanes; ++lane) {
    count += (flags[lane] & 1) & alive[first + lane] & std::uint32_t{burns(first + lane)};
  }
  return count;
}

void Bank::State::live_block(int block, const float* newest, std::uint64_t moment) {
  float before[kLanes];
  const LifeLanes<float> life = life_of(block);
  std::copy_n(life.lit, kLanes, before);
  std::copy_n(size.data() + block * kLanes, kLanes, previous_size.data() + block * kLanes);
  live<LiveNumbers>(extinction, life);
  for (int lane = 0; lane < kLanes; ++lane) {
    const int slot = block * kLanes + lane;
    if (before[lane] != life.lit[lane]) go_out(slot, newest, moment);
    if (event[slot] != kNoEvent) play_event(slot, newest);
  }
}

void Bank::State::begin_event(int slot, std::span<const std::uint32_t> events, std::uint64_t at) {
  constexpr std::uint32_t kGroup = 0xffff;  // group of random words beyond those of the dynamics
  Words<LiveNumbers> counters[4], words[4];
  random_counters<LiveNumbers>(moment(slot / kLanes, nullptr, static_cast<int>(at - steps)).counters, counters);
  random_group<LiveNumbers>(keys, counters, kGroup, words);
  std::uint32_t drawn[kLanes];
  store(words[0], drawn);
  event[slot] = static_cast<float>(events[drawn[slot % kLanes] % events.size()]);
}

// Returns a component of a recorded shape; z components of a body were not recorded and are 0.
float Bank::State::recorded_component(std::size_t row, std::size_t component) const {
  const std::size_t plane = shape.symmetric + shape.antisymmetric;
  if (component >= plane) return 0.0f;
  return std::clamp(extinction.shapes[row * plane + component], channels.outputs[component].lowest,
                    channels.outputs[component].highest);
}

// Returns a component of the displayed shape, interpolated between the last two steps: the component of the event's row
// or of the dynamics, plus the applied share of the offset. An extinguished instance keeps its last shape.
float Bank::State::shape_in_event(int slot, std::size_t component, float dynamics, float share) const {
  const float beside = offset_of(slot, component);
  if (lit[slot] == 0.0f) return beside;
  const OutputChannel& channel = channels.outputs[component];
  const float rest = nearer(previous_left[slot], left[slot], share);
  auto row = static_cast<std::size_t>(std::max(event[slot], 1.0f)) - 1;
  if (extinction.sizes[row] == kEventEnds) ++row;  // no step of the event has been played
  const bool recorded = !(extinction.sizes[row] < 0.0f) && !extinction.shapes.empty();
  const float now = recorded ? recorded_component(row, component) : dynamics;
  if (rest > 0.0f) return std::clamp(now + rest * beside, channel.lowest, channel.highest);
  if (!recorded) return now;
  return extinction.sizes[row - 1] < 0.0f ? now : nearer(recorded_component(row - 1, component), now, share);
}

// Returns a variable of the dynamics, in its own unit.
float Bank::State::newest_of(int slot, std::size_t i, const float* newest) const {
  float lanes[kLanes];
  const auto deviation = load<Reals<LiveNumbers>>(newest + i * kLanes);
  store(Presentation<Reals<LiveNumbers>>(channels.outputs[i]).of(deviation), lanes);
  return lanes[slot % kLanes];
}

// Makes one step of an event. After the event's rows, or in wind, a re-ignition crosses over to the dynamics. In an
// extinction the size never grows.
void Bank::State::play_event(int slot, const float* newest) {
  const bool burning = lit[slot] != 0.0f;
  const auto at = [&](float row) { return extinction.sizes[static_cast<std::size_t>(row)]; };
  const float last = event[slot] - 1.0f;
  float next = event[slot];
  while (burning && wind[slot] > extinction.stirs && !(at(next) < 0.0f)) next += 1.0f;
  const float recorded = at(next);
  const bool leaves = recorded < 0.0f, shaped = burning && !extinction.shapes.empty();
  const bool begins = shaped && leaves && (!(at(last) < 0.0f) || at(last) == kEventEnds);  // the cross-over begins
  for (std::size_t i = 0; i < moved() && begins; ++i) {
    const float made = newest_of(slot, i, newest);
    offset_of(slot, i) = shape_in_event(slot, i, made, 1.0f) - made;
  }
  previous_left[slot] = begins ? 1.0f : left[slot];
  left[slot] = shaped && leaves ? 1.0f + recorded : std::max(left[slot] - extinction.join, 0.0f);
  size[slot] = burning ? nearer(size[slot], leaves ? 1.0f : recorded, leaves ? -recorded : 1.0f - left[slot])
                       : std::min(size[slot], leaves ? 0.0f : recorded);
  event[slot] = recorded == kEventEnds ? kNoEvent : next + 1.0f;
}

// Extinguishes an instance and stores its shape, to be drawn shrinking: the dynamics have not learned such strong wind.
void Bank::State::go_out(int slot, const float* newest, std::uint64_t moment) {
  out_at[slot] = moment;
  lit[slot] = 1.0f;  // shape_in_event() then computes the shape of the burning flame
  for (std::size_t i = 0; i < moved(); ++i) {
    const float made = newest_of(slot, i, newest);
    offset_of(slot, i) = event[slot] == kNoEvent ? made : shape_in_event(slot, i, made, 1.0f);
  }
  lit[slot] = 0.0f;
  begin_event(slot, extinction.dying, moment);
}

void Bank::State::read_block(int block, float* rows_of_all) const {
  const std::size_t count = visible;
  if (kAhead && count >= 4 && lives_whole(block)) return read_whole_block(block, rows_of_all);
  for (int slot = block * kLanes; slot < std::min((block + 1) * kLanes, rows); ++slot) {
    float* row = rows_of_all + static_cast<std::size_t>(slot) * count;
    if (alive[slot]) {
      read_outputs(slot, row);
    } else {
      std::fill_n(row, count, 0.0f);
    }
  }
}

bool Bank::State::lives_whole(int block) const {
  const auto* lane = alive.data() + block * kLanes;
  return (block + 1) * kLanes <= rows && std::all_of(lane, lane + kLanes, [](std::uint8_t one) { return one != 0; });
}

// Reads four outputs of all lanes at once. If `visible` is no multiple of four, the last four outputs overlap others.
void Bank::State::read_whole_block(int block, float* rows_of_all) const {
  using Values = Reals<LiveNumbers>;
  const std::size_t count = visible;
  const float* values = shown_of(block);
  float* row[kLanes];
  unrolled<kLanes>(
      [&](auto lane) { row[lane] = rows_of_all + static_cast<std::size_t>(block * kLanes + lane) * count; });
  for (std::size_t next = 0; next < count; next += 4) {
    const std::size_t first = std::min(next, count - 4);
    const float* from = values + first * kLanes;
    rows_of<LiveNumbers>({load<Values>(from), load<Values>(from + kLanes), load<Values>(from + 2 * kLanes),
                          load<Values>(from + 3 * kLanes)},
                         first, row);
  }
}

void Bank::State::read_outputs(int slot, float* values) const {
  const float* row = shown_of(slot / kLanes) + slot % kLanes;
  for (std::size_t i = 0; i < visible; ++i) values[i] = row[i * kLanes];
}

void Bank::State::show_block(int block) {
  std::visit([&](const auto& dynamics) { show_blocks<1>(dynamics, block); }, stepper);
}

template <int kBlocks, class Dynamics>
void Bank::State::show_blocks(const Dynamics& dynamics, int first) {
  const float share = static_cast<float>(passed) / static_cast<float>(step_time);
  float* out = shape.empty() ? shown_of(first) : components_of(first);
  if (between) {
    dynamics.template show_between<kBlocks>(first, share, out);
  } else {
    dynamics.template show<kBlocks>(first, out);
  }
  for (int block = first; extinction.present && block < first + kBlocks; ++block) show_events(block);
  for (int block = first; !shape.empty() && block < first + kBlocks; ++block) show_shape(block, view, shown_of(block));
  if (!extinction.present) return;
  for (int block = first; block < first + kBlocks; ++block) show_life(block, visible, shown_of(block));
}

// Computes the control points of a block's shapes, [output][lane], from their displayed components.
void Bank::State::show_shape(int block, LevelView from, float* points) const {
  shape_lanes<LiveNumbers>(
      shape, components_of(block), [&](std::size_t i, const auto& values) { store(values, points + i * kLanes); },
      from);
}

// Replaces displayed variables of the dynamics by shape_in_event() for instances in an event and extinguished ones.
void Bank::State::show_events(int block) {
  if (is_whole(block)) return;
  float* out = shape.empty() ? shown_of(block) : components_of(block);
  const float share = between ? static_cast<float>(passed) / static_cast<float>(step_time) : 1.0f;
  for (int lane = 0; lane < kLanes; ++lane) {
    const int slot = block * kLanes + lane;
    if (lit[slot] != 0.0f && event[slot] == kNoEvent) continue;
    for (std::size_t k = 0; k < moved(); ++k)
      out[k * kLanes + lane] = shape_in_event(slot, k, out[k * kLanes + lane], share);
  }
}

// Returns whether every instance of a block is shown by the dynamics alone, at full size: its outputs need no change.
bool Bank::State::is_whole(int block) const {
  bool whole = true;
  for (int lane = 0; lane < kLanes; ++lane) whole &= event[block * kLanes + lane] == kNoEvent;
  for (const auto& values : {lit, size, previous_size}) {
    for (int lane = 0; lane < kLanes; ++lane) whole &= values[block * kLanes + lane] == 1.0f;
  }
  return whole;
}

// Scales `count` numbers of a block, [number][lane], by the sizes of its instances.
void Bank::State::show_life(int block, std::size_t count, float* values) const {
  if (is_whole(block)) return;
  const float share = static_cast<float>(passed) / static_cast<float>(step_time);
  auto seen = load<Reals<LiveNumbers>>(size.data() + block * kLanes);
  if (between) {
    seen = size_between<LiveNumbers>(load<Reals<LiveNumbers>>(previous_size.data() + block * kLanes), seen, share);
  }
  shrink<LiveNumbers>(seen, count, values);
}

namespace {

template <auto kSet>
void set_blocks(void* state, const float* values) {
  auto& s = *static_cast<Bank::State*>(state);
  for (int block = 0; block < s.blocks(); ++block) (s.*kSet)(block, values);
}

void show(void* state, int first, int last) {
  for (int block = first; block < last; ++block) static_cast<Bank::State*>(state)->show_block(block);
}

void polylines(const Bank::State& s, float* values) {
  const std::size_t row = static_cast<std::size_t>(s.polyline.points) * 2;
  for (int block = 0; block < s.blocks(); ++block) {
    const int first = block * s.kLanes, lanes = std::min(s.kLanes, s.rows - first);
    float* out = values + first * row;
    s.polyline_of(block, [&](int number, const float* lane_values) {
      for (int lane = 0; lane < lanes; ++lane) out[lane * row + number] = lane_values[lane];
    });
    for (int lane = 0; lane < lanes; ++lane) {
      if (!s.alive[first + lane]) std::fill_n(out + lane * row, row, 0.0f);
    }
  }
}

}  // namespace
}  // namespace wisp

extern "C" WISP_INSIDE const wisp::FramePath WISP_FRAME_PATH = {
    WISP_WIDTH_NAME,
    wisp::set_blocks<&wisp::Bank::State::set_inputs>,
    wisp::set_blocks<&wisp::Bank::State::set_common_inputs>,
    [](void* s, int first, int last, const void* made) {
      return static_cast<wisp::Bank::State*>(s)->step_blocks(first, last, *static_cast<const wisp::Steps*>(made));
    },
    wisp::show,
    [](const void* s, float* values) { wisp::polylines(*static_cast<const wisp::Bank::State*>(s), values); }};
