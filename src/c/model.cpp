// C interface of models: reading from bytes, channels, dynamics, and the record of a model's making.

#include <type_traits>
#include <utility>

#include "c/boundary.hpp"
#include "wisp/model/file.hpp"

namespace {

using namespace wisp::c;

template <class Channels>
wisp_status hand_out_channel(const char* function, const Channels& channels, std::uint32_t index, wisp_channel* out) {
  if (!size_is_right(function, out->size) || !index_is_right(function, index, channels.size())) {
    return WISP_BAD_ARGUMENT;
  }
  const auto& channel = channels[index];
  wisp_channel filled{};
  filled.name = channel.name.c_str();
  filled.unit = channel.unit.c_str();
  filled.lowest = channel.lowest;
  filled.highest = channel.highest;
  if constexpr (requires { channel.shape; }) {
    filled.even_odd = wisp::has_powers(channel.shape) ? 1 : 0;
  }
  return hand_out(filled, out);
}

void describe(const wisp::PlainView&, wisp_model_facts& facts) { facts.view = WISP_VIEW_PLAIN; }

void describe(const wisp::OutlineView& outline, wisp_model_facts& facts) {
  facts.view = WISP_VIEW_OUTLINE;
  facts.control_points = facts.outputs / 2;
  facts.metres_per_unit = outline.metres_per_unit;
}

void describe(const wisp::PoseView& pose, wisp_model_facts& facts) {
  facts.view = WISP_VIEW_POSE;
  facts.half_width = pose.half_width;
  facts.half_length = pose.half_length;
}

void describe(const wisp::PositionView& position, wisp_model_facts& facts) {
  facts.view = WISP_VIEW_POSITION;
  facts.half_width = position.half_width;
}

void describe(const wisp::Extinction& rule, wisp_model_facts& facts) {
  facts.blow_out_level = rule.level;
  facts.blow_out_seconds = rule.seconds;
  facts.blow_out_haste = rule.haste;
  facts.blow_out_recovery_seconds = rule.recovery;
  facts.blow_out_input = static_cast<std::uint32_t>(rule.input);
}

std::uint32_t kind_of(const wisp::ArxModel&) { return WISP_DYNAMICS_ARX; }
std::uint32_t kind_of(const wisp::ChainModel&) { return WISP_DYNAMICS_CHAIN; }
std::uint32_t kind_of(const wisp::SwitchedArxModel&) { return WISP_DYNAMICS_SWITCHED; }

// Calls use(dynamics) if the model's dynamics are a `Kind`, and returns the call's status; else fails.
template <class Kind, class Use>
wisp_status on_dynamics(const char* function, const wisp_model* model, Use use) {
  if (!model) return null_argument(function);
  if (const auto* dynamics = std::get_if<Kind>(&model->model.dynamics)) return use(*dynamics);
  const bool arx = std::is_same_v<Kind, wisp::ArxModel>;
  return fail(WISP_BAD_ARGUMENT, "%s: the model's dynamics are not %s", function, arx ? "ARX" : "a chain");
}

// Fills an array with the values that take(dynamics) returns.
template <class Kind, class Take, class Value>
wisp_status hand_out_of(const char* function, const wisp_model* model, Value* values, std::size_t count, Take take) {
  return on_dynamics<Kind>(function, model, [&](const Kind& dynamics) {
    return guarded(function, [&] { return hand_out_values(function, take(dynamics), values, count); });
  });
}

}  // namespace

