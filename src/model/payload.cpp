#include "model/payload.hpp"

#include <algorithm>
#include <cstdint>
#include <string>

namespace wisp {
namespace {

namespace fb = wisp_flatbuffers;

constexpr int kMaxStoredChannels = 4096;  // as in check(); the sum of a row's 16-bit orders then fits in an int

std::vector<std::uint16_t> flat(const OrderMatrix& matrix) { return {matrix.values().begin(), matrix.values().end()}; }

template <class Row>
std::vector<double> joined(const std::vector<Row>& rows) {
  std::vector<double> all;
  for (const Row& row : rows) all.insert(all.end(), row.begin(), row.end());
  return all;
}

using Builder = fb::FlatBufferBuilder;

// Writes a vector; an empty one is left out of the file.
fb::Offset<fb::Vector<double>> optional_vector(Builder& builder, const std::vector<double>& values) {
  return values.empty() ? 0 : builder.CreateVector(values);
}

fb::Offset<file::ResampledResiduals> write_resampled(Builder& builder, const ResampledResiduals& resampled) {
  if (resampled.empty()) return 0;
  const auto scale = builder.CreateVector(resampled.scale);
  const auto rows = builder.CreateVector(resampled.rows);
  const auto ends = builder.CreateVector(resampled.ends);
  const auto winds = resampled.winds.empty() ? 0 : builder.CreateVector(resampled.winds);
  const std::vector<std::int16_t> sources(resampled.mirror.begin(), resampled.mirror.end());
  const auto mirror = sources.empty() ? 0 : builder.CreateVector(sources);
  const std::vector<std::uint16_t> past(resampled.lags.begin(), resampled.lags.end());
  const auto lags = past.empty() ? 0 : builder.CreateVector(past);
  return file::CreateResampledResiduals(builder, scale, rows, ends, resampled.wind_scale, winds,
                                        static_cast<std::int16_t>(resampled.toward), lags, resampled.tolerance,
                                        resampled.margin, static_cast<std::uint32_t>(resampled.longest), mirror,
                                        static_cast<std::uint16_t>(resampled.across));
}

fb::Offset<file::Arx> write_arx(Builder& builder, const ArxModel& arx) {
  const auto na = builder.CreateVector(flat(arx.orders.na));
  const auto nb = builder.CreateVector(flat(arx.orders.nb));
  const auto nk = builder.CreateVector(flat(arx.orders.nk));
  const auto theta = builder.CreateVector(joined(arx.theta));
  const auto std_error = optional_vector(builder, joined(arx.std_error));
  const auto constant = builder.CreateVector(arx.constant);
  const auto output_mean = builder.CreateVector(arx.output_mean);
  const auto input_mean = builder.CreateVector(arx.input_mean);
  const auto sd = builder.CreateVector(arx.noise.sd);
  const auto ci = optional_vector(builder, joined(arx.noise.sd_ci95));
  const auto resampled = write_resampled(builder, arx.noise.resampled);
  return file::CreateArx(builder, na, nb, nk, theta, std_error, constant, output_mean, input_mean, sd, ci, resampled);
}

fb::Offset<file::ArxMode> write_mode(Builder& builder, const ArxMode& mode) {
  const auto theta = joined(mode.theta), std_error = joined(mode.std_error);
  return file::CreateArxModeDirect(builder, &theta, std_error.empty() ? nullptr : &std_error, &mode.constant,
                                   &mode.shock);
}

fb::Offset<file::SwitchedArx> write_switched(Builder& builder, const SwitchedArxModel& model) {
  std::vector<fb::Offset<file::ArxMode>> modes;
  for (const ArxMode& mode : model.modes) modes.push_back(write_mode(builder, mode));
  const auto na = flat(model.orders.na), nb = flat(model.orders.nb), nk = flat(model.orders.nk);
  return file::CreateSwitchedArxDirect(builder, &na, &nb, &nk, &model.output_mean, &model.input_mean, &modes,
                                       &model.initial, &model.transitions,
                                       model.shock_quantiles.empty() ? nullptr : &model.shock_quantiles);
}

fb::Offset<file::ExtinctionTraining> write_extinction_training(Builder& builder,
                                                               const std::optional<ExtinctionTraining>& made) {
  if (!made) return 0;
  return file::CreateExtinctionTraining(builder, static_cast<file::Origin>(made->origin), made->deaths, made->died,
                                        made->gusts, made->spared, made->vanishing_seconds);
}

fb::Offset<file::MotionTraining> write_motion(Builder& builder, const std::optional<MotionTraining>& motion) {
  if (!motion) return 0;
  return file::CreateMotionTrainingDirect(builder, motion->event.c_str(), motion->min_seconds, motion->debounce,
                                          static_cast<std::uint32_t>(motion->smooth_rows));
}

file::Underside write_underside(std::optional<bool> underside) {
  if (!underside) return file::Underside::Unknown;
  return *underside ? file::Underside::Yes : file::Underside::No;
}

fb::Offset<file::Preparation> write_preparation(Builder& builder, const Preparation& made) {
  if (made == Preparation{}) return 0;
  return file::CreatePreparation(builder, made.detrend, made.highpass_hz, made.lowpass_hz, made.resample_hz);
}

fb::Offset<file::Training> write_training(Builder& builder, const Training& made) {
  std::vector<fb::Offset<file::Note>> recipe;
  for (const Note& note : made.recipe)
    recipe.push_back(file::CreateNoteDirect(builder, note.name.c_str(), note.value.c_str()));
  std::vector<fb::Offset<file::Figure>> figures;
  for (const Figure& figure : made.figures)
    figures.push_back(file::CreateFigureDirect(builder, figure.name.c_str(), figure.value));
  std::vector<fb::Offset<file::InputTraining>> inputs;
  for (const InputTraining& input : made.inputs)
    inputs.push_back(file::CreateInputTraining(builder, input.scale, input.one_rms));
  const auto program = builder.CreateString(made.program);
  const auto sources = builder.CreateVectorOfStrings(made.sources);
  const auto recipe_at = builder.CreateVector(recipe);
  const auto figures_at = builder.CreateVector(figures);
  const auto reason = builder.CreateString(made.usable.reason);
  const auto inputs_at = builder.CreateVector(inputs);
  const auto residual_sd = optional_vector(builder, made.residual_sd);
  const auto motion = write_motion(builder, made.motion);
  const auto extinction = write_extinction_training(builder, made.extinction);
  const auto preparation = write_preparation(builder, made.preparation);
  return file::CreateTraining(builder, program, sources, recipe_at, figures_at, made.usable.verdict, reason, inputs_at,
                              residual_sd, write_underside(made.underside), motion, extinction,
                              made.multiply_adds_per_frame, made.operations_per_frame, preparation, made.own_levels);
}

fb::Offset<file::FlameEvents> write_events(Builder& builder, const FlameEvents& events) {
  if (events.empty()) return 0;
  return file::CreateFlameEventsDirect(builder, &events.sizes, &events.ends,
                                       events.scale.empty() ? nullptr : &events.scale,
                                       events.scale.empty() ? nullptr : &events.shapes);
}

fb::Offset<file::Extinction> write_extinction(Builder& builder, const std::optional<Extinction>& rule) {
  if (!rule) return 0;
  const auto dying = write_events(builder, rule->dying), catching = write_events(builder, rule->catching);
  return file::CreateExtinction(builder, static_cast<std::uint32_t>(rule->input), rule->level, rule->seconds,
                                rule->haste, rule->recovery, dying, catching);
}

std::string text(const fb::String* string) { return string ? string->str() : std::string(); }

Error wrong_size(const std::string& what, std::size_t found, std::uint64_t expected) {
  return {"is damaged: " + what + " holds " + std::to_string(found) + " values, expected " + std::to_string(expected)};
}

Result<OrderMatrix> read_orders(const fb::Vector<std::uint16_t>& values, int rows, int columns, const char* name) {
  if (values.size() != static_cast<std::size_t>(rows) * columns) {
    return wrong_size(name, values.size(), static_cast<std::size_t>(rows) * columns);
  }
  OrderMatrix matrix(rows, columns);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) matrix(i, j) = values[static_cast<fb::uoffset_t>(i * columns + j)];
  }
  return matrix;
}

