// Calls functions of the C interface in any order, with any handles and numbers: none crashes, and outputs are finite.

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "fuzz/kinds.hpp"
#include "fuzz/source.hpp"
#include "wisp/model/file.hpp"
#include "wisp/wisp.h"

namespace {

using wisp::fuzz::Source;

const std::vector<std::vector<std::byte>>& files() {
  static const auto all = [] {
    std::vector<std::vector<std::byte>> out;
    for (const wisp::Model& model : wisp::fuzz::kinds()) out.push_back(*wisp::model_bytes(model));
    return out;
  }();
  return all;
}

// Returns the model of an undamaged file. Loaded once, because checking a file takes most of an execution and
// model_fuzz tests it.
const wisp_model* undamaged(std::size_t kind) {
  static auto& all = *new std::vector<wisp_model*>(files().size(), nullptr);  // reachable at exit: no leak
  if (!all[kind]) wisp_model_load(files()[kind].data(), files()[kind].size(), &all[kind]);
  return all[kind];
}

// All handles that a host may hold; each may be NULL.
struct Host {
  wisp_model* own = nullptr;
  const wisp_model* model = nullptr;
  wisp_bank* bank = nullptr;
  wisp_wind* wind = nullptr;
  std::vector<std::uint8_t> kept;

  ~Host() {
    wisp_bank_free(bank);
    wisp_model_free(own);
    wisp_wind_free(wind);
  }
};

void load(Host& host, Source& source) {
  wisp_bank_free(host.bank);
  wisp_model_free(host.own);
  host.bank = nullptr;
  host.own = nullptr;
  const std::size_t kind = source.take<std::uint8_t>() % files().size();
  host.model = undamaged(kind);
  if (source.take<std::uint8_t>() % 8 == 0) {
    std::vector<std::byte> bytes = files()[kind];
    bytes[source.take<std::uint16_t>() % bytes.size()] ^= std::byte{1};
    wisp_model_load(bytes.data(), bytes.size(), &host.own);
    host.model = host.own;
  }
  wisp_bank_options options = wisp_bank_default_options();
  options.capacity = source.take<std::uint8_t>() % 20;
  options.polyline_points = source.take<std::uint8_t>();
  options.seed = source.take<std::uint64_t>();
  wisp_bank_create(host.model, &options, &host.bank);
}

void ask_model(const Host& host, Source& source) {
  const auto index = source.take<std::uint32_t>() % 40;
  wisp_model_facts facts{};
  facts.size = source.take<std::uint8_t>() % 2 ? sizeof facts : source.take<std::uint8_t>() % sizeof facts;
  wisp_model_get_facts(host.model, &facts);
  wisp_channel channel{};
  channel.size = sizeof channel;
  wisp_model_get_input(host.model, index, &channel);
  wisp_model_get_output(host.model, index, &channel);
  wisp_provenance provenance{};
  provenance.size = sizeof provenance;
  wisp_model_get_provenance(host.model, &provenance);
  const char* name = nullptr;
  wisp_model_get_source(host.model, index, &name);
  wisp_note note{};
  note.size = sizeof note;
  wisp_model_get_option(host.model, index, &note);
  wisp_figure figure{};
  figure.size = sizeof figure;
  wisp_model_get_figure(host.model, index, &figure);
  std::array<std::int32_t, 300> whole;
  std::array<double, 300> numbers;
  const std::size_t count = source.take<std::uint16_t>() % 300;
  wisp_model_arx_na(host.model, whole.data(), count);
  wisp_model_arx_nb(host.model, whole.data(), count);
  wisp_model_arx_nk(host.model, whole.data(), count);
  wisp_model_arx_noise(host.model, numbers.data(), count);
  wisp_model_chain_initial(host.model, numbers.data(), count);
  wisp_model_chain_transitions(host.model, numbers.data(), count);
  (void)wisp_model_name(host.model);
}

wisp_bank_facts facts_of(const wisp_bank* bank) {
  wisp_bank_facts facts{};
  facts.size = sizeof facts;
  wisp_bank_get_facts(bank, &facts);
  return facts;
}

void read(const Host& host, Source& source) {
  const wisp_bank_facts facts = facts_of(host.bank);
  const std::size_t one = facts.outputs, all = one * facts.slots;
  std::vector<float> values(all + one + 1), points(2 * facts.polyline_points * (facts.slots + 1) + 1);
  wisp_bank_outputs(host.bank, values.data(), all);
  for (std::size_t k = 0; k < all; ++k) {
    if (!std::isfinite(values[k])) std::abort();
  }
  const wisp_instance id = wisp_bank_at(host.bank, source.take<std::uint8_t>());
  wisp_bank_instance_outputs(host.bank, id, values.data(), source.take<std::uint8_t>() % 3 ? one : 0);
  wisp_bank_polylines(host.bank, points.data(), 2 * std::size_t{facts.polyline_points} * facts.slots);
  wisp_bank_polyline(host.bank, id, points.data(), 2 * std::size_t{facts.polyline_points});
  wisp_flame_state flame{};
  flame.size = sizeof flame;
  wisp_bank_get_flame_state(host.bank, id, &flame);
  wisp_bank_flame_sizes(host.bank, values.data(), facts.slots <= values.size() ? facts.slots : 0);
  wisp_chain_place place{};
  place.size = sizeof place;
  wisp_bank_get_chain_place(host.bank, id, &place);
}

void keep_or_restore(Host& host, Source& source) {
  if (source.take<std::uint8_t>() % 2 == 0) {
    std::size_t bytes = 0;
    if (wisp_bank_save_bytes(host.bank, &bytes) != WISP_OK) return;
    host.kept.resize(bytes);
    if (wisp_bank_save(host.bank, host.kept.data(), host.kept.size()) != WISP_OK) std::abort();
    return;
  }
  std::vector<std::uint8_t> bytes = host.kept;
  if (!bytes.empty() && source.take<std::uint8_t>() % 3 == 0) {
    bytes[source.take<std::uint16_t>() % bytes.size()] ^= source.take<std::uint8_t>();
  }
  wisp_bank_restore(host.bank, bytes.data(), bytes.size());
}

void drive(Host& host, Source& source) {
  const wisp_instance id = source.take<std::uint8_t>() % 4 ? wisp_bank_at(host.bank, source.take<std::uint8_t>() % 20)
                                                           : source.take<std::uint64_t>();
  const wisp_bank_facts facts = facts_of(host.bank);
  std::vector<float> inputs(std::size_t{facts.inputs} * (facts.slots + 1));
  for (float& input : inputs) input = source.take<float>();
  wisp_instance made = 0;
  switch (source.take<std::uint8_t>() % 16) {
    case 0:
      wisp_bank_spawn(host.bank, &made);
      break;
    case 1:
      wisp_bank_spawn_stream(host.bank, source.take<std::uint64_t>(), &made);
      break;
    case 2:
      wisp_bank_end(host.bank, id);
      break;
    case 3:
      wisp_bank_set_inputs(host.bank, inputs.data(), std::size_t{facts.inputs} * facts.slots);
      break;
    case 4:
      wisp_bank_set_common_inputs(host.bank, inputs.data(), facts.inputs);
      break;
    case 5:
      wisp_bank_set_instance_inputs(host.bank, id, inputs.data(), facts.inputs);
      break;
    case 6:
      wisp_bank_set_noise(host.bank, source.take<float>());
      break;
    case 7:
      wisp_bank_step(host.bank);
      break;
    case 8:
      wisp_bank_advance(host.bank, source.take<std::int64_t>(), nullptr);
      break;
    case 9:
      wisp_bank_relight(host.bank, id);
      wisp_bank_extinguish(host.bank, id);
      break;
    case 10: {
      wisp_body body{};
      body.size = sizeof body;
      for (auto* part : {&body.position, &body.velocity, &body.spin}) {
        for (float& x : *part) x = source.take<float>();
      }
      for (float& x : body.orientation) x = source.take<float>();
      wisp_bank_place(host.bank, id, &body);
      break;
    }
    case 11:
      wisp_bank_set_ground(host.bank, source.take<float>());
      break;
    case 12:
    case 13:
      wisp_bank_clear_ground(host.bank);
      break;
    case 14:
      wisp_bank_reset_instance(host.bank, id);
      break;
    default:
      wisp_bank_reset(host.bank);
  }
}

void listen(Host& host, Source& source) {
  if (!host.wind || source.take<std::uint8_t>() % 16 == 0) {
    wisp_wind_free(host.wind);
    host.wind = nullptr;
    wisp_wind_options options = wisp_wind_default_options();
    options.channels = source.take<std::uint8_t>() % 10;
    if (source.take<std::uint8_t>() % 4 == 0) options.rate_hz = source.take<double>();
    wisp_wind_create(&options, &host.wind);
  }
  std::array<float, 512> samples;
  for (float& sample : samples) sample = static_cast<float>(source.take<std::int8_t>()) / 100;
  samples[0] = source.take<float>();
  std::array<wisp_wind_frame, 4> frames;
  std::size_t taken = 0, made = 0;
  wisp_wind_feed(host.wind, samples.data(), source.take<std::uint16_t>() % 513, frames.data(), frames.size(), &taken,
                 &made);
  wisp_wind_calibrate(host.wind, source.take<std::uint8_t>() % 5, source.take<double>());
  wisp_wind_frame latest;
  wisp_wind_latest(host.wind, &latest);
  (void)wisp_wind_latency(host.wind);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Source source(data, size);
  Host host;
  for (int calls = 0; !source.empty() && calls < 100; ++calls) {
    switch (source.take<std::uint8_t>() % 16) {
      case 0:
        load(host, source);
        break;
      case 1:
        ask_model(host, source);
        break;
      case 2:
        keep_or_restore(host, source);
        break;
      case 3:
        listen(host, source);
        break;
      case 4:
        read(host, source);
        break;
      default:
        drive(host, source);
    }
  }
  read(host, source);
  return 0;
}
