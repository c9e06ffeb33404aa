// Banks of living instances. An instance is an int with its slot in the lower 32 bits.

#include <algorithm>
#include <cmath>
#include <span>
#include <thread>
#include <vector>

#include "module.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/body_facet.hpp"
#include "wisp/run/chain_facet.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace wisp::python {
namespace {

using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;
using Instance = std::optional<std::uint64_t>;
using Shape = std::vector<py::ssize_t>;

std::uint64_t number_of(InstanceId id) { return static_cast<std::uint64_t>(id.generation) << 32 | id.slot; }

InstanceId living(const Bank& bank, std::uint64_t number) {
  const InstanceId id{static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(number >> 32)};
  if (!bank.valid(id)) throw py::key_error("instance " + std::to_string(number) + " is not alive");
  return id;
}

std::string words_of(const Shape& shape) { return py::str(py::tuple(py::cast(shape))).cast<std::string>(); }

Shape shape_of(const py::array& array) { return {array.shape(), array.shape() + array.ndim()}; }

/// Returns `out` after checking its shape, or a new array.
py::array_t<float> room(const py::object& out, const Shape& shape) {
  if (out.is_none()) return py::array_t<float>(shape);
  if (!py::isinstance<py::array_t<float, py::array::c_style>>(out))
    throw py::type_error("out: expected a contiguous array of float32");
  auto array = out.cast<py::array_t<float>>();
  if (!array.writeable() || shape_of(array) != shape)
    throw py::value_error("out: expected a writable array of shape " + words_of(shape) + ", found " +
                          words_of(shape_of(array)));
  return array;
}

std::span<float> values_of(py::array_t<float>& array) {
  return {array.mutable_data(), static_cast<std::size_t>(array.size())};
}

/// Sets inputs: one row for all, one per slot, or one instance's. With one input a vector of slots is accepted.
void set_inputs(Bank& bank, const Floats& values, Instance instance) {
  const std::span<const float> all(values.data(), static_cast<std::size_t>(values.size()));
  const py::ssize_t width = bank.input_count(), slots = bank.slots();
  const Shape shape = shape_of(values);
  const bool row = shape == Shape{width} || (shape.empty() && width == 1);
  if (instance && row) return void(bank.set_inputs(living(bank, *instance), all));
  if (!instance && row) return bank.set_common_inputs(all);
  if (!instance && (shape == Shape{slots, width} || (width == 1 && shape == Shape{slots}))) return bank.set_inputs(all);
  throw py::value_error("inputs: found shape " + words_of(shape) + ", expected " + std::to_string(width) + " for " +
                        (instance ? "one"
                                  : "all or " + std::to_string(width) + " for each of " + std::to_string(slots) +
                                        " slots, " + words_of({slots, width})));
}

py::array_t<float> play(Bank& bank, int steps, const py::object& inputs) {
  const py::ssize_t slots = bank.slots();
  if (steps < 0) throw py::value_error("steps: found " + std::to_string(steps) + ", expected 0 or more");
  Floats given;
  std::span<const float> in;
  if (!inputs.is_none()) {
    given = Floats::ensure(inputs);
    const Shape expected{steps, slots, bank.input_count()};
    if (!given || shape_of(given) != expected)
      throw py::value_error("inputs: expected shape " + words_of(expected) +
                            (given ? ", found " + words_of(shape_of(given)) : ", found no numbers"));
    in = {given.data(), static_cast<std::size_t>(given.size())};
  }
  py::array_t<float> out(Shape{steps, slots, bank.output_count()});
  const std::span<float> values = values_of(out);
  const py::gil_scoped_release released;
  bank.step(steps, in, values);
  return out;
}

ExtinctionFacet& extinction_of(Bank& bank) {
  if (ExtinctionFacet* extinction = bank.extinction()) return *extinction;
  throw py::attribute_error("nothing extinguishes this model");
}

BodyFacet& bodies_of(Bank& bank) {
  if (BodyFacet* body = bank.body()) return *body;
  throw py::attribute_error("the model is not in the round");
}

ChainFacet& chain_of(Bank& bank) {
  if (ChainFacet* chain = bank.chain()) return *chain;
  throw py::attribute_error("the model's dynamics are not a chain");
}

std::vector<LitState> states_of(Bank& bank) {
  std::vector<LitState> states(static_cast<std::size_t>(bank.slots()));
  extinction_of(bank).states(states);
  return states;
}

py::object age(std::chrono::nanoseconds time) {
  if (time == kNever) return py::none();
  return py::float_(std::chrono::duration<double>(time).count());
}

py::dict flame(Bank& bank, std::uint64_t instance) {
  const LitState state = *extinction_of(bank).state_of(living(bank, instance));
  py::dict all;
  all["lit"] = state.lit;
  all["size"] = state.size;
  all["since_lit"] = age(state.since_lit);
  all["since_out"] = age(state.since_out);
  all["relit"] = state.relit;
  all["went_out"] = state.went_out;
  return all;
}

py::dict light(const Bank& bank, std::uint64_t instance) {
  const auto found = bank.light(living(bank, instance));
  if (!found) throw py::attribute_error("the model's view is not an outline");
  py::dict all;
  all["position"] = py::array_t<float>(3, found->position.data());
  all["intensity"] = found->intensity;
  all["kelvin"] = found->kelvin;
  return all;
}

// Calls one(id) for an instance, or for all living ones.
template <class One>
void each(Bank& bank, Instance instance, One one) {
  if (instance) return one(living(bank, *instance));
  for (int slot = 0; slot < bank.slots(); ++slot) one(bank.at(slot));
}

py::bytes save(const Bank& bank) {
  std::string bytes(bank.save_bytes(), '\0');
  bank.save(std::as_writable_bytes(std::span(bytes)));
  return bytes;
}

// Starts a thread per part in each call, which is worthwhile for many instances or many steps per call.
void run_parts(void*, int parts, void (*task)(void*, int), void* of) {
  std::vector<std::thread> threads;
  for (int part = 1; part < parts; ++part) threads.emplace_back(task, of, part);
  task(of, 0);
  for (std::thread& thread : threads) thread.join();
}

using Three = std::array<float, 3>;

void bind_life(py::class_<Bank>& bank) {
  bank.def(
          "spawn",
          [](Bank& self, std::optional<std::uint64_t> stream) {
            const InstanceId id = stream ? self.spawn(*stream) : self.spawn();
            if (!self.valid(id))
              throw py::value_error("the bank is full: its capacity is " + std::to_string(self.capacity()));
            return number_of(id);
          },
          py::arg("stream") = py::none(), "Starts an instance in the lowest empty slot; returns it, an int.")
      .def(
          "end", [](Bank& self, std::uint64_t id) { self.end(living(self, id)); }, py::arg("instance"))
      .def(
          "alive",
          [](const Bank& self, std::uint64_t id) {
            return self.valid({static_cast<std::uint32_t>(id), static_cast<std::uint32_t>(id >> 32)});
          },
          py::arg("instance"))
      .def(
          "at",
          [](const Bank& self, int slot) -> std::optional<std::uint64_t> {
            const InstanceId id = self.at(slot);
            if (!self.valid(id)) return {};
            return number_of(id);
          },
          py::arg("slot"), "The instance in a slot; None where it is empty.")
      .def(
          "reset",
          [](Bank& self, Instance instance) {
            if (!instance) return self.reset();
            self.reset(living(self, *instance));
          },
          py::arg("instance") = py::none(), "Back to the start: one, or all and the bank's time.")
      .def_property_readonly(
          "lit",
          [](Bank& self) {
            std::vector<bool> burning;
            for (const LitState& state : states_of(self)) burning.push_back(state.lit);
            return burning;
          },
          "Whether each slot burns.")
      .def_property_readonly(
          "flame_sizes",
          [](Bank& self) {
            std::vector<float> sizes;
            for (const LitState& state : states_of(self)) sizes.push_back(state.size);
            return py::array_t<float>(static_cast<py::ssize_t>(sizes.size()), sizes.data());
          },
          "Size of each slot's flame, 0 to 1; outlines are already multiplied by it.")
      .def("flame", &flame, py::arg("instance"),
           "lit, size, seconds since_lit and since_out (None: never); relit, went_out: in the last step or advance.")
      .def("light", &light, py::arg("instance"), "position, intensity against rest, and kelvin of a flame.")
      .def(
          "relight",
          [](Bank& self, Instance instance) {
            if (!self.extinction()) return;
            each(self, instance, [&](InstanceId id) { self.extinction()->relight(id); });
          },
          py::arg("instance") = py::none(), "Lights what is out: one, or all.")
      .def(
          "extinguish",
          [](Bank& self, Instance instance) {
            each(self, instance, [&, &facet = extinction_of(self)](InstanceId id) { facet.extinguish(id); });
          },
          py::arg("instance") = py::none(), "Puts out one, or all, whatever the wind.")
      .def(
          "mode", [](const Bank& self, std::uint64_t id) { return self.mode(living(self, id)); }, py::arg("instance"),
          "The mode of a switched model that made the newest sample; None before the first.");
}

void bind_chain(py::class_<Bank>& bank) {
  bank.def(
          "place",
          [](Bank& self, std::uint64_t id, const Three& position, const std::array<float, 4>& orientation,
             const Three& velocity, const Three& spin) {
            if (!chain_of(self).place(living(self, id), {position, orientation, velocity, spin}))
              throw py::value_error("place: a number is not finite");
          },
          py::arg("instance"), py::arg("position"), py::arg("orientation") = std::array<float, 4>{1, 0, 0, 0},
          py::arg("velocity") = Three{}, py::arg("spin") = Three{},
          "Sets a leaf where a body is: metres, a quaternion w first, metres and radians a second, z up.")
      .def(
          "steer",
          [](Bank& self, std::uint64_t id, const Three& position, double seconds, float within) {
            const std::chrono::nanoseconds time(static_cast<std::int64_t>(std::clamp(seconds, -1.0, 1e5) * 1e9));
            if (!chain_of(self).steer(living(self, id), {position, time, within}))
              throw py::value_error(chain_of(self).can_steer() ? "steer: a number is out of its range"
                                                               : "steer: this chain cannot be steered");
          },
          py::arg("instance"), py::arg("position"), py::arg("seconds"), py::arg("within") = 0.1F,
          "Steers a leaf to a place that it is to reach in so many seconds.")
      .def(
          "release", [](Bank& self, std::uint64_t id) { chain_of(self).release(living(self, id)); },
          py::arg("instance"), "Lets a leaf fall as it will.")
      .def_property_readonly("can_steer", [](Bank& self) { return self.chain() && self.chain()->can_steer(); })
      .def(
          "chain_place",
          [](Bank& self, std::uint64_t id) {
            const ChainPlace place = *chain_of(self).place_of(living(self, id));
            py::dict all;
            all["segment"] = place.segment;
            all["step"] = place.step;
            all["mode"] = place.mode;
            all["velocity"] = py::array_t<float>(3, place.velocity.data());
            all["spin"] = py::array_t<float>(3, place.spin.data());
            all["lies"] = place.lies;
            all["landed"] = place.landed;
            return all;
          },
          py::arg("instance"),
          "segment, step, mode; velocity and spin over the last step; lies, landed: on the ground.")
      .def_property(
          "ground", [](Bank& self) { return chain_of(self).ground(); },
          [](Bank& self, std::optional<float> height) { chain_of(self).set_ground(height); },
          "Height of level ground, metres; None: leaves fall for ever.");
}

void bind_time(py::class_<Bank>& bank) {
  bank.def("set_inputs", &set_inputs, py::arg("values"), py::arg("instance") = py::none(),
           "One row for all instances, one for each slot (slots x inputs), or one instance's.")
      .def(
          "step", [](Bank& self, int steps) { self.step(std::max(steps, 0)); }, py::arg("steps") = 1,
          py::call_guard<py::gil_scoped_release>())
      .def("play", &play, py::arg("steps"), py::arg("inputs") = py::none(),
           "Many steps in one call: steps x slots x outputs, for inputs of steps x slots x inputs.")
      .def("advance", py::overload_cast<double>(&Bank::advance), py::arg("seconds"),
           py::call_guard<py::gil_scoped_release>(), "Returns the steps that were made.")
      .def(
          "outputs",
          [](const Bank& self, const py::object& out, Instance instance) {
            auto array = room(out, instance ? Shape{self.output_count()} : Shape{self.slots(), self.output_count()});
            if (instance)
              self.outputs(living(self, *instance), values_of(array));
            else
              self.outputs(values_of(array));
            return array;
          },
          py::arg("out") = py::none(), py::arg("instance") = py::none(),
          "slots x outputs, or one instance's; into `out` where it is given.")
      .def(
          "polylines",
          [](const Bank& self, const py::object& out, Instance instance) {
            if (self.polyline_points() == 0) throw py::attribute_error("the model's view is not an outline");
            auto array =
                room(out, instance ? Shape{self.polyline_points(), 2} : Shape{self.slots(), self.polyline_points(), 2});
            if (instance)
              self.polyline(living(self, *instance), values_of(array));
            else
              self.polylines(values_of(array));
            return array;
          },
          py::arg("out") = py::none(), py::arg("instance") = py::none(),
          "slots x points x 2, or one instance's; into `out` where it is given.")
      .def(
          "look", [](Bank& self, float right_x, float right_z) { bodies_of(self).look(right_x, right_z); },
          py::arg("right_x"), py::arg("right_z"),
          "In the round: outputs and outlines as a level camera sees them whose right is (x, z), of length 1.")
      .def(
          "rings",
          [](Bank& self, std::uint64_t instance) {
            auto array = room(py::none(), Shape{bodies_of(self).rings(), static_cast<int>(kRingNumbers)});
            bodies_of(self).read_rings(living(self, instance), values_of(array));
            return array;
          },
          py::arg("instance"),
          "In the round: rings x 6 from the base to the tip: the middle's x, y, z, the radius, its rise to its rim "
          "towards +x and +z.")
      .def(
          "mesh",
          [](Bank& self, std::uint64_t instance, int segments) {
            if (segments < 3 || segments > 256) throw py::value_error("segments: expected 3 to 256");
            const int count = bodies_of(self).rings();
            std::vector<float> rings(static_cast<std::size_t>(count) * kRingNumbers);
            bodies_of(self).read_rings(living(self, instance), rings);
            auto array = room(py::none(), Shape{count * segments, static_cast<int>(kVertexNumbers)});
            ring_mesh(rings, segments, values_of(array));
            py::array_t<std::uint32_t> triangles({ring_triangle_count(count, segments), 3});
            ring_triangles(count, segments, {triangles.mutable_data(), static_cast<std::size_t>(triangles.size())});
            return py::make_tuple(array, triangles);
          },
          py::arg("instance"), py::arg("segments") = 16,
          "In the round: vertices x (place, normal), and triangles x 3, anticlockwise from outside.")
      .def_property(
          "threads", [](const py::object& self) { return py::getattr(self, "_threads", py::int_(1)); },
          [](const py::object& self, int count) {
            if (count < 1 || count > 256) throw py::value_error("threads: expected 1 to 256");
            self.cast<Bank&>().set_crew({.parts = count, .run = count > 1 ? run_parts : nullptr});
            py::setattr(self, "_threads", py::int_(count));
          },
          "Threads that share a step, with the same bits: from some thousand instances on.");
}

}  // namespace