Result<std::vector<std::vector<double>>> read_rows(const fb::Vector<double>& stored, const ArxOrders& orders,
                                                   const std::string& name) {
  const std::vector<double> values = copied(&stored);
  std::uint64_t expected = 0;  // may exceed 32 bits
  for (int i = 0; i < orders.outputs(); ++i) expected += static_cast<std::uint64_t>(orders.row_size(i));
  if (values.size() != expected) return wrong_size(name, values.size(), expected);
  std::vector<std::vector<double>> rows;
  auto next = values.begin();
  for (int i = 0; i < orders.outputs(); ++i) {
    rows.emplace_back(next, next + orders.row_size(i));
    next += orders.row_size(i);
  }
  return rows;
}

ResampledResiduals read_resampled(const file::ResampledResiduals& stored) {
  constexpr std::uint32_t kLargest = 1U << 30;  // fits in an int, and check() rejects it
  ResampledResiduals resampled;
  resampled.scale = copied(stored.scale());
  resampled.rows = copied(stored.rows());
  resampled.ends = copied(stored.ends());
  resampled.wind_scale = stored.wind_scale();
  resampled.winds = copied(stored.winds());
  resampled.toward = stored.toward();
  for (std::uint16_t lag : copied(stored.lags())) resampled.lags.push_back(lag);
  resampled.tolerance = stored.tolerance();
  resampled.margin = stored.margin();
  resampled.longest = static_cast<int>(std::min(stored.longest(), kLargest));
  for (std::int16_t from : copied(stored.mirror())) resampled.mirror.push_back(from);
  resampled.across = stored.across();
  return resampled;
}