extern "C" {

wisp_status wisp_model_load(const void* bytes, size_t size, wisp_model** model) {
  if (!bytes || !model) return null_argument(__func__);
  return guarded(__func__, [&]() -> wisp_status {
    auto parsed = wisp::parse_model({static_cast<const std::byte*>(bytes), size}, "the model");
    if (!parsed) return fail(WISP_BAD_DATA, parsed.error());
    *model = new wisp_model{std::move(parsed).value()};
    return WISP_OK;
  });
}

void wisp_model_free(wisp_model* model) { delete model; }

wisp_status wisp_model_in_the_round(const wisp_model* model, wisp_model** round) {
  if (!model || !round) return null_argument(__func__);
  return guarded(__func__, [&]() -> wisp_status {
    auto made = wisp::in_the_round(model->model);
    if (!made) return fail(WISP_BAD_ARGUMENT, made.error());
    *round = new wisp_model{std::move(made).value()};
    return WISP_OK;
  });
}

wisp_status wisp_model_get_facts(const wisp_model* model, wisp_model_facts* facts) {
  if (!struct_is_right(__func__, model, facts)) return WISP_BAD_ARGUMENT;
  wisp_model_facts filled{};
  filled.inputs = static_cast<uint32_t>(model->model.inputs.size());
  filled.outputs = static_cast<uint32_t>(model->model.outputs.size());
  filled.usable = model->model.training.usable.verdict ? 1 : 0;
  filled.rate_hz = model->model.rate_hz;
  filled.step_nanoseconds = wisp::step_time(model->model).count();
  filled.multiply_adds_per_frame = model->model.training.multiply_adds_per_frame;
  filled.operations_per_frame = model->model.training.operations_per_frame;
  filled.dynamics = std::visit([](const auto& dynamics) { return kind_of(dynamics); }, model->model.dynamics);
  std::visit([&](const auto& view) { describe(view, filled); }, model->model.view);
  if (model->model.extinction) describe(*model->model.extinction, filled);
  return hand_out(filled, facts);
}

wisp_status wisp_model_get_input(const wisp_model* model, uint32_t index, wisp_channel* channel) {
  if (!model || !channel) return null_argument(__func__);
  return hand_out_channel(__func__, model->model.inputs, index, channel);
}

wisp_status wisp_model_get_output(const wisp_model* model, uint32_t index, wisp_channel* channel) {
  if (!model || !channel) return null_argument(__func__);
  return hand_out_channel(__func__, model->model.outputs, index, channel);
}

const char* wisp_model_name(const wisp_model* model) { return model ? model->model.name.c_str() : ""; }

wisp_status wisp_model_get_provenance(const wisp_model* model, wisp_provenance* provenance) {
  if (!struct_is_right(__func__, model, provenance)) return WISP_BAD_ARGUMENT;
  const wisp::Training& made = model->model.training;
  return hand_out(wisp_provenance{.sources = static_cast<uint32_t>(made.sources.size()),
                                  .options = static_cast<uint32_t>(made.recipe.size()),
                                  .figures = static_cast<uint32_t>(made.figures.size()),
                                  .usable = made.usable.verdict ? 1U : 0U,
                                  .program = made.program.c_str(),
                                  .reason = made.usable.reason.c_str()},
                  provenance);
}

wisp_status wisp_model_get_source(const wisp_model* model, uint32_t index, const char** name) {
  if (!model || !name) return null_argument(__func__);
  const auto& sources = model->model.training.sources;
  if (!index_is_right(__func__, index, sources.size())) return WISP_BAD_ARGUMENT;
  *name = sources[index].c_str();
  return WISP_OK;
}

wisp_status wisp_model_get_option(const wisp_model* model, uint32_t index, wisp_note* option) {
  if (!model || !option) return null_argument(__func__);
  const auto& options = model->model.training.recipe;
  if (!size_is_right(__func__, option->size)) return WISP_BAD_ARGUMENT;
  if (!index_is_right(__func__, index, options.size())) return WISP_BAD_ARGUMENT;
  return hand_out(wisp_note{.name = options[index].name.c_str(), .value = options[index].value.c_str()}, option);
}

wisp_status wisp_model_get_figure(const wisp_model* model, uint32_t index, wisp_figure* figure) {
  if (!model || !figure) return null_argument(__func__);
  const auto& figures = model->model.training.figures;
  if (!size_is_right(__func__, figure->size)) return WISP_BAD_ARGUMENT;
  if (!index_is_right(__func__, index, figures.size())) return WISP_BAD_ARGUMENT;
  return hand_out(wisp_figure{.name = figures[index].name.c_str(), .value = figures[index].value}, figure);
}

wisp_status wisp_model_get_arx(const wisp_model* model, wisp_arx_facts* facts) {
  if (!struct_is_right(__func__, model, facts)) return WISP_BAD_ARGUMENT;
  return on_dynamics<wisp::ArxModel>(__func__, model, [&](const wisp::ArxModel& arx) {
    return hand_out(wisp_arx_facts{.outputs = static_cast<uint32_t>(arx.orders.outputs()),
                                   .regressors = static_cast<uint32_t>(arx.orders.inputs()),
                                   .history = static_cast<uint32_t>(arx.orders.history()),
                                   .resamples = arx.noise.resampled.empty() ? 0U : 1U},
                    facts);
  });
}

wisp_status wisp_model_arx_na(const wisp_model* model, int32_t* values, size_t count) {
  return hand_out_of<wisp::ArxModel>(__func__, model, values, count, [](auto& arx) { return arx.orders.na.values(); });
}

wisp_status wisp_model_arx_nb(const wisp_model* model, int32_t* values, size_t count) {
  return hand_out_of<wisp::ArxModel>(__func__, model, values, count, [](auto& arx) { return arx.orders.nb.values(); });
}

wisp_status wisp_model_arx_nk(const wisp_model* model, int32_t* values, size_t count) {
  return hand_out_of<wisp::ArxModel>(__func__, model, values, count, [](auto& arx) { return arx.orders.nk.values(); });
}

wisp_status wisp_model_arx_noise(const wisp_model* model, double* values, size_t count) {
  return hand_out_of<wisp::ArxModel>(__func__, model, values, count, [](auto& arx) { return arx.noise.sd; });
}

wisp_status wisp_model_get_chain(const wisp_model* model, wisp_chain_facts* facts) {
  if (!struct_is_right(__func__, model, facts)) return WISP_BAD_ARGUMENT;
  return on_dynamics<wisp::ChainModel>(__func__, model, [&](const wisp::ChainModel& chain) {
    return hand_out(wisp_chain_facts{.modes = static_cast<uint32_t>(chain.modes),
                                     .segments = static_cast<uint32_t>(chain.segments.size()),
                                     .history = static_cast<uint32_t>(chain.history),
                                     .gust_order = chain.gust ? 1U : 0U,
                                     .heading_free = chain.heading_free ? 1U : 0U},
                    facts);
  });
}

wisp_status wisp_model_chain_initial(const wisp_model* model, double* values, size_t count) {
  return hand_out_of<wisp::ChainModel>(__func__, model, values, count, [](auto& chain) { return chain.initial; });
}

wisp_status wisp_model_chain_transitions(const wisp_model* model, double* values, size_t count) {
  return hand_out_of<wisp::ChainModel>(__func__, model, values, count, [](auto& chain) { return chain.transitions(); });
}

wisp_status wisp_model_chain_segments(const wisp_model* model, uint32_t* modes, uint32_t* steps, size_t count) {
  const char* const call = __func__;  // within a lambda __func__ is operator()
  return on_dynamics<wisp::ChainModel>(call, model, [&](const wisp::ChainModel& chain) {
    if (!buffer_is_right(call, &chain, count, chain.segments.size())) return wisp_status{WISP_BAD_ARGUMENT};
    if (modes) hand_out_values(call, chain.segments.mode, modes, count);
    if (steps) hand_out_values(call, chain.segments.steps, steps, count);
    return wisp_status{WISP_OK};
  });
}
}
