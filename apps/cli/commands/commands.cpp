#include "commands/commands.hpp"

#include <cstdio>

#include "terminal.hpp"

namespace wisp::cli {

const std::vector<Command>& commands() {
  static const std::vector<Command> all = {
      capture_outline_command(),
      capture_flame_command(),
      capture_brightness_command(),
      capture_wind_command(),
      capture_fall_command(),
      learn_outline_command(),
      learn_flame_command(),
      learn_arx_command(),
      learn_switched_command(),
      learn_flicker_command(),
      learn_chain_command(),
      learn_leaf_command(),
      validate_command(),
      predict_command(),
      compare_command(),
      simulate_candle_command(),
      simulate_leaf_command(),
      run_command(),
      export_command(),
      info_command(),
      report_command(),
      play_command(),
      demo_command(),
      manual_command(),
  };
  return all;
}

Command manual_command() {
  return {"manual",
          "Prints this page, or it as a man page, or what completes commands and flags in a shell.",
          {{"FORM", "markdown, man, bash, zsh or fish", false, true}},
          {},
          {},
          [](const Arguments& arguments, Terminal& terminal) -> Result<void> {
            const bool named = !arguments.positionals().empty();
            const auto text = manual(named ? arguments.positional() : "markdown");
            if (!text)
              return Error{"--: there is no form " + arguments.positional() +
                           "; there are markdown, man, bash, zsh and fish"};
            if (terminal.json()) {
              terminal.add("manual", *text);
            } else {
              std::fputs(text->c_str(), stdout);
            }
            return {};
          }};
}

}  // namespace wisp::cli