Result<void> read_noise(const file::Arx& stored, ResidualNoise& noise) {
  noise.sd = copied(stored.noise_sd());
  if (stored.noise_resampled()) noise.resampled = read_resampled(*stored.noise_resampled());
  const std::vector<double> ci = copied(stored.noise_sd_ci95());
  if (!ci.empty() && ci.size() != 2 * noise.sd.size())
    return wrong_size("noise_sd_ci95", ci.size(), 2 * noise.sd.size());
  for (std::size_t k = 0; k + 1 < ci.size(); k += 2) noise.sd_ci95.push_back({ci[k], ci[k + 1]});
  return {};
}

template <class Stored>
Result<ArxOrders> read_all_orders(const Stored& stored, int ny, int nu) {
  auto na = read_orders(*stored.na(), ny, ny, "na");
  if (!na) return na.error();
  auto nb = read_orders(*stored.nb(), ny, nu, "nb");
  if (!nb) return nb.error();
  auto nk = read_orders(*stored.nk(), ny, nu, "nk");
  if (!nk) return nk.error();
  return ArxOrders{std::move(*na), std::move(*nb), std::move(*nk)};
}

// Reads the coefficients of an ARX model or of one mode, and their standard errors if there are any.
template <class Stored, class Arx>
Result<void> read_coefficients(const Stored& stored, const ArxOrders& orders, const std::string& of, Arx& arx) {
  auto theta = read_rows(*stored.theta(), orders, of + "theta");
  if (!theta) return theta.error();
  arx.theta = std::move(*theta);
  if (!stored.std_error()) return {};
  auto std_error = read_rows(*stored.std_error(), orders, of + "std_error");
  if (!std_error) return std_error.error();
  arx.std_error = std::move(*std_error);
  return {};
}

Result<ArxModel> read_arx(const file::Arx& stored, int ny, int nu) {
  ArxModel arx;
  auto orders = read_all_orders(stored, ny, nu);
  if (!orders) return orders.error();
  arx.orders = std::move(*orders);
  if (auto ok = read_coefficients(stored, arx.orders, "", arx); !ok) return ok.error();
  arx.constant = copied(stored.constant());
  arx.output_mean = copied(stored.output_mean());
  arx.input_mean = copied(stored.input_mean());
  if (auto ok = read_noise(stored, arx.noise); !ok) return ok.error();
  return arx;
}

