#include "reports/arx_search.hpp"

#include <algorithm>
#include <charconv>

#include "flags/recordings.hpp"
#include "reports/figures_json.hpp"
#include "wisp/learn/order_search.hpp"
#include "wisp/learn/prediction.hpp"

namespace wisp::cli {
namespace {

Error bad_grid(std::string_view text) {
  return {"--search: found \"" + std::string(text) + "\", expected such as na=1:10,nb=1:10,nk=0:3"};
}

// "1:10" or "3".
Result<OrderRange> parse_range(std::string_view text, std::string_view whole) {
  OrderRange range;
  const char* const end = text.data() + text.size();
  auto [next, code] = std::from_chars(text.data(), end, range.first);
  if (code != std::errc()) return bad_grid(whole);
  range.last = range.first;
  if (next != end) {
    if (*next != ':') return bad_grid(whole);
    const auto [last, last_code] = std::from_chars(next + 1, end, range.last);
    if (last_code != std::errc() || last != end) return bad_grid(whole);
  }
  if (range.first < 0 || range.last < range.first) return bad_grid(whole);
  return range;
}

Result<SearchOptions> parse_grid(const Arguments& arguments) {
  SearchOptions options;
  const std::string& whole = arguments.text("search");
  // What the grid leaves out has one value, that of the flag.
  for (const auto& [flag, range] : {std::pair{"na", &options.na}, {"nb", &options.nb}, {"nk", &options.nk}}) {
    const auto alone = parse_range(arguments.text(flag), whole);
    if (!alone && whole.find(std::string(flag) + "=") == std::string::npos) {
      return Error{"--search leaves " + std::string(flag) + " to --" + flag + ", which is \"" + arguments.text(flag) +
                   "\", expected a number; or give it a range in --search"};
    }
    if (alone) *range = *alone;
  }
  for (const std::string& part : arguments.names("search")) {
    const std::string_view text(part);
    const std::string_view name = text.substr(0, 3);
    if (name != "na=" && name != "nb=" && name != "nk=") return bad_grid(whole);
    const auto range = parse_range(text.substr(3), whole);
    if (!range) return range.error();
    (name == "na=" ? options.na : name == "nb=" ? options.nb : options.nk) = *range;
  }
  return options;
}

OrderCriterion criterion_of(const std::string& word) {
  if (word == "aic") return OrderCriterion::kAic;
  if (word == "aicc") return OrderCriterion::kAicc;
  if (word == "bic") return OrderCriterion::kBic;
  return word == "validation" ? OrderCriterion::kValidation : OrderCriterion::kFpe;
}

Coupling coupling_of(const std::string& word) {
  if (word == "diagonal") return Coupling::kDiagonal;
  return word == "band" ? Coupling::kBand : Coupling::kFull;
}

ArxOffset offset_of(const std::string& word) {
  if (word == "none") return ArxOffset::kNone;
  return word == "estimate" ? ArxOffset::kEstimate : ArxOffset::kMean;
}

Result<SearchOptions> options_from(const Arguments& arguments) {
  auto options = parse_grid(arguments);
  if (!options) return options;
  options->by = criterion_of(arguments.text("by"));
  options->steps = arguments.text("steps") == "inf" ? kFreeRun : arguments.integer("steps");
  options->coupling = coupling_of(arguments.text("coupling"));
  options->offset = offset_of(arguments.text("offset"));
  options->common_start = arguments.on("common-start");
  if (arguments.text("steps") == "0") return Error{"--steps: found \"0\", expected a number from 1, or inf"};
  if (options->by == OrderCriterion::kValidation && !arguments.has("validate")) {
    return Error{"--by validation needs --validate A:B, the rows to judge on"};
  }
  return options;
}

Json candidate_json(const OrderCandidate& candidate) {
  Json json = {{"na", candidate.na},
               {"nb", candidate.nb},
               {"nk", candidate.nk},
               {"V", json_of(candidate.loss)},
               {"fpe", number(candidate.fpe)},
               {"aic", number(candidate.aic)},
               {"aicc", number(candidate.aicc)},
               {"bic", number(candidate.bic)},
               {"samples_used", candidate.rows},
               {"determined", candidate.determined}};
  json["V_validation"] = candidate.loss_validation.empty() ? Json(nullptr) : json_of(candidate.loss_validation);
  return json;
}

std::string orders_text(const OrderCandidate& candidate) {
  return "na " + std::to_string(candidate.na) + ", nb " + std::to_string(candidate.nb) + ", nk " +
         std::to_string(candidate.nk);
}

// The best candidate of every output's equation on its own.
void report_rows(const OrderSearch& search, const ChannelChoice& channels, Terminal& terminal) {
  Json& rows = terminal.result()["best_of_output"] = Json::array();
  for (std::size_t i = 0; i < channels.outputs.size(); ++i) {
    const OrderCandidate& best = search.candidates[search.best_of_row[i]];
    rows.push_back({{"name", channels.outputs[i]},
                    {"na", best.na},
                    {"nb", best.nb},
                    {"nk", best.nk},
                    {"index", search.best_of_row[i]}});
    if (channels.outputs.size() > 1) terminal.say("  for " + channels.outputs[i] + " alone: " + orders_text(best));
  }
}

}  // namespace

std::vector<Flag> search_flags() {
  return {
      {"search", Kind::kNames, "GRID", "",
       "try a grid of orders and delays and keep the best, such as na=1:10,nb=1:10,nk=0:3; what it leaves out is that "
       "of "
       "--na, --nb, --nk"},
      {"by",
       Kind::kChoice,
       "C",
       "fpe",
       "what the best candidate is best at",
       {"fpe", "aic", "aicc", "bic", "validation"}},
      {"validate", Kind::kSamples, "A:B", "", "rows to validate on, 1-based and inclusive"},
      {"per-output", Kind::kSwitch, "", "", "give every output's equation the orders that are best for it alone"},
      {"steps", Kind::kIntegerOrWord, "K", "1", "for validation: steps ahead, or inf for free simulation", {"inf"}},
  };
}

Result<ChosenOrders> search_arx_orders(const std::vector<Recording>& estimation, const std::vector<Recording>& whole,
                                       const ChannelChoice& channels, const Arguments& arguments, Terminal& terminal) {
  const auto options = options_from(arguments);
  if (!options) return options.error();
  std::vector<Recording> validation;
  if (arguments.has("validate")) {
    for (const Recording& recording : whole) {
      auto part = in_range(recording, arguments, "validate");
      if (!part) return part.error();
      validation.push_back(std::move(*part));
    }
  }
  const auto search = search_orders(estimation, validation, channels, *options);
  if (!search) return search.error();
  const OrderCandidate& best = search->candidates[search->best];
  terminal.result()["candidates"] = Json::array();
  for (const OrderCandidate& candidate : search->candidates)
    terminal.result()["candidates"].push_back(candidate_json(candidate));
  terminal.result()["best"] = candidate_json(best);
  terminal.result()["best"]["index"] = search->best;
  terminal.say(std::to_string(search->candidates.size()) + " candidates; best by " + arguments.text("by") + ": " +
               orders_text(best));
  report_rows(*search, channels, terminal);
  ChosenOrders chosen{arguments.on("per-output") ? search->row_orders : best.orders};
  if (options->common_start) {
    int latest = 0;
    for (const OrderCandidate& candidate : search->candidates) latest = std::max(latest, candidate.orders.history());
    chosen.first_sample = latest;
  }
  return chosen;
}

}  // namespace wisp::cli
