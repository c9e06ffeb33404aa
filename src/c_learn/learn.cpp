#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "c/boundary.hpp"
#include "wisp/learn/learn.hpp"
#include "wisp/learn/recipe_fields.hpp"
#include "wisp/model/file.hpp"
#include "wisp/wisp.h"

using namespace wisp::c;

struct wisp_recording {
  wisp::Recording recording;
};

struct wisp_fit {
  wisp::Result<std::vector<std::byte>> bytes;
  wisp::Usable usable;
};

namespace {

std::vector<std::string> names_of(const wisp::Recording& recording, wisp::Role role) {
  std::vector<std::string> names;
  for (const std::size_t k : channels_with_role(recording, role)) names.push_back(recording.channels[k].name);
  return names;
}

wisp::ArxRecipe arx_recipe(const wisp_recipe& given, const wisp::Recording& first) {
  wisp::ArxRecipe recipe{.inputs = names_of(first, wisp::Role::kInput),
                         .outputs = names_of(first, wisp::Role::kOutput),
                         .na = given.na,
                         .nb = given.nb};
  recipe.nk = given.nk < 0 ? std::nullopt : std::optional<wisp::OrderChoice>(given.nk);
  return recipe;
}

wisp::Result<wisp::Recipe> chain_recipe(const wisp_recipe& given, wisp::ChainRecipe recipe) {
  if (given.modes != 0) recipe.modes = given.modes;
  if (!given.event) return wisp::Recipe(recipe);
  auto event = wisp::parse_event(given.event);
  if (!event) return event.error();
  recipe.event = *event;
  return wisp::Recipe(recipe);
}

wisp::Result<wisp::Recipe> kind_of(const wisp_recipe& given, const wisp::Recording& first) {
  switch (given.kind) {
    case WISP_RECIPE_ARX:
      return wisp::Recipe(arx_recipe(given, first));
    case WISP_RECIPE_OUTLINE:
      return wisp::Recipe(wisp::OutlineRecipe());
    case WISP_RECIPE_FLAME:
      return wisp::Recipe(wisp::FlameRecipe());
    case WISP_RECIPE_CHAIN:
      return chain_recipe(given, wisp::ChainRecipe());
    case WISP_RECIPE_LEAF:
      return chain_recipe(given, wisp::LeafRecipe());
    case WISP_RECIPE_FLICKER:
      return wisp::Recipe(wisp::FlickerRecipe{.modes = given.modes != 0 ? given.modes : wisp::FlickerRecipe().modes});
    default:
      return wisp::Error{"wisp_learn was given a recipe of kind " + std::to_string(given.kind)};
  }
}

wisp::Result<wisp::Recipe> recipe_of(const wisp_recipe& given, const wisp::Recording& first) {
  auto recipe = kind_of(given, first);
  if (!recipe) return recipe;
  if (given.name) std::visit([&](auto& kind) { kind.name = given.name; }, *recipe);
  const auto right = std::visit([](const auto& kind) { return wisp::check_fields(kind); }, *recipe);
  if (!right) return right.error();
  return recipe;
}

}  // namespace