void bind_banks(py::module_& module) {
  py::class_<Bank> bank(module, "Bank", "Living instances of one model, stepped together. Rows of arrays are slots.",
                        py::dynamic_attr());
  bank.def(py::init([](const Model& model, int instances, std::uint64_t seed, int polyline_points,
                       std::optional<int> capacity, double longest_advance) {
             const std::chrono::nanoseconds longest(
                 static_cast<std::int64_t>(std::clamp(longest_advance, -1.0, 100.0) * 1e9));
             Bank made = unwrapped(Bank::create(model, {.capacity = std::max(instances, capacity.value_or(instances)),
                                                        .seed = seed,
                                                        .polyline_points = polyline_points,
                                                        .longest_advance = longest}));
             for (int k = 0; k < instances; ++k) made.spawn();
             return made;
           }),
           py::arg("model"), py::arg("instances") = 1, py::kw_only(), py::arg("seed") = 1,
           py::arg("polyline_points") = 32, py::arg("capacity") = py::none(), py::arg("longest_advance") = 10.0,
           "longest_advance: seconds that advance() lets pass at most.")
      .def_property_readonly("slots", &Bank::slots, "Rows of arrays: one more than the highest slot in use.")
      .def_property_readonly("size", &Bank::size, "Instances alive.")
      .def_property_readonly("capacity", &Bank::capacity)
      .def_property_readonly(
          "clamped", [](const Bank& self) { return py::make_tuple(self.clamped().clamped, self.clamped().steps); },
          "Steps of instances in which an output was clamped, of how many.")
      .def_property("noise", &Bank::noise, &Bank::set_noise, "Scale of the residual noise: 1 as learned, 0 none.")
      .def("save", &save, "The whole state, as bytes.")
      .def(
          "restore",
          [](Bank& self, const py::bytes& bytes) {
            const std::string_view view = bytes;
            unwrap(self.restore(std::as_bytes(std::span(view))));
          },
          py::arg("bytes"))
      .def("__repr__", [](const Bank& self) {
        return "<wisp.Bank of " + std::to_string(self.size()) + " instances, capacity " +
               std::to_string(self.capacity()) + ">";
      });
  bind_time(bank);
  bind_life(bank);
  bind_chain(bank);
}

}  // namespace wisp::python