Result<ArxMode> read_mode(const file::ArxMode& stored, const ArxOrders& orders) {
  ArxMode mode;
  if (auto ok = read_coefficients(stored, orders, "a mode's ", mode); !ok) return ok.error();
  mode.constant = copied(stored.constant());
  mode.shock = copied(stored.shock());
  return mode;
}

Result<SwitchedArxModel> read_switched(const file::SwitchedArx& stored, int ny, int nu) {
  SwitchedArxModel model;
  auto orders = read_all_orders(stored, ny, nu);
  if (!orders) return orders.error();
  model.orders = std::move(*orders);
  for (const auto* stored_mode : *stored.modes()) {
    auto mode = read_mode(*stored_mode, model.orders);
    if (!mode) return mode.error();
    model.modes.push_back(std::move(*mode));
  }
  model.output_mean = copied(stored.output_mean());
  model.input_mean = copied(stored.input_mean());
  model.initial = copied(stored.initial());
  model.transitions = copied(stored.transitions());
  model.shock_quantiles = copied(stored.shock_quantiles());
  return model;
}

// Converts a stored origin; unknown values become kDefault.
Origin read_origin(file::Origin origin) {
  return origin == file::Origin::Learned ? Origin::kLearned
         : origin == file::Origin::Given ? Origin::kGiven
                                         : Origin::kDefault;
}

std::optional<ExtinctionTraining> read_extinction_training(const file::ExtinctionTraining* stored) {
  if (!stored) return std::nullopt;
  return ExtinctionTraining{
      read_origin(stored->origin()), stored->deaths(), stored->died(), stored->gusts(), stored->spared(),
      stored->vanishing_seconds()};
}

std::optional<MotionTraining> read_motion(const file::MotionTraining* stored) {
  if (!stored) return std::nullopt;
  return MotionTraining{stored->event()->str(), stored->min_seconds(), stored->debounce(),
                        static_cast<std::int32_t>(std::min<std::uint32_t>(stored->smooth_rows(), 1U << 30))};
}

Training read_training(const file::Training& stored) {
  Training made;
  made.program = text(stored.program());
  if (stored.sources()) {
    for (const auto* source : *stored.sources()) made.sources.push_back(source->str());
  }
  if (stored.recipe()) {
    for (const auto* note : *stored.recipe()) made.recipe.push_back({note->name()->str(), text(note->value())});
  }
  if (stored.figures()) {
    for (const auto* figure : *stored.figures()) made.figures.push_back({figure->name()->str(), figure->value()});
  }
  made.usable = {stored.usable(), text(stored.usable_reason())};
  if (stored.inputs()) {
    for (const auto* input : *stored.inputs()) made.inputs.push_back({input->scale(), input->one_rms()});
  }
  made.residual_sd = copied(stored.residual_sd());
  if (stored.underside() != file::Underside::Unknown) made.underside = stored.underside() == file::Underside::Yes;
  made.motion = read_motion(stored.motion());
  made.extinction = read_extinction_training(stored.extinction());
  if (const auto* its = stored.preparation()) {
    made.preparation = {its->detrend(), its->highpass_hz(), its->lowpass_hz(), its->resample_hz()};
  }
  made.own_levels = stored.own_levels();
  made.multiply_adds_per_frame = stored.multiply_adds_per_frame();
  made.operations_per_frame = stored.operations_per_frame();
  return made;
}

constexpr std::pair<InputShape, file::InputShape> kShapes[] = {
    {InputShape::kLinear, file::InputShape::Linear},
    {InputShape::kEvenOdd, file::InputShape::EvenOdd},
    {InputShape::kWindAlong, file::InputShape::WindAlong},
    {InputShape::kWindAcross, file::InputShape::WindAcross},
};

Result<InputShape> read_shape(file::InputShape shape) {
  for (const auto& [ours, stored] : kShapes) {
    if (stored == shape) return ours;
  }
  return Error{"has an input shape that this program does not know; update Wisp"};
}

file::InputShape stored_shape(InputShape shape) {
  return std::find_if(std::begin(kShapes), std::end(kShapes), [&](const auto& one) { return one.first == shape; })
      ->second;
}