extern "C" {

wisp_status wisp_recording_create(double rate_hz, wisp_recording** recording) {
  if (!recording) return null_argument("wisp_recording_create");
  if (!(rate_hz > 0 && rate_hz < 1e9)) {
    return fail(WISP_BAD_ARGUMENT, "wisp_recording_create was given %g samples a second, expected 0 to 1e9", rate_hz);
  }
  return guarded("wisp_recording_create", [&] {
    *recording = new wisp_recording{{.source = "the recording", .rate_hz = rate_hz}};
    return WISP_OK;
  });
}

void wisp_recording_free(wisp_recording* recording) { delete recording; }

wisp_status wisp_recording_add(wisp_recording* recording, uint32_t role, const char* name, const char* unit,
                               const double* samples, size_t count) {
  if (!recording || !name || !samples) return null_argument("wisp_recording_add");
  if (role > WISP_ROLE_MOTION) {
    return fail(WISP_BAD_ARGUMENT, "wisp_recording_add was given role %u, expected a WISP_ROLE_...", role);
  }
  wisp::Recording& to = recording->recording;
  const std::size_t rows = to.channels.empty() ? count : to.rows();
  if (!buffer_is_right("wisp_recording_add", samples, count, rows)) return WISP_BAD_ARGUMENT;
  static constexpr wisp::Role kRoles[] = {wisp::Role::kInput, wisp::Role::kOutput, wisp::Role::kMotion};
  return guarded("wisp_recording_add", [&]() -> wisp_status {
    if (find_channel(to, name)) {
      return fail(WISP_BAD_DATA, "wisp_recording_add was given channel %s, which is there already", name);
    }
    wisp::Recording alone{.source = to.source, .rate_hz = to.rate_hz};
    alone.channels.push_back({name, unit ? unit : "", kRoles[role], {samples, samples + count}});
    if (auto ok = check(alone); !ok) return fail(WISP_BAD_DATA, ok.error());
    to.channels.push_back(std::move(alone.channels.front()));
    return WISP_OK;
  });
}

wisp_status wisp_recording_set_episodes(wisp_recording* recording, const int64_t* ids, size_t count) {
  if (!recording) return null_argument("wisp_recording_set_episodes");
  if (!buffer_is_right("wisp_recording_set_episodes", ids, count, recording->recording.rows())) {
    return WISP_BAD_ARGUMENT;
  }
  return guarded("wisp_recording_set_episodes", [&] {
    recording->recording.episode_ids.assign(ids, ids + count);
    return WISP_OK;
  });
}

wisp_status wisp_recording_set_attribute(wisp_recording* recording, const char* name, const char* value) {
  if (!recording || !name || !value) return null_argument("wisp_recording_set_attribute");
  return guarded("wisp_recording_set_attribute", [&] {
    for (wisp::Attribute& there : recording->recording.attributes) {
      if (there.name != name) continue;
      there.value = value;
      return WISP_OK;
    }
    recording->recording.attributes.push_back({name, value});
    return WISP_OK;
  });
}

wisp_recipe wisp_recipe_default(uint32_t kind) {
  const wisp::ArxRecipe arx;
  const int nk = std::get<int>(*arx.nk);
  return {sizeof(wisp_recipe), kind, std::get<int>(arx.na), std::get<int>(arx.nb), nk, 0, nullptr, nullptr};
}

wisp_status wisp_learn(const wisp_recording* const* recordings, size_t count, const wisp_recipe* recipe,
                       wisp_progress progress, void* of, wisp_fit** fit) {
  if (!recordings || !recipe || !fit) return null_argument("wisp_learn");
  if (!size_is_right("wisp_learn", recipe->size)) return WISP_BAD_ARGUMENT;
  if (count == 0) return fail(WISP_BAD_ARGUMENT, "wisp_learn was given no recording");
  return guarded("wisp_learn", [&]() -> wisp_status {
    std::vector<wisp::Recording> from;
    for (std::size_t k = 0; k < count; ++k) {
      if (!recordings[k]) return null_argument("wisp_learn");
      from.push_back(recordings[k]->recording);
      if (count > 1) from.back().source += " " + std::to_string(k);
    }
    wisp_recipe known = wisp_recipe_default(recipe->kind);
    take_in(recipe, known);
    const auto wanted = recipe_of(known, from.front());
    if (!wanted) return fail(WISP_BAD_ARGUMENT, wanted.error());
    bool stopped = false;
    wisp::Progress told;
    if (progress) {
      told = [&](std::string_view stage, double share) {
        stopped = progress(of, std::string(stage).c_str(), share) == 0;
        return !stopped;
      };
    }
    const auto learned = wisp::learn(from, *wanted, told);
    if (!learned) return fail(stopped ? WISP_STOPPED : WISP_BAD_DATA, learned.error());
    *fit = new wisp_fit{model_bytes(learned->model), learned->model.training.usable};
    return WISP_OK;
  });
}

void wisp_fit_free(wisp_fit* fit) { delete fit; }

wisp_status wisp_fit_get_model(const wisp_fit* fit, const void** bytes, size_t* size) {
  if (!fit || !bytes || !size) return null_argument("wisp_fit_get_model");
  if (!fit->bytes) return fail(WISP_BAD_DATA, fit->bytes.error());
  *bytes = fit->bytes->data();
  *size = fit->bytes->size();
  return WISP_OK;
}

int32_t wisp_fit_usable(const wisp_fit* fit) { return fit && fit->usable.verdict ? 1 : 0; }

const char* wisp_fit_reason(const wisp_fit* fit) { return fit ? fit->usable.reason.c_str() : ""; }
}
