#include "wisp/export/export.hpp"

#include <algorithm>
#include <cmath>

#include "export/outline.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/body_facet.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace wisp {
namespace {

using namespace exporting;

constexpr double kMaxSeconds = 3600, kMaxNumbers = 5e8;
constexpr int kMaxInstances = 1000;
constexpr double kSettle = 4;  // seconds of play before the first frame

Result<void> check(const Model& model, const TakeOptions& options) {
  if (!(options.seconds > 0 && options.seconds <= kMaxSeconds))
    return Error{"the length is " + std::to_string(options.seconds) + " s, expected above 0 and at most 3600 s"};
  const double frames = options.seconds * model.rate_hz;
  if (frames < 1) return Error{"the length is less than one frame of the model, expected at least 1"};
  if (options.loop && std::lround(frames) < 2) return Error{"the loop is a single frame, expected at least 2"};
  if (options.instances < 1 || options.instances > kMaxInstances)
    return Error{"there are " + std::to_string(options.instances) + " instances, expected 1 to 1000"};
  if (frames * options.instances * static_cast<double>(model.outputs.size()) > kMaxNumbers)
    return Error{"the frames are more than 5e8 numbers; ask for fewer seconds or instances"};
  if (!options.schedule.empty() &&
      (options.loop || model.inputs.empty() || options.schedule.size() % model.inputs.size() != 0)) {
    return Error{"a schedule of inputs is for plays that do not loop, of models with inputs, in rows of all inputs"};
  }
  if (options.inputs.size() > model.inputs.size())
    return Error{"there are " + std::to_string(options.inputs.size()) + " inputs, the model has " +
                 std::to_string(model.inputs.size())};
  return wisp::check(model);
}

std::vector<float> inputs_of(const Model& model, const TakeOptions& options) {
  std::vector<float> inputs(model.inputs.size());
  for (std::size_t k = 0; k < options.inputs.size(); ++k) inputs[k] = static_cast<float>(options.inputs[k]);
  return inputs;
}

Error went_out(double seconds) {
  const std::string when = seconds > 0 ? "after " + std::to_string(seconds) + " s" : "by the first frame";
  return {"the flame goes out " + when + " in that input; what is exported burns: ask for less"};
}

Result<Bank> settled_bank(const Model& model, const TakeOptions& options) {
  auto bank = Bank::create(model, {.capacity = options.instances, .seed = options.seed});
  if (!bank) return bank;
  bank->set_noise(options.noise ? 1.0F : 0.0F);
  for (int k = 0; k < options.instances; ++k) bank->spawn();
  bank->set_common_inputs(inputs_of(model, options));
  // A body's take begins at the start of the fall.
  if (bank->chain()) return bank;
  for (int step = 0; step < kSettle * model.rate_hz; ++step) bank->step();
  return bank;
}

bool burns(const Bank& bank) {
  const ExtinctionFacet* extinction = bank.extinction();
  for (int slot = 0; extinction && slot < bank.slots(); ++slot) {
    if (!extinction->state_of(bank.at(slot))->lit) return false;
  }
  return true;
}

Result<Take> plain_take(const Model& model, const TakeOptions& options, Take taken) {
  auto bank = settled_bank(model, options);
  if (!bank) return bank.error();
  const std::size_t width = taken.instances * taken.outputs;
  taken.values.resize(taken.sides * taken.frames * width);
  const std::size_t inputs = model.inputs.size(), rows = inputs > 0 ? options.schedule.size() / inputs : 0;
  for (std::size_t frame = 0; frame < taken.frames; ++frame) {
    if (frame < rows) bank->set_common_inputs(std::span(options.schedule).subspan(frame * inputs, inputs));
    bank->step();
    if (rows == 0 && !burns(*bank)) return went_out(static_cast<double>(frame) / model.rate_hz);
    bank->outputs(std::span(taken.values).subspan(frame * width, width));
    if (taken.sides == 1) continue;
    bank->body()->look(0, 1);
    bank->outputs(std::span(taken.values).subspan((taken.frames + frame) * width, width));
    bank->body()->look(1, 0);
  }
  return taken;
}

// Clamps a value as a bank does, since an orbit may slightly exceed the range of play.
float clamped_to(const Output& output, double value) {
  const double room = kRangeMargin * (output.highest - output.lowest);
  return static_cast<float>(std::clamp(value, output.lowest - room, output.highest + room));
}

Result<Take> orbit_take(const Model& model, const TakeOptions& options, Take taken) {
  auto bank = settled_bank(model, options);
  if (!bank) return bank.error();
  const std::size_t lags = output_lags(model), count = lags + taken.frames, width = taken.instances * taken.outputs;
  std::vector<std::vector<double>> rows(taken.instances);
  std::vector<std::vector<std::size_t>> modes(taken.instances);
  std::vector<float> values(width);
  for (std::size_t row = 0; row < count; ++row) {
    bank->step();
    if (!burns(*bank)) return went_out(static_cast<double>(row) / model.rate_hz);
    bank->outputs(values);
    for (std::size_t k = 0; k < taken.instances; ++k) {
      const auto from = values.begin() + static_cast<std::ptrdiff_t>(k * taken.outputs);
      rows[k].insert(rows[k].end(), from, from + static_cast<std::ptrdiff_t>(taken.outputs));
      modes[k].push_back(static_cast<std::size_t>(bank->mode(bank->at(static_cast<int>(k))).value_or(0)));
    }
  }
  taken.values.resize(taken.frames * width);
  for (std::size_t k = 0; k < taken.instances; ++k) {
    if (!close_orbit(model, modes[k], lags, rows[k])) {
      return Error{"no loop of " + std::to_string(taken.frames) +
                   " frames: the model forgets too slowly for so short a round; ask for a longer one"};
    }
    for (std::size_t frame = 0; frame < taken.frames; ++frame) {
      for (std::size_t i = 0; i < taken.outputs; ++i) {
        taken.values[frame * width + k * taken.outputs + i] =
            clamped_to(model.outputs[i], rows[k][(lags - 1 + frame) * taken.outputs + i]);
      }
    }
  }
  return taken;
}

// Returns a model of the components of an outline's shape: their dynamics are linear; control points are clamped.
Model model_of_components(const Model& model, const ShapeComponents& shape) {
  Model out = model;
  out.view = PlainView{};
  if (out.extinction) out.extinction->catching = {};  // recorded re-ignitions are outlines
  out.training = {};
  out.outputs.clear();
  for (const ValueRange& range : shape.components) {
    out.outputs.push_back({"c" + std::to_string(out.outputs.size()), "", range.lowest, range.highest});
  }
  return out;
}

// Returns a body's shape in side view: its z coordinates replace its x coordinates.
ShapeComponents from_the_side(ShapeComponents shape) {
  const auto points = static_cast<std::ptrdiff_t>(shape.points());
  std::copy_n(shape.rest.end() - points, points, shape.rest.end() - 2 * points);
  std::copy_n(shape.coordinates.end() - points, points, shape.coordinates.end() - 2 * points);
  return shape;
}

Result<Take> shape_take(const Model& model, const ShapeComponents& shape, const TakeOptions& options, Take taken) {
  Take moved = taken;
  moved.outputs = shape.count();
  moved.sides = 1;
  const auto across = static_cast<std::ptrdiff_t>(shape.across);
  auto orbit = orbit_take(model_of_components(model, shape), options, std::move(moved));
  if (!orbit) return orbit;
  for (std::size_t side = 0; side < taken.sides; ++side) {
    const ShapeComponents seen = side == 0 ? shape : from_the_side(shape);
    for (std::size_t row = 0; row < taken.frames * taken.instances; ++row) {
      const auto from = orbit->values.begin() + static_cast<std::ptrdiff_t>(row * shape.count());
      std::vector<double> components(from, from + static_cast<std::ptrdiff_t>(shape.count()));
      if (side > 0) std::copy_n(components.end() - across, across, components.end() - 2 * across);
      for (double value : control_points(seen, components)) taken.values.push_back(static_cast<float>(value));
    }
  }
  return taken;
}

Result<Take> walk_take(const Model& model, const TakeOptions& options, Take taken, const Progress& progress) {
  const std::size_t width = taken.instances * taken.outputs;
  taken.values.resize(taken.frames * width);
  for (std::size_t k = 0; k < taken.instances; ++k) {
    const std::uint64_t seed = options.seed + 0xd1342543de82ef95U * k;  // neighbouring seeds share no instance
    const auto loop = find_walk_loop(model, taken.frames, seed, inputs_of(model, options), progress);
    if (!loop) return loop.error();
    taken.travel.push_back(loop->travel);
    for (std::size_t frame = 0; frame < taken.frames; ++frame) {
      std::copy_n(loop->rows.begin() + static_cast<std::ptrdiff_t>(frame * taken.outputs), taken.outputs,
                  taken.values.begin() + static_cast<std::ptrdiff_t>(frame * width + k * taken.outputs));
    }
  }
  return taken;
}

}  // namespace