Result<void> read_channels(const file::Model& stored, Model& model) {
  if (stored.inputs()) {
    for (const auto* input : *stored.inputs()) {
      const auto shape = read_shape(input->shape());
      if (!shape) return shape.error();
      model.inputs.push_back({input->name()->str(), text(input->unit()), input->lowest(), input->highest(), *shape});
    }
  }
  for (const auto* output : *stored.outputs()) {
    model.outputs.push_back({output->name()->str(), text(output->unit()), output->lowest(), output->highest()});
  }
  return {};
}

Result<void> read_dynamics(const file::Model& stored, Model& model) {
  const auto take = [&](auto read) -> Result<void> {
    if (!read) return read.error();
    model.dynamics = std::move(*read);
    return {};
  };
  if (const auto* chain = stored.dynamics_as_Chain()) return take(read_chain(*chain));
  const auto* outline = stored.view_as_Outline();
  const auto* shape = outline ? outline->shape() : nullptr;
  const int ny =
      shape ? shape->symmetric() + shape->antisymmetric() + shape->across() : static_cast<int>(model.outputs.size());
  const int nu = static_cast<int>(regressor_count(model.inputs));
  if (ny > kMaxStoredChannels || nu > kMaxStoredChannels) {
    return Error{"has dynamics of " + std::to_string(ny) + " outputs and " + std::to_string(nu) +
                 " inputs, expected at most 4096"};
  }
  if (const auto* switched = stored.dynamics_as_SwitchedArx()) return take(read_switched(*switched, ny, nu));
  const auto* arx = stored.dynamics_as_Arx();
  if (!arx) return Error{"has a kind of dynamics that this program does not know; update Wisp"};
  return take(read_arx(*arx, ny, nu));
}

std::vector<ValueRange> ranges(const fb::Vector<double>* stored) {
  std::vector<ValueRange> out;
  const std::vector<double> ends = copied(stored);
  for (std::size_t k = 0; k + 1 < ends.size(); k += 2) out.push_back({ends[k], ends[k + 1]});
  return out;
}

ShapeComponents read_shape(const file::ShapeComponents* stored) {
  if (!stored) return {};
  return {stored->symmetric(),           stored->antisymmetric(),      copied(stored->rest()), copied(stored->basis()),
          ranges(stored->coordinates()), ranges(stored->components()), stored->across()};
}

Result<void> read_view(const file::Model& stored, Model& model) {
  if (stored.view_type() == file::View::NONE) return {};
  if (const auto* pose = stored.view_as_Pose()) {
    model.view = PoseView{pose->half_width(), pose->half_length()};
    return {};
  }
  if (const auto* position = stored.view_as_Position()) {
    model.view = PositionView{position->half_width()};
    return {};
  }
  const auto* outline = stored.view_as_Outline();
  if (!outline) return Error{"has a view that this program does not know; update Wisp"};
  model.view = OutlineView{copied(outline->knots()), outline->metres_per_unit(), outline->pixels_per_unit(),
                           read_shape(outline->shape())};
  return {};
}

FlameEvents read_events(const file::FlameEvents* stored) {
  if (!stored) return {};
  return {copied(stored->sizes()), copied(stored->ends()), copied(stored->scale()), copied(stored->shapes())};
}

std::optional<Extinction> read_extinction(const file::Model& stored) {
  const auto* rule = stored.extinction();
  if (!rule) return {};
  return Extinction{rule->input(),
                    rule->level(),
                    rule->seconds(),
                    rule->haste(),
                    rule->recovery(),
                    read_events(rule->dying()),
                    read_events(rule->catching())};
}

// A written member of a FlatBuffers union: its kind and its offset.
template <class Kind>
struct Member {
  Kind kind = Kind::NONE;
  fb::Offset<void> at;
};

Member<file::Dynamics> write_dynamics(Builder& builder, const ArxModel& arx) {
  return {file::Dynamics::Arx, write_arx(builder, arx).Union()};
}

Member<file::Dynamics> write_dynamics(Builder& builder, const SwitchedArxModel& switched) {
  return {file::Dynamics::SwitchedArx, write_switched(builder, switched).Union()};
}

Member<file::Dynamics> write_dynamics(Builder& builder, const ChainModel& chain) {
  return {file::Dynamics::Chain, write_chain(builder, chain).Union()};
}