Result<Take> take(const Model& plane, const TakeOptions& asked, const Progress& progress) {
  if (auto ok = check(plane, asked); !ok) return ok.error();
  const auto round = asked.round ? in_the_round(plane) : Result<Model>(plane);
  const Model& model = round ? *round : plane;
  TakeOptions options = asked;
  if (model.inputs.size() > plane.inputs.size()) {
    options.schedule.clear();
    for (const float wind : asked.schedule) options.schedule.insert(options.schedule.end(), {wind, 0});
  }
  Take taken{.rate_hz = model.rate_hz, .loop = options.loop};
  taken.frames = static_cast<std::size_t>(std::llround(std::max(1.0, options.seconds * model.rate_hz)));
  taken.instances = static_cast<std::size_t>(options.instances);
  taken.outputs = model.outputs.size();
  taken.sides = is_in_the_round(model) ? 2 : 1;
  if (!options.loop) return plain_take(model, options, std::move(taken));
  if (std::holds_alternative<ChainModel>(model.dynamics)) return walk_take(model, options, std::move(taken), progress);
  if (const auto* outline = std::get_if<OutlineView>(&model.view); outline && !outline->shape.empty()) {
    return shape_take(model, outline->shape, options, std::move(taken));
  }
  return orbit_take(model, options, std::move(taken));
}

}  // namespace wisp