Member<file::View> write_view(Builder&, const PlainView&) { return {}; }

std::vector<double> flat(const std::vector<ValueRange>& ranges) {
  std::vector<double> out;
  for (const ValueRange& range : ranges) out.insert(out.end(), {range.lowest, range.highest});
  return out;
}

fb::Offset<file::ShapeComponents> write_shape(Builder& builder, const ShapeComponents& shape) {
  if (shape.empty()) return 0;
  const std::vector<double> coordinates = flat(shape.coordinates), components = flat(shape.components);
  return file::CreateShapeComponentsDirect(builder, static_cast<std::uint16_t>(shape.symmetric),
                                           static_cast<std::uint16_t>(shape.antisymmetric), &shape.rest, &shape.basis,
                                           &coordinates, &components, static_cast<std::uint16_t>(shape.across));
}

Member<file::View> write_view(Builder& builder, const OutlineView& outline) {
  const auto shape = write_shape(builder, outline.shape);
  const auto at =
      file::CreateOutlineDirect(builder, &outline.knots, outline.metres_per_unit, outline.pixels_per_unit, shape);
  return {file::View::Outline, at.Union()};
}

Member<file::View> write_view(Builder& builder, const PoseView& pose) {
  return {file::View::Pose, file::CreatePose(builder, pose.half_width, pose.half_length).Union()};
}

Member<file::View> write_view(Builder& builder, const PositionView& position) {
  return {file::View::Position, file::CreatePosition(builder, position.half_width).Union()};
}

}  // namespace

std::vector<std::byte> write_payload(const Model& model) {
  Builder builder;
  std::vector<fb::Offset<file::Input>> inputs;
  for (const Input& input : model.inputs) {
    inputs.push_back(file::CreateInputDirect(builder, input.name.c_str(), input.unit.c_str(), input.lowest,
                                             input.highest, stored_shape(input.shape)));
  }
  std::vector<fb::Offset<file::Output>> outputs;
  for (const Output& output : model.outputs) {
    outputs.push_back(
        file::CreateOutputDirect(builder, output.name.c_str(), output.unit.c_str(), output.lowest, output.highest));
  }
  const auto dynamics = std::visit([&](const auto& kind) { return write_dynamics(builder, kind); }, model.dynamics);
  const auto view = std::visit([&](const auto& kind) { return write_view(builder, kind); }, model.view);
  const auto training = write_training(builder, model.training);
  const auto extinction = write_extinction(builder, model.extinction);
  const auto name = builder.CreateString(model.name);
  const auto inputs_at = builder.CreateVector(inputs);
  const auto outputs_at = builder.CreateVector(outputs);
  builder.Finish(file::CreateModel(builder, name, model.rate_hz, inputs_at, outputs_at, dynamics.kind, dynamics.at,
                                   view.kind, view.at, training, extinction));
  const auto bytes = std::as_bytes(std::span(builder.GetBufferPointer(), builder.GetSize()));
  return {bytes.begin(), bytes.end()};
}

Result<Model> read_payload(std::span<const std::byte> payload) {
  // FlatBuffers needs aligned data, which the payload of a file in memory may not be: a copy is verified and read.
  std::vector<std::uint64_t> aligned((payload.size() + 7) / 8);
  std::copy(payload.begin(), payload.end(), reinterpret_cast<std::byte*>(aligned.data()));
  fb::Verifier verifier(reinterpret_cast<const std::uint8_t*>(aligned.data()), payload.size());
  if (!file::VerifyModelBuffer(verifier))
    return Error{
        "is damaged, or was made before the format was settled: its contents are not a valid model table; learn the "
        "model again"};
  const file::Model& stored = *file::GetModel(aligned.data());

  Model model;
  model.name = text(stored.name());
  model.rate_hz = stored.rate_hz();
  if (auto ok = read_channels(stored, model); !ok) return ok.error();
  if (auto ok = read_dynamics(stored, model); !ok) return ok.error();
  if (auto ok = read_view(stored, model); !ok) return ok.error();
  model.training = read_training(*stored.training());
  model.extinction = read_extinction(stored);
  return model;
}

}  // namespace wisp
